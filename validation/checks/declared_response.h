// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "validation/external/tested_compensator.h"

namespace beamgyro::internal {

/// How a compensator answers on purpose, as its maker states it
/// (docs/reference/specification_file: declared). Every figure is a bound that
/// the answers have to keep.
struct DeclaredResponse {
  // Of a low-pass of first order that is not exceeded: what comes out of a sine
  // of up to that frequency has at least its gain.
  std::optional<double> bandwidth = {};  // [Hz]
  double delay = 0.0;                    // [s], at most, beside the low-pass
  double ready_after = 0.0;              // [s] after a power-on
  // Takes the mean of this time after a power-on, at rest, for its bias.
  double zeroes_at_power_on = 0.0;  // [s]
  double resolution = 0.0;          // [deg/s], of the answers

  bool filters() const { return bandwidth || delay > 0.0; }
  bool empty() const {
    return !filters() && ready_after == 0.0 && zeroes_at_power_on == 0.0 &&
           resolution == 0.0;
  }
  /// Returns how long [s] after a step of the rate answers to samples `step`
  /// [s] apart may still move: the delay and eight time constants, three
  /// samples, and kSettlingTime; this alone where no filter is declared.
  double settling(double step) const;
  /// Returns the least gain [-] of a sine of that frequency [Hz].
  double least_gain(double frequency) const;
  /// Returns by how much [s] a sine of that frequency may come late.
  double most_delay(double frequency) const;
  /// Returns what the low-pass, by backward differences, and the delay leave of
  /// `rate` [deg/s], one for each time.
  std::vector<double> filtered(const Recording& run,
                               const std::vector<double>& rate) const;
  /// Returns the keys as a specification has them: "bandwidth_Hz = 25, delay_s
  /// = 0.01".
  std::string words() const;
};

/// Replaces answers up to `ready_after` [s] after each power-on by the recorded
/// rate less the first correction after, if it is more than 0.
void bridge_until_ready(const Recording& run, double ready_after,
                        Answer& answer);

/// Returns the compensator with its answers bridged until it is ready, and
/// nothing where `ready_after` [s] is 0. The original has to live as long.
std::unique_ptr<const TestedCompensator> ready_compensator(
    const TestedCompensator& original, double ready_after);

}  // namespace beamgyro::internal
