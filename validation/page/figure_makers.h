// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "validation/evidence/evidence.h"
#include "validation/page/figure.h"

namespace beamgyro::internal {

/// The same runs with the rate before and after compensation.
struct ComparedEvidence {
  const Evidence& before;
  const Evidence& after;
};

/// Calls `visit(role, run)` for the runs of a purpose, first with the recorded
/// rates ("before"), then with those of the compensator ("after").
template <typename Visit>
void for_both(const ComparedEvidence& evidence, RunPurpose purpose,
              const Visit& visit) {
  for (const EvidenceRun* run : runs_for(evidence.before, {purpose}))
    visit("before", *run);
  for (const EvidenceRun* run : runs_for(evidence.after, {purpose}))
    visit("after", *run);
}

/// The axis of a figure over what the temperature sensor shows.
FigureAxis temperature_axis();

/// Each returns the figures that the runs allow, without or with series.
std::vector<Figure> bias_over_temperature_figures(const ComparedEvidence& both);
std::vector<Figure> hysteresis_figures(const ComparedEvidence& both);
std::vector<Figure> warm_up_figures(const ComparedEvidence& both);
std::vector<Figure> residual_histogram_figures(const ComparedEvidence& both);
std::vector<Figure> rate_table_figures(const ComparedEvidence& both);
std::vector<Figure> frequency_response_figures(const ComparedEvidence& both);
std::vector<Figure> rate_step_figures(const ComparedEvidence& both);
std::vector<Figure> allan_figures(const ComparedEvidence& both);

}  // namespace beamgyro::internal
