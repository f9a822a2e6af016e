// SPDX-License-Identifier: MIT
#include "compensation/training/train.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "compensation/compensator/run_comparison.h"
#include "compensation/methods/bias_model.h"
#include "compensation/methods/straight_lines.h"
#include "compensation/scoring/scale_factor.h"
#include "compensation/training/cautions.h"
#include "compensation/training/run_facts.h"
#include "compensation/training/selection.h"
#include "compensation/training/sigma_fit.h"
#include "config/option_message.h"
#include "dataset/files/sha256.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;

bool has_network(const ModelSpec& spec) {
  return spec.candidates.empty() && std::holds_alternative<BpSpec>(spec.kind);
}

void check_runs(const ModelSpec& spec, const RunSource& runs,
                const RunSource& held_out,
                const std::optional<Grouping>& cross_validation) {
  if (runs.count == 0)
    throw std::invalid_argument("training needs at least one recording");
  if (has_network(spec) && held_out.count == 0 && !cross_validation)
    throw option_error(
        "a bp network needs held-out recordings to stop early on: pass {}, or "
        "{}",
        NamedOption{"held_out", "RUN.h5"},
        NamedOption{"cross_validation", "run|cycle|leg"});
}

// Returns the files as a compensator keeps them.
std::vector<SourceFile> files_of(const RunFacts& facts) {
  std::vector<SourceFile> files;
  for (const RunMark& run : facts.runs) files.push_back(run.file);
  return files;
}

// Returns the groups of rows for cross-validation, if there is one.
std::optional<RowGroups> groups_of(const ModelSpec& spec,
                                   const TrainingRows& rows,
                                   const TrainingRows& held_out,
                                   const std::optional<Grouping>& wanted) {
  if (wanted) {
    RowGroups groups = group_rows(rows, *wanted);
    if (groups.count < 2)
      throw std::invalid_argument(fmt::format(
          "cross-validation by {0} needs two {0}s or more; the recordings "
          "have {1}",
          grouping_name(*wanted), groups.count));
    return groups;
  }
  if (spec.candidates.empty() || held_out.size() > 0) return std::nullopt;
  return folds_of(rows, kLeastGroups);
}

// What the runs behind a sigma have shown.
SigmaValidity validity_of(const TrainingRows& rows, const TrainingRows& unseen,
                          const RunFacts& facts) {
  SigmaValidity validity{{}, facts.age};
  bool rises = false, falls = false;
  for (const TrainingRows* seen : {&rows, &unseen})
    for (const auto& [begin, end] : stretches_of(seen->leg)) {
      const double change =
          seen->temperature(end - 1) - seen->temperature(begin);
      rises = rises || change >= kLeastWay;
      falls = falls || change <= -kLeastWay;
    }
  if (facts.may_remember && rises != falls)
    validity.only_way =
        rises ? TemperatureWay::kRising : TemperatureWay::kFalling;
  return validity;
}

// Of a device whose population has shown both ways of the temperature.
bool knows_hysteresis(const FitSpec& kind) {
  const auto* adapted = std::get_if<AdaptedSpec>(&kind);
  return adapted != nullptr && adapted->population.hysteresis.size() > 0;
}

double rms_about(double value, const ArrayXd& bias) {
  return std::sqrt((bias - value).square().mean());
}

// Returns the temperatures for which a model holds whatever the rows are.
TemperatureRange known_range(const FitSpec& kind) {
  const auto* adapted = std::get_if<AdaptedSpec>(&kind);
  return adapted != nullptr ? adapted->population.range() : TemperatureRange{};
}

// Removes the channels of a population, which are used for fitting only.
void leave_out_channels(const FitSpec& kind, FittedCompensator& c) {
  if (!std::holds_alternative<PopulationSpec>(kind) &&
      !std::holds_alternative<AdaptedSpec>(kind))
    return;
  c.inputs.resize(1);
  c.bias.input_scales.resize(1);
}

// Rms residuals of the model, the cubic, straight lines and a constant.
void write_scores(const FittedCompensator& c, const TrainingRows& rows,
                  const TrainingRows& held_out, Provenance& p) {
  const auto rms = [](const auto& curve, const TrainingRows& any) {
    return std::sqrt(
        (any.bias - curve.predict(any.temperature)).square().mean());
  };
  p.in_sample_rms = rms_residual(c.bias, rows);
  p.baseline_in_sample_rms = rms(c.baseline, rows);
  if (c.straight_lines) p.lines_in_sample_rms = rms(*c.straight_lines, rows);
  p.constant_bias = rows.bias.mean();
  p.constant_in_sample_rms = rms_about(rows.bias.mean(), rows.bias);
  if (held_out.size() == 0) return;
  p.held_out_rms = rms_residual(c.bias, held_out);
  p.baseline_held_out_rms = rms(c.baseline, held_out);
  if (c.straight_lines) p.lines_held_out_rms = rms(*c.straight_lines, held_out);
  p.constant_held_out_rms = rms_about(rows.bias.mean(), held_out.bias);
}

