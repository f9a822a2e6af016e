// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "dataset/recording/recording.h"
#include "sim/device/device.h"
#include "sim/scenario/scenario.h"

namespace beamgyro {

/// What the user of a run should know and no error says. Each warning is one
/// sentence with counts and the likely cause:
/// - a node of the thermal network leaves kMaterialTemperatures;
/// - no sample is powered;
/// - half or more of the powered samples are saturated, or not locked;
/// - the samples do not show a motion (aliasing_warnings());
/// - soaks end after duration_s.
class RunWarnings {
 public:
  /// `scenario` and `device` must outlive the object.
  RunWarnings(const Scenario& scenario, const Device& device)
      : scenario_(scenario), device_(device) {}

  /// Takes the next block of the run.
  void add(const Recording& block);

  /// Returns the warnings about the blocks so far and about the scenario.
  std::vector<std::string> texts() const;

  /// Returns the one about temperatures, or nothing.
  std::string heat_text() const;

 private:
  struct Node {
    std::size_t outside = 0;         // samples
    double lowest = 0, highest = 0;  // of these samples [degC]
  };

  std::string power_text() const;
  std::string saturation_text() const;
  std::string lock_text() const;

  const Scenario& scenario_;
  const Device& device_;
  std::size_t samples_ = 0, powered_ = 0, saturated_ = 0, unlocked_ = 0;
  std::array<Node, kThermalNodeCount> nodes_{};
};

}  // namespace beamgyro
