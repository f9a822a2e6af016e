// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/network_training.h"

namespace beamgyro {

/// Damped Gauss-Newton on F(w) = mean(e^2) / 2 + decay |w|^2 / 2:
///
///   (J^T J / N + decay I + mu I) s = -dF/dw
///
/// A step is kept when it lowers F. Damping after Nielsen (IMM-REP-1999-05):
/// with rho the fall of F over the fall the quadratic model predicts, a kept
/// step multiplies mu by max(1/3, 1 - (2 rho - 1)^3), a discarded one by 2, 4,
/// 8, ... An epoch is one step tried. After every kept step the held-out rms is
/// looked at. Reference: Marquardt, J. SIAM 11 (1963) 431.
TrainSummary train_levenberg_marquardt(const ScaledRows& rows,
                                       const ScaledRows& held_out,
                                       const TrainOptions& options,
                                       BpNetwork& network);

}  // namespace beamgyro
