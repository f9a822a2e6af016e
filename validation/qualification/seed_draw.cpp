// SPDX-License-Identifier: MIT
#include "validation/qualification/seed_draw.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "random/random_stream.h"
#include "sim/scenario/scenario_file.h"

namespace beamgyro::internal {
namespace {

// Below 2^53, so that every reader of JSON has it whole.
long drawn_seed(std::uint64_t seed, std::uint32_t run, RandomPurpose purpose) {
  return static_cast<long>(RandomStream(seed, 0, run, purpose).next_word() >>
                           11);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

ConfigNode whole_number_node(long number) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::kInteger;
  node.integer = number;
  return node;
}

void draw_run(const ProfileTables& profiles, std::uint64_t seed,
              QualificationRun& run) {
  const DrawnValues drawn = drawn_values(run.vary, {seed, {}}, 0);
  Overrides overrides;
  for (std::size_t k = 0; k < drawn.values.size(); ++k)
    overrides.add(run.vary.draws[k].path, drawn.values[k],
                  run.vary.draws[k].place);
  overrides.add({"seed"},
                whole_number_node(drawn_seed(seed, stream_number(run.name),
                                             kQualifiedRunSeedStream)));
  run.scenario = read_scenario(run.document->with(overrides), &profiles);
  if (run.from >= run.scenario.duration)
    throw std::invalid_argument(fmt::format(
        "run \"{}\": the seed {} draws duration_s = {:g}, which is not after "
        "from_s = {:g}; expected a longer one among the values of vary",
        run.name, seed, run.scenario.duration, run.from));
  run.overrides_text = fmt::format(
      "{}\n", fmt::join(merged_overrides(lines_of(run.overrides_text),
                                         lines_of(overrides.text())),
                        "\n"));
}

void draw_order(std::uint64_t seed, std::vector<QualificationRun>& runs) {
  RandomStream stream(seed, 0, 0, kQualifiedRunOrderStream);
  for (std::size_t k = runs.size(); k > 1; --k)
    std::swap(runs[k - 1], runs[static_cast<std::size_t>(
                               static_cast<double>(k) * stream.uniform())]);
}

}  // namespace

Qualification drawn_qualification(const Qualification& stated,
                                  std::uint64_t seed) {
  Qualification drawn = stated;
  for (auto* runs :
       {&drawn.runs, &drawn.training, &drawn.held_out, &drawn.turning})
    for (QualificationRun& run : *runs) draw_run(stated.profiles, seed, run);
  draw_order(seed, drawn.runs);
  return drawn;
}

std::uint64_t drawn_campaign_seed(std::uint64_t seed) {
  return static_cast<std::uint64_t>(
      drawn_seed(seed, 0, kQualifiedCampaignStream));
}

}  // namespace beamgyro::internal
