// SPDX-License-Identifier: MIT
#include "compensation/rows/training_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "compensation/models/array_view.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;

constexpr double kMinute = 60.0;  // [s]

// Usable samples of one block.
struct Block {
  std::vector<Index> samples;
  int cycle;  // of the run
};

// Blocks of one run, counted anew from each power-on. Those that begin sooner
// than `after` [s] are left out.
std::vector<Block> row_blocks_of(const Recording& recording, double seconds,
                                 double after) {
  std::vector<Block> blocks;
  bool powered = false;
  double start = 0.0;  // [s]
  double number = -1.0;
  int cycle = -1;
  for (std::size_t k = 0; k < recording.time.size(); ++k) {
    const std::uint8_t status = recording.status[k];
    if ((status & kUnpowered) != 0) {
      powered = false;
      continue;
    }
    const double time = recording.time[k];
    if (!powered) {
      start = time;
      ++cycle;
    }
    const double block = seconds > 0.0 ? std::floor((time - start) / seconds)
                                       : static_cast<double>(k);
    if (!powered || block != number) blocks.push_back({{}, cycle});
    powered = true;
    number = block;
    const double begin = seconds > 0.0 ? block * seconds : time - start;
    if (begin < after) continue;
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

// How the temperature of a block changes.
struct Change {
  double time, temperature;  // [s], [degC], means
  double slope;              // [K/min]
  int cycle;
  bool steady;
};

// Changes of blocks that are this far away tell the rate at a block, because
// the slope over a single one has the noise of the sensor.
constexpr std::size_t kBlockReach = 2;

// Rate [K/min] at a block, between steady ones that follow each other.
double rate_about(const std::vector<Change>& changes, std::size_t at) {
  const auto follow = [&](std::size_t k) {  // k and k + 1
    return changes[k].steady && changes[k + 1].steady &&
           changes[k].cycle == changes[k + 1].cycle;
  };
  std::size_t first = at, last = at;
  while (first > 0 && at - first < kBlockReach && follow(first - 1)) --first;
  while (last + 1 < changes.size() && last - at < kBlockReach && follow(last))
    ++last;
  if (first == last) return changes[at].slope;
  return (changes[last].temperature - changes[first].temperature) /
         (changes[last].time - changes[first].time) * kMinute;
}

// A mean temperature less the lag, within the limits of its samples.
double without_lag(double mean, double lag, const TemperatureRange& limits) {
  return lag == 0.0 ? mean
                    : std::clamp(mean - lag, limits.lowest, limits.highest);
}

bool is_temperature(const Input& input) {
  return input.kind == InputKind::kColumn && input.column == "temperature";
}

// Numbers the legs of temperatures in turn: a leg ends at the extreme from
// which the temperature then turns by kLegReversal.
class LegCounter {
 public:
  void begin_cycle() {
    rising_.reset();
    first_ = legs_.size();
    if (!legs_.empty()) ++leg_;
  }

  void add(double T) {
    const std::size_t here = legs_.size();
    legs_.push_back(leg_);
    if (here == first_) {
      set_extreme(T, here);
      lowest_ = highest_ = T;
      return;
    }
    lowest_ = std::min(lowest_, T);
    highest_ = std::max(highest_, T);
    if (!rising_) {
      if (highest_ - lowest_ < kLegReversal) return;
      rising_ = T == highest_;
      set_extreme(T, here);
    } else if ((*rising_ == (T > extreme_)) || T == extreme_) {
      set_extreme(T, here);
    } else if (std::abs(T - extreme_) >= kLegReversal) {
      ++leg_;
      std::fill(legs_.begin() + static_cast<std::ptrdiff_t>(at_) + 1,
                legs_.end(), leg_);
      rising_ = !*rising_;
      set_extreme(T, here);
    }
  }

  const std::vector<int>& legs() const { return legs_; }

 private:
  void set_extreme(double T, std::size_t at) {
    extreme_ = T;
    at_ = at;
  }

  std::vector<int> legs_;
  int leg_ = 0;
  std::size_t first_ = 0, at_ = 0;
  double extreme_ = 0.0, lowest_ = 0.0, highest_ = 0.0;  // [degC]
  std::optional<bool> rising_;
};

// Rows of one run, one column per row: inputs, time, temperature, bias.
class RowCollector {
 public:
  RowCollector(const RowOptions& options, const TemperatureRange& clamp,
               const LookupTable* scale_factor, std::size_t inputs)
      : options_(options),
        clamp_(clamp),
        scale_factor_(scale_factor),
        inputs_(static_cast<Index>(inputs)) {}

  void add(const TrainingRun& run, const std::vector<Input>& inputs) {
    const Recording& recording = run.recording;
    const ArrayXXd features = features_of(inputs, recording, clamp_);
    const std::vector<Block> blocks = row_blocks_of(
        recording, options_.seconds, options_.after_power_on_min * kMinute);
    if (blocks.empty())
      throw std::invalid_argument(fmt::format(
          "no sample is powered, locked and not saturated{}",
          options_.after_power_on_min > 0.0
              ? fmt::format(" later than {:g} min after power-on "
                            "(after_power_on_min of the model file)",
                            options_.after_power_on_min)
              : ""));
    const auto column = [&](const char* name) {
      return array_view(column_values(recording, name));
    };
    const ArrayXd temperature = column("temperature");
    ArrayXd truth = column("true_rate");
    if (scale_factor_ != nullptr)
      truth *= scale_factor_->predict(
          temperature.max(clamp_.lowest).min(clamp_.highest));
    const ArrayXd bias = column("rate") - truth;
    const ArrayXd time = array_view(recording.time);
    note_output(recording);
    const std::vector<Change> changes = changes_of(blocks, time, temperature);
    int cycle = -1;
    ++run_count_;
    const int device = device_number(run);
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      const Block& block = blocks[k];
      const ArrayXd measured = temperature(block.samples);
      check_finite(measured, "temperature", block, time);
      const ArrayXd T = measured.max(clamp_.lowest).min(clamp_.highest);
      if (options_.steady_K_per_min && !changes[k].steady) {
        for (Index i = 0; i < inputs_; ++i)
          moving_.push_back(features.col(i)(block.samples).mean());
        continue;
      }
      const ArrayXd b = bias(block.samples);
      check_finite(b, "rate - true_rate", block, time);
      const double lag = options_.lag_min > 0.0
                             ? options_.lag_min * rate_about(changes, k)
                             : 0.0;  // [K]
      range_.lowest = std::min(range_.lowest, T.minCoeff());
      range_.highest = std::max(range_.highest, T.maxCoeff());
      slowest_ = std::min(slowest_, truth(block.samples).minCoeff());
      fastest_ = std::max(fastest_, truth(block.samples).maxCoeff());
      for (Index i = 0; i < inputs_; ++i) {
        const double mean = features.col(i)(block.samples).mean();
        const auto& input = inputs[static_cast<std::size_t>(i)];
        values_.push_back(is_temperature(input) ? without_lag(mean, lag, clamp_)
                                                : mean);
      }
      if (block.cycle != cycle) {
        cycle = block.cycle;
        ++cycle_count_;
        legs_.begin_cycle();
      }
      runs_.push_back(run_count_);
      devices_.push_back(device);
      cycles_.push_back(cycle_count_);
      legs_.add(without_lag(T.mean(), lag, clamp_));
      const double mean = measured.mean();
      outside_.push_back(
          std::abs(mean - std::clamp(mean, clamp_.lowest, clamp_.highest)));
      values_.push_back(time(block.samples).mean());
      values_.push_back(without_lag(T.mean(), lag, clamp_));
      values_.push_back(b.mean());
    }
  }

  TrainingRows rows() const {
    const Index width = inputs_ + 3;
    const Index count = static_cast<Index>(values_.size()) / width;
    const Eigen::Map<const ArrayXXd> all(values_.data(), width, count);
    return {
        all.topRows(inputs_).transpose(),
        all.row(inputs_ + 1).transpose(),
        all.row(inputs_ + 2).transpose(),
        range_,
        all.row(inputs_).transpose(),
        array_view(runs_),
        array_view(cycles_),
        array_view(legs_.legs()),
        output_per_rate_,
        count > 0 ? fastest_ - slowest_ : 0.0,
        array_view(outside_),
        array_view(devices_),
        Eigen::Map<const ArrayXXd>(moving_.data(), inputs_,
                                   static_cast<Index>(moving_.size()) / inputs_)
            .transpose()};
  }

 private:
  // Nothing when no option needs them.
  std::vector<Change> changes_of(const std::vector<Block>& blocks,
                                 const ArrayXd& time,
                                 const ArrayXd& temperature) const {
    const double steady = options_.steady_K_per_min.value_or(HUGE_VAL);
    std::vector<Change> changes;
    if (!options_.steady_K_per_min && options_.lag_min == 0.0) return changes;
    for (const Block& block : blocks) {
      const ArrayXd T =
          temperature(block.samples).max(clamp_.lowest).min(clamp_.highest);
      const ArrayXd t = time(block.samples);
      const double rate = slope(t, T) * kMinute;
      changes.push_back(
          {t.mean(), T.mean(), rate, block.cycle, std::abs(rate) <= steady});
    }
    return changes;
  }

  int device_number(const TrainingRun& run) {
    const auto next = static_cast<int>(device_numbers_.size());
    return device_numbers_
        .emplace(run.device.empty() ? fmt::format("run {}", run_count_)
                                    : fmt::format("device {}", run.device),
                 next)
        .first->second;
  }

  // The output is a straight line over the rate: two samples tell its slope.
  void note_output(const Recording& recording) {
    const Column* output = find_column(recording, "output");
    if (output == nullptr) return;
    const auto& volts = output->values;
    const auto& rate = column_values(recording, "rate");
    std::size_t low = 0, high = 0;
    bool any = false;
    for (std::size_t k = 0; k < volts.size(); ++k) {
      if ((recording.status[k] & kUnpowered) != 0) continue;
      if (!any || volts[k] < volts[low]) low = k;
      if (!any || volts[k] > volts[high]) high = k;
      any = true;
    }
    if (any && rate[high] != rate[low])
      output_per_rate_ = (volts[high] - volts[low]) / (rate[high] - rate[low]);
  }

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
  const LookupTable* scale_factor_;
  Index inputs_;
  std::vector<double> values_, moving_;
  std::vector<int> runs_, cycles_, devices_;  // one per row
  std::vector<double> outside_;               // [K], likewise
  std::map<std::string, int> device_numbers_;
  LegCounter legs_;
  int run_count_ = -1, cycle_count_ = -1;
  double output_per_rate_ = 0.0;                     // [V/(deg/s)]
  double slowest_ = HUGE_VAL, fastest_ = -HUGE_VAL;  // [deg/s], true rate
  TemperatureRange range_{std::numeric_limits<double>::infinity(),
                          -std::numeric_limits<double>::infinity()};
};

}  // namespace

