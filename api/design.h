// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "api/device_text.h"
#include "include/beamgyro/device_design.h"

namespace beamgyro::internal {

/// Rounds in which a figure is solved for, and its relative error then.
inline constexpr int kRounds = 12;
inline constexpr double kSolved = 1e-5;

/// The device of a data sheet in the making.
class Design {
 public:
  Design(const Device& base, const DataSheet& sheet);

  DesignedDevice finished();

 private:
  Device device() const { return text_.device(heading_); }

  void scale_beam(double length_factor, double side_factor);
  void require_beam(double length, double side) const;  // [m]
  void meet_frequency();
  void meet_split();
  void meet_quality();
  void set_mount();
  void set_readout();
  void set_noise();
  void meet_noise(std::vector<std::string>& warnings);
  void meet_bandwidth(std::vector<std::string>& warnings);
  void set_sensor();
  void set_supply();
  void meet_heating();
  void meet_rise(double rise);  // [K]
  void meet_time(double time);  // [s]
  void keep_voltage(std::vector<std::string>& warnings);
  void add_figures(const Device& made, DesignedDevice& result);

  const DataSheet& sheet_;  // outlives it
  const std::string base_name_;
  const DeviceText base_;
  DeviceText text_;
  std::vector<std::string> heading_;
  double length_factor_ = 1, side_factor_ = 1;
};

}  // namespace beamgyro::internal
