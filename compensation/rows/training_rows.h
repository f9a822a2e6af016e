// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "compensation/inputs/features.h"
#include "compensation/inputs/input.h"
#include "compensation/models/lookup_table.h"
#include "compensation/rows/run_source.h"

namespace beamgyro::internal {

/// Table [rows] of a model file: how samples are averaged to training rows.
struct RowOptions {
  // [s], length of the blocks that are averaged; 0 = every sample is a row
  double seconds = 60.0;
  // [K/min]; rows whose temperature changes faster are left out
  std::optional<double> steady_K_per_min;
  // [min]; a row has the temperature at which the sensor would settle with the
  // beam as it is, T - lag dT/dt
  double lag_min = 0.0;
  // [min]; rows that begin earlier after a power-on are left out
  double after_power_on_min = 0.0;
};

/// Means over blocks of samples, to which models are fitted.
struct TrainingRows {
  Eigen::ArrayXXd inputs;      // one row per block, one column per input
  Eigen::ArrayXd temperature;  // [degC], measured
  Eigen::ArrayXd bias;         // [deg/s], measured rate - known true rate
  TemperatureRange range;      // [degC], of the samples that were averaged
  // Run, cycle and so on that each block belongs to, numbered from 0 through
  // all runs.
  Eigen::ArrayXd time;   // [s], mean
  Eigen::ArrayXi run;    // recording
  Eigen::ArrayXi cycle;  // time from a power-on to the next loss of power
  Eigen::ArrayXi leg;    // part of a cycle between reversals of temperature
  double output_per_rate = 0.0;  // [V/(deg/s)]; 0 without an output that varies
  double true_rate_span = 0.0;   // [deg/s], of the samples that were averaged
  // [K], by which the mean measured temperature lies beyond the value that it
  // was clamped to; 0 within.
  Eigen::ArrayXd beyond_range;
  Eigen::ArrayXi device;  // whose run it was
  // Inputs of the blocks that steady_K_per_min left out, whose bias is not
  // used: methods that learn from quadrature take them.
  Eigen::ArrayXXd moving = {};

  Eigen::Index size() const { return bias.size(); }
};

/// A reversal of the temperature by this much begins another leg.
constexpr double kLegReversal = 2.0;  // [K]

/// Makes the rows of all runs, which are visited once. Inputs are computed at
/// the sample rate of the recording. They and the label, rate - true_rate, are
/// then averaged over consecutive blocks of `options.seconds` (0: every sample
/// is a block), counted from each power-on.
/// - Samples without power, saturated or with a loop not locked are left out,
///   and with after_power_on_min blocks that begin earlier after a power-on.
/// - Blocks with less than half the samples of the fullest block of their run
///   are left out, and with steady_K_per_min also blocks over which the
///   measured temperature changes faster (slope of a straight line). Of those
///   the inputs are kept, `moving`; they need no true rate.
/// - With lag_min, the temperature of a block and the input "temperature" are
///   less by lag_min times its rate, within `range`. The rate is that between
///   blocks up to two before and after it that are steady all the way.
/// - Temperatures are clamped to `range` as at run time.
/// - With `scale_factor`, s of the measured temperature, the label is rate - s
///   true_rate.
/// Throws std::invalid_argument naming the run when it lacks an input or
/// true_rate, has a sample that is not finite or no usable sample; also when no
/// row is left.
TrainingRows training_rows(const RunSource& runs,
                           const std::vector<Input>& inputs,
                           const RowOptions& options,
                           const TemperatureRange& range = {},
                           const LookupTable* scale_factor = nullptr);

/// Rows begin <= k < end.
struct RowStretch {
  Eigen::Index begin, end;
};

/// Returns the stretches of rows that follow each other with one label, such as
/// TrainingRows::cycle.
std::vector<RowStretch> stretches_of(const Eigen::ArrayXi& labels);

/// Returns the rows for which `keep` is true. Range and `moving` stay.
TrainingRows selected(const TrainingRows& rows,
                      const Eigen::Array<bool, Eigen::Dynamic, 1>& keep);

/// Returns the rows with the columns of the inputs `wanted`, which are some of
/// `all`, in that order.
TrainingRows with_columns(const TrainingRows& rows,
                          const std::vector<Input>& all,
                          const std::vector<Input>& wanted);

}  // namespace beamgyro::internal
