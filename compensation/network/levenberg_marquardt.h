// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/network/network_training.h"

namespace beamgyro::internal {

/// Damped Gauss-Newton on F(w) = mean(e^2) / 2 + decay |w|^2 / 2 with geodesic
/// acceleration. The step is w -> w + v + a with
///
///   A = J^T J / N + decay I + mu I
///   A v = -dF/dw
///   A a = -J^T y_vv / (2 N),   y_vv = d2y/dt2 at t = 0 along w + t v
///
/// The step is kept when it lowers F and 2 |a| <= 0.75 |v|. The acceleration a
/// follows the bends of the narrow valleys that tanh networks have. Damping is
/// that of Nielsen (IMM-REP-1999-05): let rho be the decrease of F divided by
/// the decrease that the quadratic model predicts for v. A kept step multiplies
/// mu by max(1/3, 1 - (2 rho - 1)^3), a discarded one by 2, 4, 8, ... An epoch
/// is one step tried. The held-out error is computed after every kept step.
/// References: Marquardt, J. SIAM 11 (1963) 431; Transtrum and Sethna,
/// arXiv:1201.5885.
TrainSummary train_levenberg_marquardt(const ScaledRows& rows,
                                       const ScaledRows& held_out,
                                       const TrainOptions& options,
                                       BpNetwork& network);

}  // namespace beamgyro::internal
