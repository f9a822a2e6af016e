// SPDX-License-Identifier: MIT
#include "sim/scenario/scenario.h"

#include <algorithm>
#include <cmath>

namespace beamgyro::internal {

std::string_view fidelity_name(Fidelity fidelity) {
  switch (fidelity) {
    case Fidelity::kQuasistatic:
      return "quasistatic";
    case Fidelity::kEnvelope:
      return "envelope";
    case Fidelity::kCarrier:
      return "carrier";
  }
  return "";
}

std::string title_of(const ScenarioPlan& scenario) {
  constexpr std::size_t kLongest = 1000;  // characters
  std::string title = scenario.name;
  if (!scenario.description.empty() && scenario.description.size() <= kLongest)
    title += ": " + scenario.description;
  title.resize(std::min(title.find('\0'), title.size()));
  return title;
}

std::size_t sample_count(const ScenarioPlan& scenario) {
  // 0.3 s x 10 Hz is three samples, whatever the last bit of the product says.
  constexpr double kRoundoff = 1e-9;
  const double count = scenario.duration * scenario.output_rate;
  return static_cast<std::size_t>(std::floor(count * (1 + kRoundoff)));
}

SampleGrid sample_grid(const ScenarioPlan& scenario) {
  return {scenario.output_rate, sample_count(scenario)};
}

std::vector<double> sample_times(const ScenarioPlan& scenario) {
  return sample_grid(scenario).times(0, sample_count(scenario));
}

double highest_output_rate(Fidelity fidelity) {
  switch (fidelity) {
    case Fidelity::kQuasistatic:
      return 200;
    case Fidelity::kEnvelope:
      return 2000;
    case Fidelity::kCarrier:
      return 1e5;  // a quarter of the drive frequency, which the run checks
  }
  return 0;
}

}  // namespace beamgyro::internal