CrossValidated summary_of(const RowGroups& groups, const Selected& selected) {
  const double rms = rms_of(*selected.errors);
  const auto roots = [](const GroupErrors& errors) {
    const GroupErrors root = errors.sqrt();
    return std::vector<double>(root.begin(), root.end());
  };
  return {grouping_name(groups.by),
          static_cast<std::size_t>(groups.count),
          rms,
          rms > 0.0 ? standard_error(*selected.errors) / (2.0 * rms) : 0.0,
          rms_of(*selected.constant_errors),
          roots(*selected.errors),
          roots(*selected.constant_errors)};
}

// Returns why the model claims no improvement over a constant, or an empty text
// when it may.
std::string why_no_claim(const ModelSpec& spec,
                         const std::optional<RowGroups>& groups,
                         const Selected& selected) {
  if (is_constant(selected.candidate.kind))
    return spec.candidates.empty()
               ? ""
               : fmt::format(
                     "no improvement to claim: no candidate is worth "
                     "more than \"{}\"",
                     selected.candidate.name);
  if (groups && groups->by == Grouping::kSegment)
    return objection_to_claim({}, {});
  return objection_to_claim(selected.errors, selected.constant_errors,
                            selected.weight);
}

// Too few rows show as temperatures or inputs that do not vary.
std::string cause_of_few_rows(const TrainingRows& rows,
                              const RowOptions& options) {
  constexpr Eigen::Index kFew = 10;
  if (rows.size() >= kFew || options.seconds == 0.0) return "";
  return fmt::format(
      "; the recordings give {} rows, means over {:g} s each: expected longer "
      "recordings, or a shorter rows.seconds in the model file",
      rows.size(), options.seconds);
}

// Adds the 1-sigma of the bias, and that of devices adapted from a population.
void fit_sigma(FittedCompensator& c, const SigmaTask& task,
               std::vector<std::string>& remarks) {
  if (c.population)
    c.population->sigma = fit_adaptation_sigma(
        *c.population, c.scale_factor ? &*c.scale_factor : nullptr, task,
        remarks);
  c.sigma = fit_bias_sigma(c, task, c.sigma_not_known);
}

void add_sigma_caution(const BiasSigma& sigma, const TrainingRows& rows,
                       std::vector<std::string>& warnings) {
  if (sigma.source == SigmaSource::kPosterior ||
      rows.cycle.maxCoeff() > rows.cycle.minCoeff())
    return;
  warnings.push_back(fmt::format(
      "the stated sigma leaves out the turn-on offset and the slow noise that "
      "all {}s of this one run share: hold out runs to calibrate it",
      sigma.calibration.by));
}

// Of a gyro that may have hysteresis.
void add_way_caution(const SigmaValidity& validity,
                     std::vector<std::string>& warnings) {
  if (!validity.only_way) return;
  warnings.push_back(fmt::format(
      "sigma is of {} temperatures alone: hysteresis does not show in it; "
      "train or hold out a run that goes the other way, too",
      way_name(*validity.only_way)));
}

}  // namespace

LookupTable fit_scale_factor(const RunSource& runs, double bin_width) {
  struct Bin {
    double temperature = 0.0, raw = 0.0, truth = 0.0;
  };
  std::map<double, Bin> bins;
  runs.for_each([&](const TrainingRun& run) {
    for (const PlateauSlope& slope :
         plateau_slopes(run.recording, kTableRate)) {
      Bin& bin = bins[std::floor(slope.temperature / bin_width)];
      bin.temperature += slope.truth * slope.temperature;
      bin.raw += slope.raw;
      bin.truth += slope.truth;
    }
  });
  if (bins.empty())
    throw std::invalid_argument(fmt::format(
        "a scale-factor table needs recordings whose true rate varies by {} "
        "deg/s at a steady temperature; none of the {} does",
        kTableRate, runs.count));
  LookupTable table{Eigen::ArrayXd(static_cast<Eigen::Index>(bins.size())),
                    Eigen::ArrayXd(static_cast<Eigen::Index>(bins.size()))};
  Eigen::Index k = 0;
  for (const auto& [number, bin] : bins) {
    table.temperatures(k) = bin.temperature / bin.truth;
    table.values(k++) = bin.raw / bin.truth;
  }
  return table;
}

