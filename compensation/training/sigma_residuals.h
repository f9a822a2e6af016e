// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "compensation/inputs/input.h"
#include "compensation/methods/method_list.h"
#include "compensation/models/lookup_table.h"
#include "compensation/rows/row_groups.h"
#include "compensation/rows/run_source.h"
#include "compensation/rows/training_rows.h"
#include "compensation/uncertainty/sigma_calibration.h"

namespace beamgyro::internal {

/// What the sigma of a trained compensator is fitted to.
struct SigmaTask {
  const FitSpec& kind;
  const std::vector<Input>& inputs;  // that `kind` was fitted to
  const RowOptions& options;         // of these rows
  const TrainingRows& rows;          // their columns are `inputs`
  const TrainingRows& held_out;      // likewise; may be empty
  const RunSource& runs;
  const RunSource& held_out_runs;
  std::uint64_t seed;
  // Of `rows`, which cross-validation left out in turn, if it did.
  std::optional<RowGroups> groups = {};
};

/// Whether the training rows are of several devices of a set. Files are taken
/// for those of one gyro.
bool has_several_devices(const SigmaTask& task);

/// Returns the rows of all runs, those of ramps and warm-ups, too. After the
/// columns of `inputs` come since_power_on and temperature_rate, of the time
/// constant kSigmaTimeConstant. Throws as training_rows().
TrainingRows rows_with_ramps(const RunSource& runs, std::vector<Input> inputs,
                             const SigmaTask& task,
                             const TemperatureRange& range,
                             const LookupTable* scale_factor);

/// Returns what `trained` leaves of the training or the held-out runs,
/// whichever `runs` are, within its temperatures or in a warm-up, which may
/// lead to them. Groups are the devices of a held-out set, else runs, power
/// cycles or legs, whichever gives two first; of training runs, legs.
ResidualRows residuals_of(const FittedCompensator& trained,
                          const RunSource& runs, const SigmaTask& task);

/// Returns the groups of training rows that are left out in turn where no run
/// is held out: those of the cross-validation, else runs, power cycles or legs,
/// whichever gives two of which the others cover each first. Segments of one
/// leg are none, and neither are the devices of a set.
std::optional<RowGroups> groups_to_leave_out(const SigmaTask& task);

/// Returns what each of the groups leaves, rows of ramps and warm-ups included,
/// when it is predicted by a fit to the others (predict_others()), within their
/// temperatures. A row belongs to the group of the training row of its run that
/// is nearest in time. The residuals are multiplied by sqrt(1 - 1/G^2) for G
/// groups: the next one will be predicted by all of them. Throws as
/// predict_unseen().
ResidualRows left_out_residuals(const FittedCompensator& trained,
                                const SigmaTask& task, const RowGroups& groups);

}  // namespace beamgyro::internal
