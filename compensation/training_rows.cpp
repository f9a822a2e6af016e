// SPDX-License-Identifier: MIT
#include "compensation/training_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace beamgyro {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;

constexpr double kMinute = 60.0;  // [s]

// Usable samples of one block.
struct Block {
  std::vector<Index> samples;
};

// Blocks of one run, counted anew from each power-on.
std::vector<Block> blocks_of(const Recording& recording, double seconds) {
  std::vector<Block> blocks;
  bool powered = false;
  double start = 0.0;  // [s]
  double number = -1.0;
  for (std::size_t k = 0; k < recording.time.size(); ++k) {
    const std::uint8_t status = recording.status[k];
    if ((status & kUnpowered) != 0) {
      powered = false;
      continue;
    }
    const double time = recording.time[k];
    if (!powered) start = time;
    const double block = std::floor((time - start) / seconds);
    if (!powered || block != number) blocks.emplace_back();
    powered = true;
    number = block;
    if ((status & (kOutputSaturated | kLoopNotLocked)) == 0)
      blocks.back().samples.push_back(static_cast<Index>(k));
  }
  std::size_t fullest = 0;
  for (const Block& block : blocks)
    fullest = std::max(fullest, block.samples.size());
  std::erase_if(blocks, [&](const Block& block) {
    return block.samples.empty() || 2 * block.samples.size() < fullest;
  });
  return blocks;
}

// Slope of the least squares line of y over t.
double slope(const ArrayXd& t, const ArrayXd& y) {
  const ArrayXd dt = t - t.mean();
  const double spread = dt.square().sum();
  return spread > 0.0 ? (dt * y).sum() / spread : 0.0;
}

// Rows of one run, one column per row: inputs, temperature, bias.
class RowCollector {
 public:
  RowCollector(const RowOptions& options, const TemperatureRange& clamp,
               std::size_t inputs)
      : options_(options), clamp_(clamp), inputs_(static_cast<Index>(inputs)) {}

  void add(const TrainingRun& run, const std::vector<Input>& inputs) {
    const Recording& recording = run.recording;
    const ArrayXXd features = features_of(inputs, recording, clamp_);
    const std::vector<Block> blocks = blocks_of(recording, options_.seconds);
    if (blocks.empty())
      throw std::invalid_argument(
          "no sample is powered, locked and not saturated");
    const auto column = [&](const char* name) {
      const std::vector<double>& values = column_values(recording, name);
      return Eigen::Map<const ArrayXd>(values.data(),
                                       static_cast<Index>(values.size()));
    };
    const ArrayXd temperature = column("temperature");
    const ArrayXd bias = column("rate") - column("true_rate");
    const ArrayXd time = Eigen::Map<const ArrayXd>(
        recording.time.data(), static_cast<Index>(recording.time.size()));
    for (const Block& block : blocks) {
      const ArrayXd measured = temperature(block.samples);
      check_finite(measured, "temperature", block, time);
      const ArrayXd T = measured.max(clamp_.lowest).min(clamp_.highest);
      const ArrayXd b = bias(block.samples);
      check_finite(b, "rate - true_rate", block, time);
      if (options_.steady_K_per_min &&
          !(std::abs(slope(time(block.samples), T)) * kMinute <=
            *options_.steady_K_per_min))
        continue;
      range_.lowest = std::min(range_.lowest, T.minCoeff());
      range_.highest = std::max(range_.highest, T.maxCoeff());
      for (Index i = 0; i < inputs_; ++i)
        values_.push_back(features.col(i)(block.samples).mean());
      values_.push_back(T.mean());
      values_.push_back(b.mean());
    }
  }

  TrainingRows rows() const {
    const Index width = inputs_ + 2;
    const Index count = static_cast<Index>(values_.size()) / width;
    const Eigen::Map<const ArrayXXd> all(values_.data(), width, count);
    return {all.topRows(inputs_).transpose(), all.row(inputs_).transpose(),
            all.row(inputs_ + 1).transpose(), range_};
  }

 private:
  static void check_finite(const ArrayXd& values, const char* what,
                           const Block& block, const ArrayXd& time) {
    for (Index n = 0; n < values.size(); ++n)
      if (!std::isfinite(values(n)))
        throw std::invalid_argument(fmt::format(
            "{} is {} at t = {} s though the gyro is powered", what, values(n),
            time(block.samples[static_cast<std::size_t>(n)])));
  }

  const RowOptions& options_;
  const TemperatureRange& clamp_;
  Index inputs_;
  std::vector<double> values_;
  TemperatureRange range_{std::numeric_limits<double>::infinity(),
                          -std::numeric_limits<double>::infinity()};
};

}  // namespace

TrainingRows training_rows(const std::vector<TrainingRun>& runs,
                           const std::vector<Input>& inputs,
                           const RowOptions& options,
                           const TemperatureRange& range) {
  RowCollector collector(options, range, inputs.size());
  for (const TrainingRun& run : runs) {
    try {
      collector.add(run, inputs);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(
          fmt::format("{}: {}", run.name, error.what()));
    }
  }
  TrainingRows rows = collector.rows();
  if (rows.size() == 0)
    throw std::invalid_argument(fmt::format(
        "the {} runs have no row{}", runs.size(),
        options.steady_K_per_min
            ? fmt::format(" whose temperature changes by {} K/min or less "
                          "(steady_K_per_min of the model file)",
                          *options.steady_K_per_min)
            : ""));
  return rows;
}

}  // namespace beamgyro