TrainResult train(const ModelSpec& spec, const RunSource& runs,
                  const RunSource& held_out, std::uint64_t seed,
                  std::optional<Grouping> cross_validation) {
  check_runs(spec, runs, held_out, cross_validation);
  TrainResult result;
  FittedCompensator& c = result.compensator;
  if (spec.scale_factor_bin_K)
    c.scale_factor = fit_scale_factor(runs, *spec.scale_factor_bin_K);
  const LookupTable* scale_factor = c.scale_factor ? &*c.scale_factor : nullptr;
  RunFacts facts, unseen_facts;
  const TemperatureRange known = known_range(spec.kind);
  TrainingRows rows = training_rows(noting(runs, facts), spec.inputs, spec.rows,
                                    known, scale_factor);
  if (known != TemperatureRange{}) rows.range = known;
  TrainingRows unseen;
  if (held_out.count > 0)
    unseen = training_rows(noting(held_out, unseen_facts), spec.inputs,
                           spec.rows, rows.range, scale_factor);
  require_different_runs(facts.runs, unseen_facts.runs);
  require_filters(spec.inputs, facts);
  result.rows = rows.size();
  result.held_out_rows = unseen.size();

  const auto groups = groups_of(spec, rows, unseen, cross_validation);
  std::vector<Candidate> candidates = spec.candidates;
  if (candidates.empty())
    candidates.push_back({method_name(spec.kind), spec.inputs, spec.kind});
  Selected selected = [&] {
    try {
      return select_model(candidates,
                          {spec.inputs, rows, unseen, groups, seed});
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(error.what() +
                                  cause_of_few_rows(rows, spec.rows));
    }
  }();

  // After what an input tells more of: one that never varies, say.
  require_bias(rows);

  c.inputs = selected.candidate.inputs;
  c.bias = std::move(selected.fit.model);
  leave_out_channels(selected.candidate.kind, c);
  c.population = std::move(selected.fit.population);
  c.temperature_range = c.population ? c.population->range() : rows.range;
  c.baseline = fit_baseline(rows);
  c.straight_lines = fit_straight_lines(rows);
  result.restarts = std::move(selected.fit.restarts);
  result.chosen = selected.fit.chosen;

  Provenance& p = c.provenance;
  p.method = method_name(selected.candidate.kind);
  if (selected.weight < 1.0)
    p.method +=
        fmt::format(" of weight {:.2f} beside a constant", selected.weight);
  p.training = files_of(facts);
  p.held_out = files_of(unseen_facts);
  p.training_set = runs.set;
  p.held_out_set = held_out.set;
  if (!runs.set && facts.states_devices && facts.devices.size() == 1)
    p.device_sha256 = sha256(*facts.devices.begin());
  p.model_text = spec.text;
  p.seed = seed;
  p.stop_reason = sentence(result.summary().stop_reason);
  p.choices = std::move(selected.fit.choices);
  const TrainingRows own = with_columns(rows, spec.inputs, c.inputs);
  const TrainingRows own_unseen = with_columns(unseen, spec.inputs, c.inputs);
  write_scores(c, own, own_unseen, p);
  if (selected.weight == 1.0) {
    const std::vector<Input>& inputs = selected.candidate.inputs;
    const TrainingRows fitted = with_columns(rows, spec.inputs, inputs);
    const TrainingRows others = with_columns(unseen, spec.inputs, inputs);
    fit_sigma(c,
              {selected.candidate.kind, inputs, spec.rows, fitted, others, runs,
               held_out, seed, groups},
              result.sigma_remarks);
  } else {
    c.sigma_not_known = "the curve is averaged with a constant";
  }
  if (c.sigma) {
    c.sigma->validity = validity_of(rows, unseen, facts);
    if (knows_hysteresis(selected.candidate.kind))
      c.sigma->validity.only_way.reset();
  }
  if (!c.sigma_not_known.empty())
    result.sigma_remarks.push_back("no sigma: " + c.sigma_not_known);
  if (groups) p.cross_validated = summary_of(*groups, selected);
  p.warnings = cautions({c.inputs, c.bias, c.baseline, own, own_unseen,
                         facts.coarsest_resolution, known != TemperatureRange{},
                         facts.age.has_value()});
  p.warnings.insert(p.warnings.end(), selected.fit.warnings.begin(),
                    selected.fit.warnings.end());
  if (c.sigma && held_out.count == 0)
    add_sigma_caution(*c.sigma, own, p.warnings);
  if (c.sigma) add_way_caution(c.sigma->validity, p.warnings);
  for (const std::string& warning :
       {warning_of_shared_seeds(p.training, p.held_out, groups.has_value()),
        warning_of_devices(
            facts, runs.set.has_value() ||
                       std::holds_alternative<PopulationSpec>(spec.kind)),
        why_no_claim(spec, groups, selected)})
    if (!warning.empty()) p.warnings.push_back(warning);
  return result;
}

TrainResult train(const ModelSpec& spec, const std::vector<TrainingRun>& runs,
                  const std::vector<TrainingRun>& held_out, std::uint64_t seed,
                  std::optional<Grouping> cross_validation) {
  return train(spec, source_of(runs), source_of(held_out), seed,
               cross_validation);
}

}  // namespace beamgyro::internal
