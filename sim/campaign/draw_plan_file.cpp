// SPDX-License-Identifier: MIT
#include "sim/campaign/draw_plan_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

#include "config/config_node.h"
#include "config/suggestion.h"
#include "config/table.h"
#include "sim/campaign/distribution_file.h"

namespace beamgyro::internal {
namespace {

[[noreturn]] void reject(const std::string& place, const std::string& message) {
  throw std::invalid_argument(fmt::format("{}: {}", place, message));
}

std::vector<std::string> split(const std::string& key) {
  std::vector<std::string> path(1);
  for (const char c : key) {
    if (c == '.') {
      path.emplace_back();
    } else {
      path.back() += c;
    }
  }
  return path;
}

bool is_number(const ConfigNode& node) {
  return node.kind == ConfigNode::Kind::kInteger ||
         node.kind == ConfigNode::Kind::kFloat;
}

bool all_numbers(const std::vector<ConfigNode>& nodes) {
  return std::all_of(nodes.begin(), nodes.end(), is_number);
}

// Reads the file with one override, which must be used.
void check_value(const Draw& draw, const ConfigNode& value,
                 const DrawnFile& file) {
  Overrides overrides;
  overrides.add(draw.path, value, draw.place);
  const ConfigDocument changed = file.document.with(overrides);
  file.read(changed);
  if (overrides.all_used()) return;
  const std::string key = key_of(draw);
  const std::string name = file.document.path().string();
  const std::vector<std::string> known = overrides.known_keys();
  if (std::find(known.begin(), known.end(), key) != known.end()) {
    reject(draw.place, fmt::format("{}: not used together with the other keys "
                                   "of {}",
                                   key, name));
  }
  std::string near = suggestion(key, known);
  for (const std::string& other : known) {
    if (near.empty() && split(other).back() == draw.path.back()) near = other;
  }
  reject(draw.place,
         fmt::format("{}: {} takes no such key{}", printable(key), name,
                     near.empty() ? "; [tolerances] draws keys of the device, "
                                    "`vary` of a [[run]] those of its scenario"
                                  : fmt::format("; did you mean '{}'?", near)));
}

void check_values(const Draw& draw, const DrawnFile& file) {
  std::vector<double> ignored;
  const std::vector<double> middle(draw.numbers(), 0.5);
  Draw one = draw;
  const std::size_t choices = std::max<std::size_t>(draw.values.size(), 1);
  for (std::size_t i = 0; i < choices; ++i) {
    if (!draw.values.empty()) {
      one.values = {draw.values[i]};
      one.distribution.cumulative = {1};
    }
    check_value(draw, drawn_value(one, middle.data(), ignored), file);
  }
}

DeviceVariable parameter(const Draw& draw, const std::string& run,
                         std::size_t element) {
  const std::string key = draw.modes ? number_key(draw, element) : key_of(draw);
  DeviceVariable result{key, draw.numeric ? units_of(key) : units_of(""),
                        fmt::format("drawn {}", key)};
  std::replace(result.name.begin(), result.name.end(), '.', '_');
  std::replace(result.name.begin(), result.name.end(), '-', '_');
  if (draw.elements > 0 && !draw.modes) {
    result.name += fmt::format("_{}", element);
    result.long_name += fmt::format("[{}]", element);
  }
  if (!run.empty()) result.long_name += fmt::format(" of the run {}", run);
  if (!draw.numeric) {
    result.name += "_choice";  // `rate` itself is a signal
    std::vector<std::string> choices;
    for (const ConfigNode& value : draw.values)
      choices.push_back(toml_text(value));
    result.long_name +=
        fmt::format(", index from 0 among: {}", fmt::join(choices, " | "));
  }
  return result;
}

bool begins_with(const std::vector<std::string>& path,
                 const std::vector<std::string>& start) {
  return start.size() <= path.size() &&
         std::equal(start.begin(), start.end(), path.begin());
}

std::size_t member(const ConfigTable& table, const std::string& key,
                   const DrawPlan& plan) {
  std::size_t number = 0;
  std::vector<std::string> scalars;
  for (const Draw& draw : plan.draws) {
    if (draw.elements == 0) scalars.push_back(key_of(draw));
    if (key_of(draw) != key) {
      number += draw.numbers();
      continue;
    }
    if (draw.elements > 0)
      table.fail("keys", fmt::format("'{}' is an array; expected keys of one "
                                     "number",
                                     key));
    return number;
  }
  const std::string near = suggestion(key, scalars);
  table.fail(
      "keys",
      fmt::format("'{}' has no tolerance; {}", printable(key),
                  near.empty() ? "expected keys of [tolerances]"
                               : fmt::format("did you mean '{}'?", near)));
}

Eigen::MatrixXd read_matrix(const ConfigTable& table, std::size_t size) {
  const auto n = static_cast<Eigen::Index>(size);
  if (!table.has("matrix")) {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Constant(
        n, n, table.number("correlation", {-1, 1, true, true}));
    matrix.diagonal().setOnes();
    return matrix;
  }
  const std::vector<std::vector<double>> rows = table.rows("matrix", size);
  if (rows.size() != size) {
    table.fail("matrix", fmt::format("{} rows for {} keys; expected one row "
                                     "for each key",
                                     rows.size(), size));
  }
  Eigen::MatrixXd matrix(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      matrix(i, j) =
          rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }
  return matrix;
}

}  // namespace

Draw read_draw(const ConfigTable& table, const std::string& key,
               const std::string& target, const DrawnFile& file) {
  Draw draw;
  draw.path = split(target);
  draw.place = table.position(key);
  FileDistribution read = read_distribution(table, key);
  draw.distribution = std::move(read.distribution);
  draw.values = std::move(read.values);
  draw.numeric = all_numbers(draw.values);
  const ConfigNode* in_file = file.document.value(target);
  if (draw.numeric && in_file != nullptr &&
      in_file->kind == ConfigNode::Kind::kArray) {
    draw.elements = in_file->children.size();
  }
  check_values(draw, file);
  return draw;
}

void add_draw(const Draw& draw, const std::string& run, DrawPlan& plan,
              std::set<std::uint32_t>& taken) {
  const std::string key = key_of(draw);
  for (const Draw& other : plan.draws) {
    if (begins_with(draw.path, other.path) ||
        begins_with(other.path, draw.path)) {
      reject(draw.place,
             fmt::format("{}: '{}' is drawn already, by {}; expected each key "
                         "once and no key inside another",
                         key, key_of(other), other.place));
    }
  }
  for (std::size_t i = 0; i < draw.numbers(); ++i) {
    DeviceVariable next = parameter(draw, run, i);
    for (const DeviceVariable& other : plan.parameters) {
      if (other.name == next.name) {
        reject(draw.place, fmt::format("{}: two numbers are called {}; draw "
                                       "one of them",
                                       key, next.name));
      }
    }
    const std::uint32_t stream =
        stream_number(fmt::format("{}/{}", run, number_key(draw, i)));
    if (!taken.insert(stream).second) {
      reject(draw.place,
             fmt::format("{}: shares the random stream of another name of this "
                         "campaign; rename the run or leave one of them out",
                         key));
    }
    plan.parameters.push_back(std::move(next));
    plan.streams.push_back(stream);
  }
  plan.draws.push_back(draw);
}

void check_medians(const DrawPlan& plan, const DrawnFile& file) {
  Overrides overrides;
  std::vector<double> ignored;
  for (const Draw& draw : plan.draws) {
    const std::vector<double> middle(draw.numbers(), 0.5);
    overrides.add(draw.path, drawn_value(draw, middle.data(), ignored),
                  draw.place);
  }
  file.read(file.document.with(overrides));
}

std::vector<CorrelatedGroup> read_correlated(
    const std::vector<ConfigTable>& tables, const DrawPlan& plan) {
  std::vector<CorrelatedGroup> groups;
  std::set<std::size_t> grouped;
  for (const ConfigTable& table : tables) {
    CorrelatedGroup group;
    const std::vector<std::string> keys = table.texts("keys");
    if (keys.size() < 2)
      table.fail("keys", "expected the names of two tolerances or more");
    for (const std::string& key : keys) {
      group.members.push_back(member(table, key, plan));
      if (!grouped.insert(group.members.back()).second) {
        table.fail("keys", fmt::format("'{}' is correlated already; expected "
                                       "each key in one group",
                                       key));
      }
    }
    try {
      group.factor = correlation_factor(read_matrix(table, keys.size()));
    } catch (const std::invalid_argument& error) {
      const char* key = table.has("matrix") ? "matrix" : "correlation";
      const std::string message = error.what();
      // What the file's own check says names its place already.
      if (message.starts_with("not ")) table.fail(key, message);
      throw;
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace beamgyro::internal
