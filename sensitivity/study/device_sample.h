// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sensitivity/figures/figure_of_merit.h"
#include "sensitivity/indices/pick_freeze.h"
#include "sim/campaign/campaign.h"
#include "sim/campaign/draw_plan.h"

namespace beamgyro::internal {

/// Numbers of a device that are drawn together and independently of all others:
/// all elements of a key, and all keys that a correlation joins.
struct Factor {
  std::string key;                   // dotted keys, " + " between several
  std::vector<std::size_t> numbers;  // indices of DrawPlan::parameters
};

/// Returns the factors of a plan, in the order of their first keys.
std::vector<Factor> factors_of(const DrawPlan& plan);

/// Throws std::invalid_argument "CAMPAIGN: ..." for fewer than two factors.
void require_comparable(const std::vector<Factor>& factors,
                        const std::string& campaign);

/// Returns the plan with draw `index` of `share` of its width (narrowed()).
DrawPlan with_narrowed(DrawPlan plan, std::size_t index, double share);

struct DeviceSampleOptions {
  std::vector<Merit> merits;
  MeritOptions merit = {};
  std::size_t rows = 2048;
  std::uint64_t seed = 0;
  bool halves_tolerances = false;
  unsigned jobs = 0;  // 0: one per core
};

/// Counts of the work that is done so far, and of all. Other threads may read
/// them.
struct DeviceSampleCounts {
  std::atomic<std::uint64_t> devices{0}, failures{0}, all_devices{0};
  std::atomic<std::uint64_t> limited{0}, saturated{0};  // CurveLimits
  // Called after each, by many threads; what it throws ends the work.
  std::function<void()> on_device = {};
};

/// Values of one figure of merit; NaN is a device that does not work.
struct MeritSample {
  PickFreezeValues design;
  std::vector<double> independent;  // at rows of independent random numbers
  // At the rows of A, one tolerance halved: one entry for each of
  // DeviceSample::keys, empty for a choice, which has no half.
  std::vector<std::vector<double>> halved;
};

struct DeviceSample {
  std::vector<Factor> factors;
  std::vector<std::string> keys;         // of [tolerances]
  std::vector<Eigen::MatrixXd> numbers;  // of `independent`, for each factor
  std::vector<MeritSample> merits;       // in the order of the options
  std::uint64_t devices = 0, failures = 0;
  std::string first_failure;  // of the lowest row, one line
};

/// Returns the number of devices that sample_devices() computes.
std::uint64_t devices_of_sample(const CampaignPlan& campaign,
                                const DeviceSampleOptions& options);

/// Draws devices by the tolerances of a campaign and computes their figures of
/// merit. Rows j of A and B are the first and the second half of the
/// coordinates of the scrambled Sobol' point j (ScrambledSobol of `seed`); each
/// goes through the copulas and inverse distributions of the campaign. Other
/// rows are of independent numbers (random stream kRankSampleStream), because
/// neighbours of a Sobol' sequence avoid each other, which misleads an
/// estimator that compares them.
///
/// What cannot be drawn or does not work is counted as a failure. The result
/// does not depend on `jobs`. Throws std::invalid_argument for a campaign with
/// fewer than two factors, and what device_merits() throws for the base device,
/// which is computed first.
DeviceSample sample_devices(const CampaignPlan& campaign,
                            const DeviceSampleOptions& options,
                            DeviceSampleCounts& counts);

/// Tolerances that are narrowed together, each to `share` of its width.
struct Narrowing {
  std::vector<std::size_t> draws;  // indices of DeviceSample::keys
  double share;                    // (0, 1]
};

/// Returns the first figure of `options` of the devices at the rows of A, with
/// narrowed tolerances: one row of values for each narrowing, NaN for a device
/// that does not work. The devices are those of sample_devices() and are added
/// to the counts.
std::vector<std::vector<double>> narrowed_merits(
    const CampaignPlan& campaign, const DeviceSampleOptions& options,
    const std::vector<Narrowing>& narrowings, DeviceSampleCounts& counts);

}  // namespace beamgyro::internal
