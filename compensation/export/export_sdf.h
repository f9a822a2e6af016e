// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace beamgyro::internal {

/// What the noise block of an IMU in an SDF file can say of one axis.
struct SdfNoise {
  double update_rate = 0;        // f [Hz]
  double mean = 0;               // bias that is the same at each start [rad/s]
  double angle_random_walk = 0;  // N [rad/sqrt(s)]
  double turn_on = 0;            // 1-sigma, for each start [rad/s]
  double rate_random_walk = 0;   // K [rad/s/sqrt(s)]
  double walk_correlation = 0;   // t_c [s], after which the walk forgets
  double resolution = 0;         // of the output [rad/s]
};

/// Gazebo takes a precision up to this for none [rad/s].
inline constexpr double kSdfLeastPrecision = 1e-6;

/// Returns the element <sensor> of an IMU with the noise of one axis ('x', 'y'
/// or 'z'), for SDF 1.6 and later:
///
///   mean = bias, stddev = N sqrt(f)                                   (X.3)
///   bias_mean = 0, bias_stddev = sigma of the turn-on offset
///   dynamic_bias_stddev = K, dynamic_bias_correlation_time = t_c
///
/// With a step dt Gazebo multiplies its dynamic bias, which starts as the
/// turn-on offset, by e^{-dt/t_c} and adds a normal number of variance
/// K^2 (t_c/2) (1 - e^{-2 dt/t_c}): the walk WalkSinceTrim. A resolution above
/// kSdfLeastPrecision makes the type gaussian_quantized. `remarks` become
/// comments; "--" in them, which ends a comment, becomes "-".
std::string sdf_sensor(const std::string& name, char axis,
                       const SdfNoise& noise,
                       const std::vector<std::string>& remarks);

}  // namespace beamgyro::internal
