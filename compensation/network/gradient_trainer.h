// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/network/network_training.h"

namespace beamgyro::internal {

/// The learning rate of the full-batch rule: a step after which the error is
/// more than 1.05 times the old one is discarded and the rate multiplied by
/// 0.70; any other step is kept, and when the error fell the rate is multiplied
/// by 1.05.
struct AdaptiveRate {
  double rate;  // > 0

  /// Updates the rate. Returns true when the step is to be kept.
  bool keep_step(double old_error, double new_error);
};

/// Trains sample by sample. After each row, in an order that is shuffled again
/// for every epoch,
///
///   dw(t+1) = h dw(t) - eta dE/dw,   E = e^2 / 2,   w(t+1) = w(t) + dw(t+1)
///
/// This is equation (5) with the momentum h applied to the step. Applied to the
/// weight itself, as (5) is printed, h < 1 would shrink every weight at every
/// sample.
TrainSummary train_incremental(const ScaledRows& rows,
                               const ScaledRows& held_out,
                               const TrainOptions& options, RandomStream& order,
                               BpNetwork& network);

/// Trains on the full batch: the same rule once for each epoch, with E =
/// mean(e^2) / 2 and the rate of AdaptiveRate; `error` is the sum of squares. A
/// discarded step clears the momentum, or it would be tried again.
TrainSummary train_gradient_adaptive(const ScaledRows& rows,
                                     const ScaledRows& held_out,
                                     const TrainOptions& options,
                                     BpNetwork& network);

}  // namespace beamgyro::internal
