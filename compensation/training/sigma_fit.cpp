// SPDX-License-Identifier: MIT
#include "compensation/training/sigma_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "compensation/methods/bias_model.h"
#include "compensation/methods/population.h"
#include "compensation/models/array_view.h"
#include "compensation/models/bias_function.h"
#include "compensation/rows/row_groups.h"
#include "compensation/training/cross_validation.h"
#include "compensation/uncertainty/sigma_calibration.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;

constexpr double kDoublingDistance = 10.0;  // [K], at least, outside the range

template <class... Kinds>
bool is_one_of(const FitSpec& kind) {
  return (std::holds_alternative<Kinds>(kind) || ...);
}

ArrayXd sigma_grid(const TemperatureRange& range) {
  constexpr double kStep = 2.5;  // [K]
  const double span = range.highest - range.lowest;
  if (!(span > 0.0)) return ArrayXd::Constant(1, range.lowest);
  const auto steps = static_cast<Index>(std::ceil(span / kStep));
  return ArrayXd::LinSpaced(std::clamp<Index>(steps, 1, 100) + 1, range.lowest,
                            range.highest);
}

// The population that a compensator was learned from, if there is one.
const Population* population_behind(const FittedCompensator& trained,
                                    const FitSpec& kind) {
  if (const auto* adapted = std::get_if<AdaptedSpec>(&kind))
    return &adapted->population;
  return trained.population ? &*trained.population : nullptr;
}

// A temperature that is clamped leaves the slope of the bias beyond the range.
// Nothing there tells it: the steepest within the range stands for it, of the
// bias and of the devices of its population.
std::array<double, 2> growth_of(const FittedCompensator& trained,
                                const FitSpec& kind, const BiasSigma& sigma) {
  const LookupTable& curve = sigma.curve;
  const ArrayXd& T = curve.temperatures;
  const Index last = T.size() - 1;
  std::array<double, 2> growth = {curve.values(0) / kDoublingDistance,
                                  curve.values(last) / kDoublingDistance};
  if (last < 1) return growth;
  const bool of_temperature =
      trained.inputs.size() == 1 &&
      trained.inputs[0] == Input{InputKind::kColumn, "temperature", 0.0};
  const ArrayXd bias =
      of_temperature ? trained.bias.predict(T) : trained.baseline.predict(T);
  double steepest =
      ((bias.tail(last) - bias.head(last)) / (T.tail(last) - T.head(last)))
          .abs()
          .maxCoeff();
  if (const Population* population = population_behind(trained, kind))
    steepest = std::max(steepest, steepest_bias(*population));
  // Of sigma, which is the factor times the growth.
  for (double& each : growth) each = std::max(each, steepest / sigma.factor);
  return growth;
}

// s(T) from the soaks of held-out rows, or all where there are none.
LookupTable residual_curve(const ResidualRows& rows,
                           const TemperatureRange& range) {
  const RowMask soaks = soak_rows(rows);
  const RowMask mask =
      soaks.any() ? soaks : RowMask::Constant(rows.size(), true);
  std::vector<Index> which;
  for (Index k = 0; k < rows.size(); ++k)
    if (mask(k)) which.push_back(k);
  const ArrayXd grid = sigma_grid(range);
  return {grid, local_rms(rows.temperature(which),
                          rows.residual(which).square(), grid)};
}

// What is known before any calibration. Throws UndeterminedFit where nothing
// is.
BiasSigma uncalibrated(const FittedCompensator& trained,
                       const SigmaTask& task) {
  if (trained.population) return population_sigma(*trained.population);
  if (const auto* adapted = std::get_if<AdaptedSpec>(&task.kind))
    return adapted_sigma(
        adapted->population,
        adapted_bias(adapted->population, task.inputs,
                     adapted->used_rows(task.rows), adapted->noise)
            .deviation,
        adapted->noise.run);
  if (!is_one_of<PolynomialSpec, SplineSpec>(task.kind) ||
      has_several_devices(task))
    throw UndeterminedFit(
        "it takes residuals of held-out runs, or of groups that "
        "cross-validation leaves out");
  LeftOutSigma curve =
      left_out_sigma(task.kind, task.inputs, task.rows,
                     sigma_grid(trained.temperature_range), task.seed);
  BiasSigma sigma;
  sigma.source = SigmaSource::kCovariance;
  sigma.curve = std::move(curve.sigma);
  sigma.calibration = {
      "none: residuals of groups of training rows that were "
      "left out in turn",
      kLeftOutGroup, static_cast<std::size_t>(curve.groups)};
  return sigma;
}

