// SPDX-License-Identifier: MIT
#include "report/set_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "config/option_message.h"
#include "dataset/set/set_writer.h"
#include "dataset/set/shard/shard_reader.h"
#include "sim/campaign/campaign.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

std::string_view storage_name(Storage storage) {
  switch (storage) {
    case Storage::kFloat64:
      return "float64";
    case Storage::kFloat32:
      return "float32";
    case Storage::kInt16:
      return "int16";
    case Storage::kInt32:
      return "int32";
  }
  return "";
}

std::string described(const ShardHead& head) {
  std::string text;
  auto out = std::back_inserter(text);
  const std::size_t step = head.time.size() > 1 ? 1 : 0;
  const double rate = step == 0 ? 0 : 1 / (head.time[1] - head.time[0]);
  fmt::format_to(out, "run {}: fidelity {}, {} samples, {:.6g} Hz\n", head.run,
                 head.fidelity, head.time.size(), rate);
  fmt::format_to(out, "{:<26} {:<10} {:<12} {:<8} {:>8}\n", "variable", "units",
                 "role", "stored", "Hz");
  for (const SetVariable& variable : head.variables) {
    const auto slower = static_cast<double>(variable.slow ? head.slow_step : 1);
    fmt::format_to(out, "{:<26} {:<10} {:<12} {:<8} {:>8.4g}\n", variable.name,
                   variable.units, role_name(variable.role),
                   storage_name(variable.storage), rate / slower);
  }
  return text;
}

std::string drawn(const ShardHead& head) {
  std::string text;
  for (const DeviceVariable& parameter : head.parameters)
    fmt::format_to(std::back_inserter(text), "{:<44} {}\n", parameter.name,
                   parameter.units);
  return text;
}

fs::path directory_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// Returns the entry of a file in the manifest of its directory, if there is
/// one.
std::optional<ManifestEntry> entry_of(const fs::path& path) {
  const std::optional<SetContents> set = find_set(directory_of(path));
  if (!set) return {};
  for (const auto& [index, entry] : set->state.entries)
    if (entry.file == path.filename().string()) return entry;
  return {};
}

std::string failures_of(const SetState& state) {
  constexpr int kMost = 5;
  std::string text;
  int listed = 0;
  for (const auto& [index, entry] : state.entries) {
    for (const DeviceFailure& failure : entry.failures) {
      if (listed++ == kMost) return text + "...\n";
      fmt::format_to(std::back_inserter(text), "device {} in {}: {}\n",
                     failure.device, entry.file, failure.reason);
    }
  }
  return text;
}

}  // namespace

std::optional<std::string> info_on_shard(const fs::path& path,
                                         std::vector<std::string>& warnings) {
  const std::optional<ManifestEntry> entry = entry_of(path);
  if (!entry && !is_shard_file(path)) return {};
  if (!entry)
    warnings.push_back(fmt::format(
        "{}: is in no set whose manifest tells its bytes: damage in it would "
        "not be noticed",
        path.string()));
  const ShardFile file =
      entry ? ShardFile(path, open_listed(directory_of(path), *entry))
            : ShardFile(path);
  const ShardHead& head = file.head();
  std::string text =
      fmt::format("{}: file of a set, devices {} to {}\n", path.string(),
                  head.first_device, head.first_device + head.devices - 1);
  auto out = std::back_inserter(text);
  fmt::format_to(out, "seed {}, made by beamgyro {} ({})\n", head.seed,
                 head.program_version, head.git_revision);
  for (std::uint32_t i = 0; i < head.devices; ++i) {
    const DeviceRow& row = file.row(i);
    if (!row.failure.empty())
      fmt::format_to(out, "device {} failed: {}\n", head.first_device + i,
                     row.failure);
  }
  fmt::format_to(out, "\n{}\ndrawn for every device\n{}", described(head),
                 drawn(head));
  return text;
}

std::string info_on_set(const fs::path& path) {
  const SetContents set = set_contents(path);
  const SetState& state = set.state;
  double bytes = 0;
  for (const auto& [index, entry] : state.entries)
    bytes += static_cast<double>(entry.bytes);
  std::string text = fmt::format(
      "{}: set of {} devices, {}, campaign {}\n{} of {} files, {:.4g} MB, {} "
      "device runs, {} failed\nseed {}, made by beamgyro {} ({})\n{}",
      path.string(), set.head.devices,
      !state.is_merged             ? "not whole or not merged"
      : every_device_failed(state) ? "without values"
                                   : "whole",
      set.head.campaign, state.entries.size(), state.planned, bytes / 1e6,
      state.device_runs(), state.failures(), set.head.seed,
      set.head.program_version, set.head.git_revision, failures_of(state));
  for (const std::string& caution : caution_texts(state))
    text += caution + "\n";
  std::string parameters;
  const std::size_t runs = set.head.runs.size();
  for (std::size_t run = 0; run < runs; ++run) {
    const auto first = std::ranges::find_if(
        state.entries,
        [&](const auto& entry) { return entry.first % runs == run; });
    if (first == state.entries.end()) continue;
    const ShardFile file(path / first->second.file,
                         open_listed(path, first->second));
    text += "\n" + described(file.head());
    parameters = drawn(file.head());
  }
  return text + "\ndrawn for every device\n" + parameters;
}

std::string info_on_device(const fs::path& path, std::uint32_t device) {
  const ManifestHead head = set_contents(path).head;
  if (device >= head.devices)
    throw option_error("{}: {} has devices 0 to {}",
                       NamedOption{"device", std::to_string(device)},
                       path.string(), head.devices - 1);
  const CampaignPlan campaign =
      CampaignPlan::of_copies(read_copies(path, head), head.devices);
  const VirtualDevice drawn = campaign.device(device);
  std::string text = fmt::format("device {}, drawn of {}\n{}", device,
                                 head.campaign, drawn.overrides);
  if (!drawn.failure.empty())
    fmt::format_to(std::back_inserter(text), "failed: {}\n", drawn.failure);
  for (std::size_t run = 0; run < campaign.runs.size(); ++run)
    fmt::format_to(std::back_inserter(text), "\nrun {}\n{}",
                   campaign.runs[run].name,
                   campaign.run(run, device).overrides);
  return text;
}

}  // namespace beamgyro::internal
