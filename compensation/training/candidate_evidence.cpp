// SPDX-License-Identifier: MIT
#include "compensation/training/candidate_evidence.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "compensation/methods/method_inputs.h"
#include "compensation/models/array_view.h"
#include "compensation/training/cross_validation.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

constexpr double kSlowNoise = 0.05;  // [-], of n s^2
constexpr int kLeastPowerOns = 3;
constexpr double kPowerOnsApart = 10.0;  // [K]
constexpr double kToldApart = 0.5;       // [-], of spans, and of tenths

bool is_curve(const Candidate& candidate) {
  const auto* polynomial = std::get_if<PolynomialSpec>(&candidate.kind);
  return is_constant(candidate.kind) ||
         (polynomial != nullptr && polynomial->degree <= 3 &&
          candidate.inputs.size() == 1);
}

bool is_network(const Candidate& candidate) {
  return std::holds_alternative<BpSpec>(candidate.kind);
}

// Temperatures kPowerOnsApart or more apart at which power came on.
int power_on_temperatures(const TrainingRows& rows) {
  std::vector<double> temperatures;
  for (Index k = 0; k < rows.size(); ++k)
    if (k == 0 || rows.cycle(k) != rows.cycle(k - 1))
      temperatures.push_back(rows.temperature(k));
  return distinct_temperatures(array_view(temperatures), kPowerOnsApart);
}

bool comes_from_temperature(const Input& input) {
  return input.column == "temperature" && input.kind != InputKind::kColumn;
}

// What an input of the temperature adds to the temperature, one value per row.
ArrayXd difference_from_temperature(const Input& input, const ArrayXd& column,
                                    const TrainingRows& rows) {
  if (input.kind == InputKind::kTemperatureRate) return column;
  return rows.temperature - column;
}

// Returns what the rows do not tell of an input, or an empty text.
std::string missing_evidence(const Input& input, const ArrayXd& column,
                             const TrainingRows& rows,
                             const RowGroups& groups) {
  if (input.kind == InputKind::kSincePowerOn) {
    const int ambients = power_on_temperatures(rows);
    if (ambients >= kLeastPowerOns) return "";
    return fmt::format(
        "time since power-on is told from temperature by power-ons at {} "
        "temperatures {:g} K apart; the recordings have {}",
        kLeastPowerOns, kPowerOnsApart, ambients);
  }
  if (!comes_from_temperature(input)) return "";
  const ArrayXd difference = difference_from_temperature(input, column, rows);
  for (int group = 0; group < groups.count; ++group) {
    std::vector<Index> kept;
    for (Index k = 0; k < rows.size(); ++k)
      if (groups.of_row(k) != group) kept.push_back(k);
    if (is_told_apart(rows.temperature(kept), difference(kept))) continue;
    return fmt::format(
        "the past of the temperature is told from the temperature where it "
        "rises and falls or changes at several rates; without {} {} it does "
        "not",
        grouping_name(groups.by), group + 1);
  }
  return "";
}

}  // namespace

bool is_constant(const FitSpec& kind) {
  return std::holds_alternative<NoneSpec>(kind) ||
         std::holds_alternative<ConstantSpec>(kind);
}

bool is_cubic(const Candidate& candidate) {
  const auto* polynomial = std::get_if<PolynomialSpec>(&candidate.kind);
  return polynomial != nullptr && polynomial->degree == 3 &&
         candidate.inputs.size() == 1;
}

bool moves_more_than_noise(const TrainingRows& rows) {
  double squares = 0.0, count = 0.0;
  for (Index k = 2; k < rows.size(); ++k) {
    if (rows.cycle(k) != rows.cycle(k - 2)) continue;
    const double second =
        rows.bias(k) - 2.0 * rows.bias(k - 1) + rows.bias(k - 2);
    squares += second * second;
    count += 1.0;
  }
  const double variance = (rows.bias - rows.bias.mean()).square().mean();
  const auto size = static_cast<double>(rows.size());
  return count > 0.0 && variance > kSlowNoise * size * 0.5 * squares / count;
}

bool is_told_apart(const ArrayXd& temperature, const ArrayXd& difference) {
  struct Tenth {
    double low = HUGE_VAL, high = -HUGE_VAL;
  };
  const double lowest = temperature.minCoeff();
  const double span = temperature.maxCoeff() - lowest;
  const double least =
      kToldApart * (difference.maxCoeff() - difference.minCoeff());
  if (!(span > 0.0) || !(least > 0.0)) return false;
  std::array<Tenth, 10> tenths;
  for (Index k = 0; k < temperature.size(); ++k) {
    const double share = (temperature(k) - lowest) / span;
    Tenth& tenth = tenths[std::min<std::size_t>(
        static_cast<std::size_t>(10.0 * share), tenths.size() - 1)];
    tenth.low = std::min(tenth.low, difference(k));
    tenth.high = std::max(tenth.high, difference(k));
  }
  const auto wide = std::ranges::count_if(tenths, [&](const Tenth& tenth) {
    return tenth.high - tenth.low >= least;
  });
  const auto filled = std::ranges::count_if(
      tenths, [](const Tenth& tenth) { return tenth.high >= tenth.low; });
  return static_cast<double>(wide) >= kToldApart * static_cast<double>(filled);
}

RemovedInputs remove_inputs_without_evidence(Candidate& candidate,
                                             const std::vector<Input>& inputs,
                                             const TrainingRows& rows,
                                             const RowGroups& groups) {
  RemovedInputs removed;
  std::vector<std::string> reasons;
  std::vector<Input> kept;
  for (const Input& input : candidate.inputs) {
    const Index column =
        std::find(inputs.begin(), inputs.end(), input) - inputs.begin();
    const std::string reason =
        kept.empty()
            ? ""
            : missing_evidence(input, rows.inputs.col(column), rows, groups);
    if (reason.empty()) {
      kept.push_back(input);
      continue;
    }
    removed.names.push_back(input_name(input));
    if (std::ranges::find(reasons, reason) == reasons.end())
      reasons.push_back(reason);
  }
  candidate.inputs = kept;
  removed.reason = fmt::format("{}", fmt::join(reasons, "; "));
  return removed;
}

std::string objection_to_candidate(const Candidate& candidate,
                                   const TrainingRows& rows,
                                   const RowGroups& groups) {
  if (is_constant(candidate.kind)) return "";
  if (groups.by == Grouping::kSegment && !is_curve(candidate))
    return "the recordings are one leg of temperature, or legs that share too "
           "little of it, and nothing independent can be held out: curves up "
           "to the cubic only";
  if (groups.count < kLeastGroups && is_network(candidate))
    return fmt::format("{} {}s or more judge a network; the recordings have {}",
                       kLeastGroups, grouping_name(groups.by), groups.count);
  if (groups.by == Grouping::kSegment && !moves_more_than_noise(rows))
    return "the bias moves no more than slow noise does while the temperature "
           "goes one way";
  return "";
}

void require_groups_for_inputs(const Candidate& candidate,
                               const RowGroups& groups) {
  if (groups.count >= kLeastGroups || !is_network(candidate) ||
      candidate.inputs.size() < 2)
    return;
  throw std::invalid_argument(fmt::format(
      "{} {}s or more judge a network of several inputs, here {}; the "
      "recordings have {}: expected more recordings, or a curve of the "
      "temperature",
      kLeastGroups, grouping_name(groups.by),
      fmt::join(input_names(candidate.inputs), ", "), groups.count));
}

}  // namespace beamgyro::internal
