// SPDX-License-Identifier: MIT
#include "sim/campaign/drawn_keys.h"

#include <algorithm>
#include <string>
#include <vector>

#include "config/overrides.h"
#include "sim/scenario/scenario_file.h"

namespace beamgyro::internal {
namespace {

// Whether `table` is a part of the path of `key`, or `key` itself.
bool holds(std::string_view table, std::string_view key) {
  return key.starts_with(table) &&
         (key.size() == table.size() || key[table.size()] == '.');
}

const ConfigNode* below(const ConfigNode& node, std::string_view key) {
  const ConfigNode* at = &node;
  while (at != nullptr && !key.empty()) {
    const std::size_t dot = std::min(key.find('.'), key.size());
    at = find_child(*at, key.substr(0, dot));
    key.remove_prefix(std::min(dot + 1, key.size()));
  }
  return at;
}

bool is_same(const ConfigNode* a, const ConfigNode* b) {
  if (a == nullptr || b == nullptr) return a == b;
  return toml_text(*a) == toml_text(*b);
}

bool is_choice(const Draw& draw) {
  return !draw.values.empty() && draw.elements == 0;
}

void add_moving(const ScenarioPlan& scenario, PerAxis<bool>& axes) {
  for (std::size_t i = 0; i < kCaseAxisCount; ++i)
    axes[i] |= moves(scenario.motion[i]);
}

}  // namespace

bool is_drawn(const DrawPlan& plan, const ConfigDocument& document,
              std::string_view key) {
  return std::ranges::any_of(plan.draws, [&](const Draw& draw) {
    const std::string drawn = key_of(draw);
    if (holds(key, drawn)) return true;
    if (!holds(drawn, key)) return false;
    const ConfigNode* in_file = document.value(key);
    return !std::ranges::all_of(draw.values, [&](const ConfigNode& choice) {
      return is_same(below(choice, key.substr(drawn.size() + 1)), in_file);
    });
  });
}

PerAxis<bool> moved_axes(const ScenarioPlan& scenario,
                         const ConfigDocument& document, const DrawPlan& plan,
                         const ProfileTables& profiles) {
  PerAxis<bool> axes{};
  add_moving(scenario, axes);
  for (const Draw& draw : plan.draws) {
    const std::string key = key_of(draw);
    if (!is_choice(draw)) {
      for (std::size_t i = 0; i < kCaseAxisCount; ++i)
        axes[i] |= holds(kCaseAxes[i].key, key) || holds(key, kCaseAxes[i].key);
      continue;
    }
    if (!holds("cross_rate", key) && !holds("acceleration", key)) continue;
    double before = 0;
    for (std::size_t i = 0; i < draw.values.size(); ++i) {
      const bool is_ever_drawn = draw.distribution.cumulative[i] > before;
      before = draw.distribution.cumulative[i];
      if (!is_ever_drawn) continue;
      Overrides choice;
      choice.add(draw.path, draw.values[i], draw.place);
      add_moving(read_scenario(document.with(choice), &profiles), axes);
    }
  }
  return axes;
}

}  // namespace beamgyro::internal
