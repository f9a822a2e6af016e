// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "config/units.h"
#include "sim/scenario/simulation_input.h"
#include "validation/external/compensator_source.h"
#include "validation/metrics/metric.h"
#include "validation/qualification/qualification_file.h"
#include "validation/result/device_evidence.h"

namespace beamgyro::internal::shipped_runs_coverage_test {
namespace {

constexpr std::uint64_t kSeedStep = 1000000;  // above every seed of the file

/// A shipped device on the runs of the shipped qualification that some metrics
/// read, judged as recorded and after a cubic.
class ShippedRuns {
 public:
  ShippedRuns(const std::string& device, const std::vector<std::string>& names)
      : names_(names),
        qualification_(read_qualification(std::string(BEAMGYRO_SCENARIOS) +
                                          "/qualification.toml")) {
    const LoadedDevice loaded = load_device(
        std::string(BEAMGYRO_SCENARIOS) + "/devices/" + device + ".toml", {});
    device_ = {loaded.device, loaded.text};
    const ModelSpec cubic = read_model(std::filesystem::path(
        std::string(BEAMGYRO_SCENARIOS) + "/models/cubic.toml"));
    compensator_ = tested(
        trained_on(training_data(qualification_, device_, &cubic, 1), cubic));
    std::erase_if(qualification_.runs, [&](const QualificationRun& run) {
      return !run.scenario.noise_enabled ||
             std::ranges::none_of(names_, [&](const std::string& name) {
               return std::ranges::count(find_metric(name)->reads,
                                         run.purpose) > 0;
             });
    });
  }

  /// The metrics with noise of other seeds; before and after in turn.
  std::vector<Estimate> noisy(std::uint64_t seed) const {
    std::vector<QualificationRun> runs = qualification_.runs;
    for (QualificationRun& run : runs) run.scenario.seed += kSeedStep * seed;
    return found_with(runs, device_);
  }

  /// The same without noise and with a converter of 24 bits.
  std::vector<Estimate> quiet() const {
    std::vector<QualificationRun> runs = qualification_.runs;
    for (QualificationRun& run : runs) run.scenario.noise_enabled = false;
    QualifiedDevice unit = device_;
    unit.device.readout.adc_bits = 24;
    return found_with(runs, unit);
  }

 private:
  std::vector<Estimate> found_with(const std::vector<QualificationRun>& runs,
                                   const QualifiedDevice& unit) const {
    std::vector<ReadRun> read;
    for (const QualificationRun& run : runs)
      read.push_back({run.name, run.purpose, run.from});
    const DeviceEvidence evidence = answered_evidence(
        std::move(read), qualified_runs(runs, unit, 1),
        {*compensator_, {}, unit.device.readout.full_scale / kDegree}, 1);
    std::vector<Estimate> found;
    for (const std::string& name : names_)
      for (const Evidence* rates : {&evidence.before, &evidence.after})
        found.push_back(*find_metric(name)->evaluate(*rates));
    return found;
  }

  std::vector<std::string> names_;
  Qualification qualification_;
  QualifiedDevice device_;
  std::shared_ptr<const TestedCompensator> compensator_;
};

/// Expects that at least so many of the intervals of each metric hold its
/// value without noise.
void expect_covered(const std::string& device,
                    const std::vector<std::string>& names, int seeds,
                    int least) {
  SCOPED_TRACE(device);
  const ShippedRuns runs(device, names);
  const std::vector<Estimate> truth = runs.quiet();
  std::vector<int> covered(truth.size());
  for (int seed = 1; seed <= seeds; ++seed) {
    const std::vector<Estimate> found =
        runs.noisy(static_cast<std::uint64_t>(seed));
    for (std::size_t i = 0; i < found.size(); ++i)
      covered[i] += found[i].interval->low <= truth[i].value &&
                            truth[i].value <= found[i].interval->high
                        ? 1
                        : 0;
  }
  for (std::size_t i = 0; i < covered.size(); ++i)
    EXPECT_GE(covered[i], least)
        << names[i / 2] << (i % 2 == 0 ? " before" : " after");
}

const std::vector<std::string> kOfPowerOns = {"power_on_drift_3_min_deg_per_s",
                                              "heading_error_1_min_deg",
                                              "heading_error_10_min_deg"};
const std::vector<std::string> kOfTables = {"scale_factor_error_ppm",
                                            "scale_factor_nonlinearity_ppm",
                                            "scale_factor_asymmetry_ppm"};

// Of 40 intervals of 95 % 33 or fewer hold the truth with a probability of
// 0.003.
TEST(ManyDrawsOfShippedRuns, HoldTheTruthOfMaximaFromPowerOn) {
  expect_covered("nominal", kOfPowerOns, 40, 34);
}

TEST(ManyDrawsOfShippedRuns, HoldTheTruthOfMaximaOfRateTables) {
  expect_covered("nominal", kOfTables, 40, 34);
}

// Its turn-on settles over minutes.
TEST(ManyDrawsOfShippedRuns, HoldTheTruthOfADeviceWhoseTurnOnSettles) {
  expect_covered("lifelike", {"heading_error_10_min_deg"}, 40, 34);
}

const std::vector<std::string> kOthers = {
    "bias_deg_per_s",
    "bias_pp_deg_per_s",
    "bias_sigma_deg_per_s",
    "bias_sensitivity_deg_per_s_per_K",
    "bias_sensitivity_max_deg_per_s_per_K",
    "residual_mean_deg_per_s",
    "residual_sigma_deg_per_s",
    "residual_rms_deg_per_s",
    "residual_max_deg_per_s",
    "residual_pp_deg_per_s",
    "hysteresis_max_deg_per_s",
    "hysteresis_rms_deg_per_s",
    "soak_hysteresis_max_deg_per_s",
    "scale_factor",
    "scale_factor_temperature_sensitivity_ppm_per_K",
    "g_sensitivity_x_deg_per_s_per_g",
    "g_sensitivity_y_deg_per_s_per_g",
    "g_sensitivity_z_deg_per_s_per_g",
    "vibration_rectification_deg_per_s_per_g2",
    "cross_axis_percent"};

// More seeds and every metric that is beneath the noise; test.sh has the
// metrics that once failed.
TEST(DeepShippedRuns, HoldTheTruthOfEveryMetric) {
  for (const char* device : {"nominal", "lifelike"})
    for (const auto& names : {kOfPowerOns, kOfTables, kOthers})
      expect_covered(device, names, 100, 90);
}

}  // namespace
}  // namespace beamgyro::internal::shipped_runs_coverage_test
