// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "config/document.h"
#include "sim/campaign/draw_plan.h"

namespace beamgyro::internal {

/// The file whose keys are drawn, and how it is read: `read` throws
/// std::invalid_argument for a document with a value that is not allowed.
struct DrawnFile {
  const ConfigDocument& document;
  std::function<void(const ConfigDocument&)> read;
};

/// Reads the distribution `key` of `table` as that of the dotted key `target`
/// and checks every choice, or the median, in the drawn file. Throws
/// std::invalid_argument naming file, line, key and value.
Draw read_draw(const ConfigTable& table, const std::string& key,
               const std::string& target, const DrawnFile& file);

/// Adds a draw and its parameters. `run` is the name of the run, empty for the
/// device. `taken` has the streams of the campaign so far. Throws
/// std::invalid_argument when a name or a stream is used already, or when one
/// key contains another.
void add_draw(const Draw& draw, const std::string& run, DrawPlan& plan,
              std::set<std::uint32_t>& taken);

/// Checks the file with the median of every number. Throws
/// std::invalid_argument for what the file rejects.
void check_medians(const DrawPlan& plan, const DrawnFile& file);

/// Reads the [[correlated]] groups, whose keys are scalar keys of the plan.
std::vector<CorrelatedGroup> read_correlated(
    const std::vector<ConfigTable>& tables, const DrawPlan& plan);

}  // namespace beamgyro::internal
