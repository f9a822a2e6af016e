// SPDX-License-Identifier: MIT
/// \file
/// Plans of the soaks that a new device of a population needs.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "beamgyro/compensator.h"
#include "beamgyro/device.h"
#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {

/// Temperatures of the chamber, lowest and highest [degC].
using ChamberRange = std::pair<double, double>;

/// What is planned for. Give one of the first three.
struct PlanOptions {
  std::optional<std::size_t> soaks = {};
  std::optional<double> hours = {};               ///< in the chamber at most
  std::optional<double> residual_deg_per_s = {};  ///< median rms at most
  /// Over which the residual counts; what the population knows without.
  std::optional<ChamberRange> range_degC = {};
  /// At which a soak may be; the range without. Where it is narrower than the
  /// range, the population extrapolates.
  std::optional<ChamberRange> chamber_degC = {};
  std::optional<double> ramp_K_per_min = {};  ///< 2 without
  std::optional<double> start_degC = {};      ///< 25 without
  /// Length of a soak in whole minutes; the shortest that serves without.
  std::optional<std::size_t> hold_min = {};
  /// Soaks of your own [degC], to be compared.
  std::vector<std::vector<double>> candidates = {};
  bool bias_only = false;  ///< soaks that observe the bias, but no channel
  /// Counts on the row that a ramp down from the start shows minutes after
  /// power-on, which needs device and chamber at the start temperature then.
  bool start_row = false;
  /// How the schedule names its device file; the name of the device without.
  std::string device_name = {};
};

/// A schedule and what it leaves.
struct PlannedSchedule {
  std::vector<double> temperatures = {};  ///< [degC], increasing
  double hours = 0;                       ///< in the chamber
  double residual = 0;                    ///< [deg/s], median rms of devices
};

/// What a plan leaves over what straight lines between as many even soaks
/// leave, without a population: a quotient of medians over devices, each
/// predicted by the others. It is a gain where `high` is below 1.
struct PlanGain {
  double ratio = 0;
  double low = 0, high = 0;  ///< 95 % interval
};

struct SoakPlanResult {
  PlannedSchedule chosen = {}, even = {};  ///< even: as many, evenly spaced
  /// Nothing for a population of an older program, without its devices.
  std::optional<PlanGain> gain = {};
  /// Of 1, 2, ... soaks.
  std::vector<PlannedSchedule> trade_offs = {};
  std::vector<PlannedSchedule> candidates = {};
  std::vector<std::string> warnings = {};
  std::string schedule = {};  ///< scenario file, what -o writes
  std::string text = {};      ///< what `beamgyro plan` prints
  std::string json = {};      ///< what `--json` writes
};

/// Plans the soaks of a new device. `population` is a compensator that was
/// trained as a population; `device` tells how warm the sensor is, how long a
/// soak lasts and what noise it shows. Throws std::invalid_argument for another
/// compensator, a device with an oven, no goal or several, a goal that cannot
/// be met and a chamber at temperatures that the population does not know.
SoakPlanResult plan(const Compensator& population, const Device& device,
                    const PlanOptions& options);

}  // namespace beamgyro
