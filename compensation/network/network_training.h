// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "compensation/models/bp_network.h"
#include "include/beamgyro/progress.h"

namespace beamgyro::internal {

enum class Trainer { kIncremental, kGradientAdaptive, kLevenbergMarquardt };

/// Default of the two gradient trainers, which need many cheap epochs.
constexpr int kGradientMaxEpochs = 20000;
constexpr int kGradientPatience = 2000;

/// Reason why a training ended. sentence() returns it in words.
enum class StopReason {
  kLeastSquares,   // no iteration: the normal equations have one solution
  kGoalReached,    // in-sample rms <= goal
  kGradientSmall,  // max |dF/dw| <= min_gradient
  kStepSmall,      // |step| <= min_step (|w| + min_step)
  kDampingLimit,   // damping > max_damping: no step lowers the error
  kRateSmall,  // learning rate < min_learning_rate: no step lowers the error
  kHeldOutRising,  // no new lowest held-out error for `patience` epochs
  kMaxEpochs,      // epochs = max_epochs
};

std::string sentence(StopReason reason);

/// Is called by the threads of all restarts. It has no influence on a training.
using EpochObserver = std::function<void(const TrainingProgress&)>;

/// Errors are of scaled quantities (order one). F = mean(e^2) / 2 +
/// weight_decay |w|^2 / 2.
struct TrainOptions {
  Trainer trainer = Trainer::kLevenbergMarquardt;
  int restarts = 4;      // >= 1, from different initial weights
  int max_epochs = 300;  // >= 1; passes over the rows
  int patience = 60;     // [epochs], >= 1
  int threads = 1;       // >= 1; of one training; the gradient rules use one
  int cores = 0;         // of all restarts together; 0 = those there are
  double goal = 0.0;     // rms, >= 0
  double weight_decay = 0.0;  // >= 0; kLevenbergMarquardt
  // Adds rate_penalty mean(g^2) / 2 to F, where g is the share of a rate along
  // rate_direction that is mistaken for drift (RatePenalty). For
  // kLevenbergMarquardt only.
  double rate_penalty = 0.0;                // >= 0
  std::vector<double> rate_direction = {};  // one per input
  double learning_rate = 0.02;  // eta of equation (5), > 0; its first value
  double momentum = 0.9;        // h of equation (5), in [0, 1)
  double min_learning_rate = 1e-9;
  double initial_damping = 1e-2;
  double max_damping = 1e10;
  double min_gradient = 1e-10;
  double min_step = 1e-10;
  EpochObserver observer = {};
};

/// Outcome of one training from one set of initial weights.
struct TrainSummary {
  StopReason stop_reason = StopReason::kMaxEpochs;
  int epochs = 0;              // done
  int best_epoch = 0;          // whose weights were kept
  double in_sample_rms = 0.0;  // with the weights kept, in the rows' unit
  std::optional<double> held_out_rms;
};

/// Rows of a training or held-out set, scaled to order one.
struct ScaledRows {
  Eigen::ArrayXXd inputs;  // one row per sample, one column per input
  Eigen::ArrayXd target;   // one per sample

  Eigen::Index size() const { return target.size(); }
};

/// Tells the observer, if there is one.
void report_epoch(const TrainOptions& options, int epoch, double rms);

double rms_error(const BpNetwork& network, const ScaledRows& rows);

/// Returns whether squared errors are no larger than `least`, those of the same
/// rows with other weights, within noise: the mean difference is within two
/// standard errors. These come from the means of 20 stretches of rows, because
/// neighbouring rows share their noise.
bool no_worse(const Eigen::ArrayXd& squares, const Eigen::ArrayXd& least);

/// Keeps the weights with the lowest held-out mean(e^2) / 2 + rate penalty so
/// far. The penalty is included because held-out rows at rest are predicted
/// best by cancelling the rate. Without held-out rows it keeps the last
/// weights.
class BestWeights {
 public:
  BestWeights(const ScaledRows& held_out, int patience)
      : held_out_(held_out), patience_(patience) {}

  /// Compares the network after `epoch`. Returns true when the lowest value is
  /// `patience` or more epochs old.
  bool stale_after(int epoch, const BpNetwork& network,
                   double rate_penalty = 0.0);

  /// Copies the kept weights to `network` and writes the scores of the summary.
  void restore(const ScaledRows& rows, BpNetwork& network,
               TrainSummary& summary) const;

 private:
  const ScaledRows& held_out_;
  int patience_;
  int epoch_ = 0;
  double rms_ = std::numeric_limits<double>::infinity();
  double lowest_ = std::numeric_limits<double>::infinity();
  Eigen::VectorXd weights_;
};

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

/// Trains once from the present weights of `network` and leaves the best
/// weights in it. `held_out` may be empty. `order` shuffles the rows of the
/// incremental rule; other trainers do not use it.
TrainSummary train_network(const ScaledRows& rows, const ScaledRows& held_out,
                           const TrainOptions& options, RandomStream& order,
                           BpNetwork& network);

/// Trainings of one network from several sets of initial weights.
struct Restarts {
  std::vector<TrainSummary> summaries;  // one per restart
  std::size_t chosen = 0;               // best_network()
  BpNetwork network;                    // of the chosen restart
};

/// Returns the index of the network to keep. Of those that are no_worse() on
/// the held-out rows than the best one there, it is the one with the least
/// squared error over training and held-out rows together. Without held-out
/// rows it is the one with the least in-sample error. The rate penalty of the
/// network is added to every error, because rows at rest are predicted best by
/// cancelling the rate.
std::size_t best_network(const std::vector<BpNetwork>& networks,
                         const ScaledRows& rows, const ScaledRows& held_out,
                         const TrainOptions& options);

/// Runs `options.restarts` trainings on `options.cores` threads; 0 means one
/// per core. Restart k draws from the streams (seed, 0, k, kInitialWeights) and
/// (seed, 0, k, kSampleOrder), so the result does not depend on the threads.
/// Throws std::runtime_error when a restart diverges.
Restarts train_from_restarts(const std::vector<int>& layer_sizes,
                             const ScaledRows& rows, const ScaledRows& held_out,
                             const TrainOptions& options, std::uint64_t seed);

}  // namespace beamgyro::internal
