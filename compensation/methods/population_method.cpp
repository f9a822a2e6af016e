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

}  // namespace

PopulationSpec PopulationSpec::read(MethodSource& source) {
  return {source.table(kName).number_or("grid_K", 5.0, positive())};
}

Fit PopulationSpec::fit(const FitTask& task) const {
  Population p = fit_population(task.inputs, task.rows, grid_K);
  Fit fit =
      model_of(unscaled(task), bias_curve(p, p.mean.head(p.grid()).array()));
  fit.choices.push_back(
      fmt::format("{} devices, {} modes on {} temperatures from {:.2f} to "
                  "{:.2f} degC",
                  p.devices, p.modes.cols(), p.grid(), p.range().lowest,
                  p.range().highest));
  fit.population = std::move(p);
  return fit;
}

AdaptedSpec AdaptedSpec::read(MethodSource& source) {
  const ConfigTable root = source.root();
  const ConfigTable table = source.table(kName);
  AdaptedSpec spec;
  spec.noise.bias =
      table.number_or("noise_deg_per_s", spec.noise.bias, positive());
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
  spec.source =
      fmt::format("{}, {} devices, sha256 {}", file.filename().string(),
                  spec.population.devices, sha256_of_file(file));
  source.files.push_back(file);
  source.inputs = adapted_inputs(root, spec.population);
  return spec;
}

Fit AdaptedSpec::fit(const FitTask& task) const {
  const AdaptedBias adapted =
      adapted_bias(population, task.inputs, task.rows, noise);
  const BiasSigma sigma = adapted_sigma(population, adapted.deviation, noise);
  Eigen::Index worst = 0;
  const double largest = sigma.factor * sigma.curve.values.maxCoeff(&worst);
  Fit fit = model_of(unscaled(task), bias_curve(population, adapted.mean));
  fit.choices = {
      fmt::format("population: {}", source),
      fmt::format(
          "1-sigma left open by the rows: rms {:.4f} deg/s, largest {:.4f} "
          "deg/s at {:.1f} degC",
          sigma.factor * std::sqrt(sigma.curve.values.square().mean()), largest,
          population.temperatures(worst))};
  return fit;
}

}  // namespace beamgyro::internal
