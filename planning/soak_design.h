// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "planning/soak_length.h"
#include "planning/soak_model.h"

namespace beamgyro::internal {

/// Soaks may be at these temperatures of the chamber [degC], increasing.
struct DesignLimits {
  std::vector<double> candidates;
  double start = 25.0;  // [degC]
  // [K], of shortest_way() from the start
  double longest_way = std::numeric_limits<double>::infinity();
  // Soaks are visited from the start downwards, and show its row.
  std::optional<StartRow> start_row = {};
};

/// Smallest distance [K] of two soaks: points that are closer together than
/// kPointWidth count as one.
constexpr double kLeastDistance = 1.5 * kPointWidth;

/// Chooses soaks by I-optimality: those that leave the least mean variance of
/// the bias over the range,
///
///   trace(W A^-1),   A = I + sum over the soaks of H^T H.
///
/// An exchange of one soak changes A by a low rank, so that all candidates are
/// judged at once: trace(W A^-1) falls by trace(S^-1 V), S = I + h A^-1 h^T,
/// V = h A^-1 W A^-1 h^T.
class SoakDesign {
 public:
  /// The model must outlive the design. `root` is a root of the covariance of c
  /// over devices, where that is not I.
  SoakDesign(const SoakModel& model, DesignLimits limits,
             const Eigen::MatrixXd& root = {});

  /// The mean variance that soaks leave [(deg/s)^2].
  double mean_variance(const std::vector<double>& soaks) const;

  /// Adds the best candidate again and again until there are `count` soaks.
  /// Returns fewer when the limits allow no more.
  std::vector<double> extended(std::vector<double> soaks,
                               std::size_t count) const;

  /// Exchanges one soak for the best candidate until no exchange is better.
  /// The soaks must obey the limits.
  std::vector<double> exchanged(std::vector<double> soaks) const;

  bool is_allowed(const std::vector<double>& soaks) const;

 private:
  struct Choice {
    std::size_t candidate;
    double mean_variance;
  };
  std::vector<double> reductions(const Eigen::MatrixXd& covariance) const;
  Choice best_addition(const std::vector<double>& soaks) const;
  Eigen::MatrixXd covariance(const std::vector<double>& soaks) const;
  Eigen::MatrixXd equations(const std::vector<double>& soaks) const;

  const SoakModel& model_;
  DesignLimits limits_;
  Eigen::MatrixXd root_;       // or nothing, for I
  Eigen::MatrixXd weight_;     // W
  Eigen::MatrixXd equations_;  // H of all candidates
};

}  // namespace beamgyro::internal
