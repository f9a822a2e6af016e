// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "validation/external/tested_compensator.h"
#include "validation/metrics/metric.h"
#include "validation/qualification/qualified_runs.h"

namespace beamgyro::internal {

/// Metrics of one set of runs, before and after compensation, in the order in
/// which they were asked for.
struct FoundMetrics {
  std::vector<std::optional<Estimate>> before, after;
};

/// A device on those runs of a qualification that some metrics read, judged as
/// recorded and after a model that was trained once on the training runs. Its
/// functions may be called from any thread.
class SeededRuns {
 public:
  /// Throws as the readers of the files do.
  SeededRuns(const std::filesystem::path& qualification,
             const std::filesystem::path& device,
             const std::filesystem::path& model,
             std::vector<const Metric*> asked, std::size_t threads);

  const std::vector<const Metric*>& asked() const { return asked_; }

  /// Returns the metrics with noise and random rates of a seed.
  FoundMetrics noisy(std::uint64_t seed) const;

  /// Returns the same without the noise; the runs that have some are recorded
  /// with a converter of 24 bits.
  FoundMetrics quiet(std::uint64_t seed) const;

  /// Returns the metrics of a seed without the noise of the rate, but with that
  /// of the temperature sensor: it decides how often the last digit rounds up.
  FoundMetrics without_rate_noise(std::uint64_t seed) const;

 private:
  std::vector<QualificationRun> runs_of(std::uint64_t seed) const;
  FoundMetrics found_in(std::vector<Recording> recordings) const;

  std::vector<const Metric*> asked_;
  Qualification qualification_;
  QualifiedDevice device_;
  std::shared_ptr<const TestedCompensator> compensator_;
};

}  // namespace beamgyro::internal
