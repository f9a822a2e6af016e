// SPDX-License-Identifier: MIT
#include "validation/page/residual_means.h"

#include <algorithm>
#include <cmath>

#include "compensation/inputs/sample_ranges.h"
#include "validation/metrics/segments.h"
#include "validation/page/figures.h"

namespace beamgyro::internal {

std::vector<ResidualMean> residual_means(const EvidenceRun& run, double least) {
  const auto& time = run.recording->time;
  if (time.empty()) return {};
  const double length =
      std::max(least, std::ceil((time.back() - time.front()) /
                                static_cast<double>(kFigurePoints)));
  const auto segments =
      segments_of(*run.recording, score_blocks(*run.recording, length));
  const std::vector<double> values = means_over(segments, residual_of(run));
  std::vector<ResidualMean> means;
  for (std::size_t k = 0; k < segments.size(); ++k)
    if (std::isfinite(values[k]))
      means.push_back(
          {segments[k].powered, segments[k].temperature, values[k]});
  return means;
}

}  // namespace beamgyro::internal
