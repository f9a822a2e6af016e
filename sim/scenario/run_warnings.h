// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dataset/recording/recording.h"
#include "sim/device/device.h"
#include "sim/scenario/scenario.h"

namespace beamgyro::internal {

/// What the user of a run should know and no error says. Each warning is one
/// sentence with counts and the likely cause:
/// - the beam leaves the temperatures at which the ceramic's coefficients are
///   linear;
/// - no sample is powered;
/// - half or more of the powered samples are saturated, or not locked, or one
///   is not locked later than kLockTime after its power-on;
/// - the samples do not show a motion (aliasing_warnings());
/// - soaks end after duration_s;
/// - the history of a unit with memory ends at another temperature than the run
///   begins with, or the unit has no memory;
/// - an oven is below its surroundings;
/// - the steps of rate or temperature are so coarse that all samples are equal;
/// - the random walk of a run without an age goes beyond its bound.
class RunWarnings {
 public:
  /// `scenario` and `device` must outlive the object.
  RunWarnings(const ScenarioPlan& scenario, const DeviceParameters& device)
      : scenario_(scenario), device_(device) {}

  /// Takes the next block of the run.
  void add(const Recording& block);

  /// Returns the warnings about the blocks so far and about the scenario.
  std::vector<std::string> texts() const;

 private:
  // Of some of the samples.
  struct Temperatures {
    std::size_t count = 0;
    double lowest = 0, highest = 0;  // [degC]

    double span() const { return highest - lowest; }

    void add(double celsius);
  };

  std::string history_text() const;
  std::string walk_text() const;
  std::string heat_text() const;
  std::string power_text() const;
  std::string saturation_text() const;
  std::string lock_text() const;
  std::string oven_text() const;
  std::string coarse_rate_text() const;
  std::string coarse_temperature_text() const;

  const ScenarioPlan& scenario_;
  const DeviceParameters& device_;
  std::size_t samples_ = 0, powered_ = 0, saturated_ = 0, unlocked_ = 0;
  std::size_t limited_ = 0;   // not locked, with the voltage at its limit
  Temperatures lost_;         // not locked, although that is due
  Temperatures clamped_;      // beyond the linear range of the ceramic
  Temperatures around_oven_;  // of the surroundings, above the set point
  // Of the powered samples.
  Temperatures shown_, sensor_;  // what the sensor shows, and has
  Temperatures rate_;            // [deg/s] in their place
};

}  // namespace beamgyro::internal