bool is_calibrated_by_population(const SigmaTask& task, int groups) {
  const auto* adapted = std::get_if<AdaptedSpec>(&task.kind);
  return adapted != nullptr && adapted->population.sigma &&
         groups < kLeastConformalGroups;
}

constexpr int kLeastLeftOut = 3;
constexpr double kLeastRms = 1e-6;  // [deg/s]: residuals of 0 promise nothing

// Mean temperature and square of the mean residual of groups that the others
// surround.
struct LeftOutGroups {
  std::vector<double> temperature, square;
};

LeftOutGroups left_out_groups(const TrainingRows& rows, const RowGroups& groups,
                              const ArrayXd& residual) {
  LeftOutGroups found;
  for (int group = 0; group < groups.count; ++group) {
    const RowMask own = between_others(rows, groups, group);
    double count = 0.0, T = 0.0, sum = 0.0;
    for (Index k = 0; k < rows.size(); ++k) {
      if (!own(k)) continue;
      count += 1.0;
      T += rows.temperature(k);
      sum += residual(k);
    }
    if (count == 0.0) continue;
    found.temperature.push_back(T / count);
    found.square.push_back(sum / count * (sum / count));
  }
  return found;
}

// Inputs at temperatures, all others at their means.
ArrayXXd inputs_at(const TrainingRows& rows, const ArrayXd& T) {
  ArrayXXd x = rows.inputs.colwise().mean().replicate(T.size(), 1);
  x.col(0) = T;
  return x;
}

// h at temperatures.
ArrayXd leverage(const FitSpec& kind, const std::vector<Input>& inputs,
                 const TrainingRows& rows, const RowGroups& groups,
                 const ArrayXd& T, std::uint64_t seed) {
  ArrayXd sum = ArrayXd::Zero(T.size());
  TrainingRows moved = rows;
  for (int group = 0; group < groups.count; ++group) {
    moved.bias = (groups.of_row == group).cast<double>();
    sum += fit_model(kind, inputs, moved, {}, seed)
               .model.predict(inputs_at(rows, T))
               .square();
  }
  return sum;
}

int group_count_of(const ResidualRows& rows) {
  return groups_among(rows, RowMask::Constant(rows.size(), true));
}

// Whether no run but one has told it: the soaks of a run share its turn-on
// offset and slow noise, and so they do not tell how the next run differs.
bool is_of_one_run(const BiasSigma& sigma) {
  return sigma.source == SigmaSource::kCovariance &&
         sigma.calibration.by == kLeftOutGroup;
}

constexpr const char* kOneRun =
    "one leg of one run does not tell how the next run differs, in turn-on "
    "offset, slow noise or lag: expected two runs or more, or two held-out "
    "ones";

void calibrate_on_held_out(const FittedCompensator& trained,
                           const SigmaTask& task,
                           std::optional<BiasSigma>& sigma,
                           std::string& why_none) {
  const ResidualRows rows = residuals_of(trained, task.held_out_runs, task);
  const int groups = group_count_of(rows);
  if (groups == 0) {
    why_none += "; held-out runs have no row within the temperatures";
  } else if (groups == 1) {
    why_none =
        "one held-out run does not tell how runs differ: expected two or more, "
        "or one of several power cycles or legs";
  } else {
    if (!sigma) {
      sigma.emplace();
      sigma->curve = residual_curve(rows, trained.temperature_range);
    }
    if (!is_calibrated_by_population(task, groups)) calibrate(*sigma, rows);
  }
}

// Groups of the training rows in place of held-out runs. Fits that are not
// linear are not repeated unless cross-validation was asked for.
void calibrate_on_left_out(const FittedCompensator& trained,
                           const SigmaTask& task,
                           std::optional<BiasSigma>& sigma,
                           std::string& why_none) {
  const bool is_linear = is_one_of<PolynomialSpec, SplineSpec>(task.kind);
  std::optional<RowGroups> groups;
  if (is_linear || task.groups) groups = groups_to_leave_out(task);
  if (groups) try {
      const ResidualRows rows = left_out_residuals(trained, task, *groups);
      if (group_count_of(rows) >= 2) {
        sigma.emplace();
        sigma->curve = residual_curve(rows, trained.temperature_range);
        calibrate(*sigma, rows);
        sigma->calibration.method +=
            "; each was predicted by a fit to the others";
        return;
      }
      why_none +=
          "; the groups left out have no row within the temperatures "
          "of the others";
    } catch (const UndeterminedFit& error) {
      why_none += std::string("; ") + error.what();
    }
}

template <class Count>
[[noreturn]] void fail_soaks(Count found, const char* where) {
  throw UndeterminedFit(fmt::format(
      "the rows have {} soaks{}; expected {} or more, each to be predicted by "
      "the others",
      found, where, kLeastLeftOut));
}

}  // namespace

