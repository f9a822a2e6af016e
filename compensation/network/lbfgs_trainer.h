// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/network/network_training.h"

namespace beamgyro {

/// Limited-memory BFGS (Liu and Nocedal, Math. Program. 45 (1989) 503) on F(w)
/// = mean(e^2) / 2 + decay |w|^2 / 2, with a line search to the strong Wolfe
/// conditions. An epoch is one line search, which needs one or more passes over
/// the rows. The held-out error is computed after each epoch. Throws
/// std::runtime_error when the error of the initial weights overflows.
TrainSummary train_lbfgs(const ScaledRows& rows, const ScaledRows& held_out,
                         const TrainOptions& options, BpNetwork& network);

}  // namespace beamgyro
