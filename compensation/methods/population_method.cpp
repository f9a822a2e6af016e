// SPDX-License-Identifier: MIT
#include "compensation/methods/population_method.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "compensation/methods/bias_model.h"
#include "compensation/methods/method_inputs.h"
#include "compensation/methods/population.h"
#include "compensation/methods/population_membership.h"
#include "compensation/methods/population_own.h"
#include "compensation/methods/soak_rows.h"
#include "dataset/files/sha256.h"

namespace beamgyro::internal {
namespace {

// The temperature and the population's channels, or some of them.
std::vector<Input> adapted_inputs(const ConfigTable& root,
                                  const Population& population) {
  std::vector<Input> all = {parse_input("temperature")};
  all.insert(all.end(), population.channels.begin(), population.channels.end());
  if (!root.has("inputs")) return all;
  const std::vector<Input> inputs = read_inputs(root);
  check_inputs(root, inputs, InputRule::kChannels, AdaptedSpec::kName);
  for (const Input& input : inputs)
    if (std::find(all.begin(), all.end(), input) == all.end())
      root.fail("inputs", fmt::format("\"{}\"; the population knows {}",
                                      input_name(input),
                                      fmt::join(input_names(all), ", ")));
  return inputs;
}

std::string own_text(const Population& p) {
  std::string text;
  for (std::size_t k = 0; k < p.own.size(); ++k)
    text += fmt::format("{}{} {:.3g} over {:g} K", k == 0 ? "" : ", ",
                        k == 0 ? "bias" : input_name(p.channels[k - 1]),
                        p.own[k].deviation, p.own[k].length_K);
  return text.empty() ? "devices have nothing of their own that shows"
                      : "devices have of their own, 1-sigma: " + text;
}

std::string membership_text(const std::optional<Membership>& m) {
  if (!m)
    return "not compared with its population, which knows too few devices";
  return fmt::format(
      "compared with its population: chi-squared {:.4g} of {} values, of {:g} "
      "% of the population's own devices up to {:.4g}",
      m->distance, m->values, 100.0 * kOwnShare, m->threshold);
}

std::string foreign_warning(const Membership& m) {
  return fmt::format(
      "this gyro is foreign to its population: chi-squared {:.4g} of {} "
      "values, where {:g} % of the population's own devices stay below {:.4g}; "
      "what the population promises, sigma among it, does not hold for it",
      m.distance, m.values, 100.0 * kOwnShare, m.threshold);
}

}  // namespace

PopulationSpec PopulationSpec::read(MethodSource& source) {
  const ConfigTable table = source.table(kName);
  PopulationSpec spec;
  spec.grid_K = table.number_or("grid_K", spec.grid_K, positive());
  if (table.has("point_noise_deg_per_s"))
    spec.point_noise = table.number("point_noise_deg_per_s", positive());
  return spec;
}

Fit PopulationSpec::fit(const FitTask& task) const {
  Population p = fit_population(task.inputs, task.rows, grid_K);
  p.point_noise = point_noise.value_or(usual_point_noise(p));
  p.run_noise = point_noise.value_or(usual_run_noise(p));
  p.own = learned_own_parts(p);
  Fit fit =
      model_of(unscaled(task), bias_curve(p, p.mean.head(p.grid()).array()));
  fit.choices.push_back(
      fmt::format("{} devices, {} modes on {} temperatures from {:.2f} to "
                  "{:.2f} degC",
                  p.devices, p.modes.cols(), p.grid(), p.range().lowest,
                  p.range().highest));
  fit.choices.push_back(own_text(p));
  fit.population = std::move(p);
  return fit;
}

AdaptedSpec AdaptedSpec::read(MethodSource& source) {
  const ConfigTable root = source.root();
  const ConfigTable table = source.table(kName);
  AdaptedSpec spec;
  const double given = table.number_or("noise_deg_per_s", 0.0, positive());
  spec.noise.channel_share = table.number_or(
      "channel_noise_share", spec.noise.channel_share, positive());
  const std::string name = root.text("population");
  const std::filesystem::path file =
      source.document.path().parent_path() / name;
  try {
    spec.population = source.read_population(file);
  } catch (const std::invalid_argument& error) {
    root.fail("population", error.what());
  }
  const ConfigTable row_options = root.table_or_empty("rows");
  if (row_options.has("steady_K_per_min"))
    spec.steady_K_per_min = row_options.number("steady_K_per_min");
  spec.noise.bias = given > 0.0 ? given : spec.population.point_noise;
  spec.noise.run = given > 0.0 ? given : spec.population.run_noise;
  spec.source =
      fmt::format("{}, {} devices, sha256 {}", file.filename().string(),
                  spec.population.devices, sha256_of_file(file));
  source.files.push_back(file);
  source.inputs = adapted_inputs(root, spec.population);
  return spec;
}

TrainingRows AdaptedSpec::used_rows(const TrainingRows& rows) const {
  return steady_K_per_min ? rows_of_soaks(rows, *steady_K_per_min) : rows;
}

Fit AdaptedSpec::fit(const FitTask& task) const {
  const TrainingRows rows = used_rows(task.rows);
  const AdaptedBias adapted =
      adapted_bias(population, task.inputs, rows, noise);
  const BiasSigma sigma =
      adapted_sigma(population, adapted.deviation, noise.run);
  Eigen::Index worst = 0;
  const double largest = sigma.factor * sigma.curve.values.maxCoeff(&worst);
  Fit fit = model_of(unscaled(task), bias_curve(population, adapted.mean));
  const auto compared = membership(population, task.inputs, rows, noise);
  fit.choices = {
      fmt::format("population: {}", source),
      fmt::format(
          "1-sigma left open by the rows: rms {:.4f} deg/s, largest {:.4f} "
          "deg/s at {:.1f} degC",
          sigma.factor * std::sqrt(sigma.curve.values.square().mean()), largest,
          population.temperatures(worst)),
      membership_text(compared)};
  if (rows.size() < task.rows.size())
    fit.choices.push_back(
        fmt::format("{} of {} rows are of ramps, which are no faster than "
                    "steady_K_per_min, and are left out",
                    task.rows.size() - rows.size(), task.rows.size()));
  if (compared && compared->is_foreign())
    fit.warnings.push_back(foreign_warning(*compared));
  return fit;
}

}  // namespace beamgyro::internal