TrainingRows training_rows(const RunSource& runs,
                           const std::vector<Input>& inputs,
                           const RowOptions& options,
                           const TemperatureRange& range,
                           const LookupTable* scale_factor) {
  RowCollector collector(options, range, scale_factor, inputs.size());
  runs.for_each([&](const TrainingRun& run) {
    try {
      collector.add(run, inputs);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(
          fmt::format("{}: {}", run.name, error.what()));
    }
  });
  TrainingRows rows = collector.rows();
  if (rows.size() == 0)
    throw std::invalid_argument(fmt::format(
        "the {} runs have no row{}", runs.count,
        options.steady_K_per_min
            ? fmt::format(" whose temperature changes by {} K/min or less "
                          "(steady_K_per_min of the model file)",
                          *options.steady_K_per_min)
            : ""));
  return rows;
}

std::vector<RowStretch> stretches_of(const Eigen::ArrayXi& labels) {
  std::vector<RowStretch> stretches;
  for (Index k = 0; k < labels.size(); ++k) {
    if (k == 0 || labels(k) != labels(k - 1)) stretches.push_back({k, k});
    stretches.back().end = k + 1;
  }
  return stretches;
}

TrainingRows selected(const TrainingRows& rows,
                      const Eigen::Array<bool, Eigen::Dynamic, 1>& keep) {
  std::vector<Index> which;
  for (Index k = 0; k < keep.size(); ++k)
    if (keep(k)) which.push_back(k);
  return {rows.inputs(which, Eigen::all),
          rows.temperature(which),
          rows.bias(which),
          rows.range,
          rows.time(which),
          rows.run(which),
          rows.cycle(which),
          rows.leg(which),
          rows.output_per_rate,
          rows.true_rate_span,
          rows.beyond_range(which),
          rows.device(which),
          rows.moving};
}

TrainingRows with_columns(const TrainingRows& rows,
                          const std::vector<Input>& all,
                          const std::vector<Input>& wanted) {
  if (wanted == all || rows.size() == 0) return rows;
  std::vector<Eigen::Index> columns;
  for (const Input& input : wanted)
    columns.push_back(std::find(all.begin(), all.end(), input) - all.begin());
  TrainingRows result = rows;
  result.inputs = rows.inputs(Eigen::all, columns);
  if (rows.moving.rows() > 0) result.moving = rows.moving(Eigen::all, columns);
  return result;
}

}  // namespace beamgyro::internal
