// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "compensation/export/export_parameters.h"

namespace beamgyro::internal {

// What the parameter files of autopilots and of their simulators share.

inline constexpr std::size_t kCubicTerms = 4;  // of a cubic
inline constexpr char kAutopilotAxes[] = {'x', 'y', 'z'};

char upper_axis(char axis);

/// Returns c_0 ... c_3 about the reference [degC] of the axis called `name`
/// [rad/s/K^k]; 0 of one that is not given.
std::vector<double> cubic_coefficients(const std::vector<AutopilotAxis>& axes,
                                       char name, double reference);

/// Returns a comment: "# WHAT of x z".
std::string parameter_heading(const char* what,
                              const std::vector<AutopilotAxis>& axes);

/// Returns a number with the digits of single precision.
std::string single_precision(double value);

/// Adds the line "NAME,VALUE".
void add_line(std::string& text, const std::string& name,
              const std::string& value);

/// Throws std::invalid_argument for a gyro that ArduPilot does not have.
void require_ardupilot_gyro(const AutopilotGyro& gyro);

/// Returns common_range(). Throws std::invalid_argument for one that ArduPilot
/// refuses: beyond -70 ... 80 degC, or of less than 10 K.
TemperatureRange ardupilot_range(const std::vector<AutopilotAxis>& axes);

}  // namespace beamgyro::internal
