// SPDX-License-Identifier: MIT
#include "compensation/rows/run_source.h"

namespace beamgyro::internal {

RunSource source_of(const std::vector<TrainingRun>& runs) {
  return {runs.size(), [&runs](const RunSource::Visitor& visit) {
            for (const TrainingRun& run : runs) visit(run);
          }};
}

}  // namespace beamgyro::internal
