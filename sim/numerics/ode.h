// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>

namespace beamgyro::internal {

/// dy/dt = f(t, y); must fill every entry of `dydt`. May throw.
using OdeRhs =
    std::function<void(double t, const Eigen::Ref<const Eigen::VectorXd>& y,
                       Eigen::Ref<Eigen::VectorXd> dydt)>;

/// J(i, j) = df_i/dy_j; must fill every entry of `df_dy`. May throw.
using OdeJacobian =
    std::function<void(double t, const Eigen::Ref<const Eigen::VectorXd>& y,
                       Eigen::Ref<Eigen::MatrixXd> df_dy)>;

}  // namespace beamgyro::internal
