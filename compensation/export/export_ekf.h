// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compensation/export/ekf_figures.h"

namespace beamgyro::internal {

/// A file that figures are computed from.
struct EkfSource {
  std::string name, sha256;
};

/// What the files of the filters are written from.
struct EkfExport {
  std::string name;  // of the files
  char axis = 'z';   // 'x', 'y' or 'z'
  EkfSource compensator, rest;
  EkfSettings settings;
  RestNoise noise;
  EkfFigures figures;
};

/// A parameter of a filter, of values in its own unit.
struct FilterParameter {
  std::string filter;  // "PX4 EKF2", ...
  std::string name, unit;
  double value;                                    // as computed
  double written;                                  // within [low, high]
  std::optional<std::pair<double, double>> range;  // that the filter documents
  std::string formula;
  std::string source;  // where name, unit and range are from

  bool is_clamped() const { return written != value; }
};

/// Returns the parameters of PX4 EKF2, ArduPilot EKF3, Kalibr and
/// robot_localization (docs/reference/ekf_parameters.md). N, Q and sigma_0 of
/// EkfFigures in rad, and dt the period of the filter's prediction, 0.01 s in
/// EKF2 and 0.012 s in EKF3:
///
///   EKF2_GYR_NOISE, EK3_GYRO_P_NSE     N / sqrt(dt)                   (E.4)
///   EKF2_GYR_B_NOISE, EK3_GBIAS_P_NSE  sqrt(Q / dt)                   (E.5)
///   EKF2_GBIAS_INIT                    sigma_0
///   gyroscope_noise_density            N
///   gyroscope_random_walk              sqrt(Q)
///   angular_velocity_covariance        N^2 f + sigma_0^2              (E.6)
///   process_noise_covariance           Q
///   initial_estimate_covariance        N^2 f + sigma_0^2
///
/// for a sample rate f [Hz]. EKF2 and EKF3 add (dt p)^2 to the variance at
/// every prediction, which is that of a random walk of density p^2 dt.
std::vector<FilterParameter> filter_parameters(const EkfExport& given);

/// Returns the files by name: NAME_ekf.json with all figures, and of each
/// filter the text that its users paste.
std::vector<std::pair<std::string, std::string>> ekf_texts(
    const EkfExport& given);

/// Returns a sentence for each value that a filter would not take.
std::vector<std::string> ekf_warnings(const EkfExport& given);

}  // namespace beamgyro::internal