bool may_state_sigma(const FitSpec& kind) {
  return !is_one_of<NoneSpec, ConstantSpec, ThermistorSpec, Px4Spec,
                    ArduPilotSpec>(kind);
}

std::optional<BiasSigma> fit_bias_sigma(const FittedCompensator& trained,
                                        const SigmaTask& task,
                                        std::string& why_none) {
  if (!may_state_sigma(task.kind)) return std::nullopt;
  std::optional<BiasSigma> sigma;
  try {
    sigma = uncalibrated(trained, task);
  } catch (const UndeterminedFit& error) {
    why_none = error.what();
  }
  if (task.held_out_runs.count > 0)
    calibrate_on_held_out(trained, task, sigma, why_none);
  if ((!sigma || is_of_one_run(*sigma)) &&
      population_behind(trained, task.kind) == nullptr)
    calibrate_on_left_out(trained, task, sigma, why_none);
  if (sigma && is_of_one_run(*sigma)) {
    sigma.reset();
    if (why_none.empty()) why_none = kOneRun;
  }
  if (sigma) {
    sigma->growth = growth_of(trained, task.kind, *sigma);
    why_none.clear();
  }
  return sigma;
}

std::optional<AdaptationSigma> fit_adaptation_sigma(
    const Population& population, const LookupTable* scale_factor,
    const SigmaTask& task, std::vector<std::string>& remarks) {
  const auto* spec = std::get_if<PopulationSpec>(&task.kind);
  if (spec == nullptr || !task.held_out_runs.set ||
      task.held_out_runs.count == 0)
    return std::nullopt;
  return adaptation_sigma(
      population, task.inputs, task.held_out,
      own_curve_residuals(rows_with_ramps(task.held_out_runs, task.inputs, task,
                                          {}, scale_factor),
                          spec->grid_K, remarks));
}

ArrayXd local_rms(const Eigen::Ref<const ArrayXd>& T,
                  const Eigen::Ref<const ArrayXd>& squares, const ArrayXd& at) {
  const double span = T.maxCoeff() - T.minCoeff();
  const double width = span > 0.0 ? span / 8.0 : 1.0;  // [K]
  const double shared = 0.1 * static_cast<double>(T.size());
  ArrayXd result(at.size());
  for (Index k = 0; k < at.size(); ++k) {
    const ArrayXd weights = (-0.5 * ((T - at(k)) / width).square()).exp();
    const double mean = ((weights * squares).sum() + shared * squares.mean()) /
                        (weights.sum() + shared);
    result(k) = std::max(std::sqrt(mean), kLeastRms);
  }
  return result;
}

RowGroups soak_groups(const TrainingRows& rows) {
  RowGroups groups{Grouping::kSegment, Eigen::ArrayXi(rows.size()), 0};
  double first = 0.0;
  for (Index k = 0; k < rows.size(); ++k) {
    const bool anew = k == 0 || rows.cycle(k) != rows.cycle(k - 1) ||
                      std::abs(rows.temperature(k) - first) >= kPointWidth;
    if (anew) {
      first = rows.temperature(k);
      ++groups.count;
    }
    groups.of_row(k) = groups.count - 1;
  }
  return groups;
}

LeftOutSigma left_out_sigma(const FitSpec& kind,
                            const std::vector<Input>& inputs,
                            const TrainingRows& rows, const ArrayXd& at,
                            std::uint64_t seed) {
  const RowGroups groups = soak_groups(rows);
  if (groups.count < kLeastLeftOut) fail_soaks(groups.count, "");
  RowGroups folds = groups;
  folds.count = std::min(groups.count, kMostLeftOut);
  folds.of_row =
      groups.of_row.unaryExpr([](int group) { return group % kMostLeftOut; });
  const Predictions unseen = predict_unseen(kind, inputs, rows, folds, seed);
  const LeftOutGroups left =
      left_out_groups(rows, groups, rows.bias - unseen.bias);
  if (left.square.size() < kLeastLeftOut)
    fail_soaks(left.square.size(), " between the temperatures of the others");
  const ArrayXd T = array_view(left.temperature);
  ArrayXd sigma = local_rms(T, array_view(left.square), at);
  if (groups.count <= kMostLeftOut) {
    const double usual = leverage(kind, inputs, rows, groups, T, seed).mean();
    sigma *=
        ((1.0 + leverage(kind, inputs, rows, groups, at, seed)) / (1.0 + usual))
            .sqrt();
  }
  return {{at, sigma}, static_cast<int>(left.square.size())};
}

}  // namespace beamgyro::internal
