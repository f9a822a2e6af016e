// SPDX-License-Identifier: MIT
#include "validation/external/answer_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <utility>

#include "validation/external/answering.h"

namespace beamgyro::internal {
namespace {

bool is_powered(const Recording& run, std::size_t k) {
  return (run.status[k] & kUnpowered) == 0;
}

// Returns the index of the powered sample that follows `share` of them.
std::size_t place_after(const Recording& run, double share) {
  const auto powered = [](std::uint8_t status) {
    return (status & kUnpowered) == 0;
  };
  const auto all = std::ranges::count_if(run.status, powered);
  auto left = static_cast<std::ptrdiff_t>(share * static_cast<double>(all));
  std::size_t k = 0;
  for (; k < run.time.size(); ++k)
    if (is_powered(run, k) && left-- == 0) break;
  return k;
}

// Returns the first powered sample below `end` whose answers differ in a bit.
std::optional<std::size_t> first_difference(const Recording& run,
                                            const Answer& one,
                                            const Answer& other,
                                            std::size_t end) {
  for (std::size_t k = 0; k < end; ++k)
    if (is_powered(run, k) && std::bit_cast<std::uint64_t>(one.rate[k]) !=
                                  std::bit_cast<std::uint64_t>(other.rate[k]))
      return k;
  return std::nullopt;
}

std::string answers_words(const Answer& one, const Answer& other,
                          std::size_t k) {
  return fmt::format("{} deg/s in place of {} deg/s", other.rate[k],
                     one.rate[k]);
}

bool any_fault(std::initializer_list<const Answer*> answers) {
  return std::ranges::any_of(answers, [](const Answer* answer) {
    return std::ranges::any_of(answer->faults, [](const SeenFault& seen) {
      return seen.fault != AnswerFault::kTooSlow;
    });
  });
}

Recording measured_before(const Recording& run, std::size_t end) {
  const auto cut = [end](auto values) {
    values.resize(end);
    return values;
  };
  Recording part;
  part.time = cut(run.time);
  part.status = cut(run.status);
  for (const Column& column : run.columns)
    if (column.role == Role::kMeasured)
      part.columns.push_back({column.name, column.units, column.long_name,
                              column.role, cut(column.values)});
  return part;
}

// Changes every measured variable from `begin` on by more than its range.
Recording changed_from(const Recording& run, std::size_t begin) {
  Recording changed = measured_before(run, run.time.size());
  for (Column& column : changed.columns) {
    double low = INFINITY, high = -INFINITY;
    for (std::size_t k = 0; k < column.values.size(); ++k) {
      if (!is_powered(run, k)) continue;
      low = std::min(low, column.values[k]);
      high = std::max(high, column.values[k]);
    }
    const double change = 1.1 * (high - low) + 1e-3 * std::abs(high) + 1e-3;
    for (std::size_t k = begin; k < column.values.size(); ++k)
      column.values[k] += change;
  }
  return changed;
}

}  // namespace

std::optional<SeenFault> state_kept_over_reset(
    const TestedCompensator& compensator, const Recording& run) {
  const std::vector<Answer> twice = compensator.answers({&run, &run});
  if (any_fault({&twice[0], &twice[1]})) return std::nullopt;
  const auto at = first_difference(run, twice[0], twice[1], run.time.size());
  if (!at) return std::nullopt;
  return SeenFault{
      AnswerFault::kKeepsState, *at,
      fmt::format("keeps state over a reset: to the same run it answers {} at "
                  "{}, the second time",
                  answers_words(twice[0], twice[1], *at),
                  sample_words(run, *at))};
}

std::optional<SeenFault> later_samples_used(
    const TestedCompensator& compensator, const Recording& run) {
  const Answer whole = compensator.answer(run);
  for (const double share : {1.0 / 3.0, 2.0 / 3.0, 0.7, 0.15}) {
    const std::size_t border = place_after(run, share);
    const bool cut = share == 1.0 / 3.0 || share == 0.7;
    const Answer answer = compensator.answer(cut ? measured_before(run, border)
                                                 : changed_from(run, border));
    if (any_fault({&whole, &answer})) return std::nullopt;
    const auto at = first_difference(run, whole, answer, border);
    if (!at) continue;
    return SeenFault{
        AnswerFault::kUsesLaterSamples, *at,
        fmt::format("uses later samples: at {} it answers {} when the samples "
                    "from {} on {}",
                    sample_words(run, *at), answers_words(whole, answer, *at),
                    border, cut ? "are missing" : "are changed")};
  }
  return std::nullopt;
}

AnswerDifference difference_of(const Answer& one, const Answer& other) {
  AnswerDifference found;
  double squares = 0.0;
  for (std::size_t k = 0; k < std::min(one.rate.size(), other.rate.size());
       ++k) {
    const double difference = std::abs(one.rate[k] - other.rate[k]);
    if (!std::isfinite(difference)) continue;
    ++found.samples;
    squares += difference * difference;
    if (difference <= found.largest) continue;
    found.largest = difference;
    found.at = k;
  }
  if (found.samples > 0)
    found.rms = std::sqrt(squares / static_cast<double>(found.samples));
  return found;
}

}  // namespace beamgyro::internal
