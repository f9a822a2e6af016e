// SPDX-License-Identifier: MIT
#include "dataset/set/set_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "config/file_error.h"
#include "config/option_message.h"
#include "dataset/files/set_files.h"
#include "dataset/files/sha256.h"
#include "dataset/set/set_view.h"
#include "dataset/set/shard/shard_reader.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

bool is_part(const std::string& name) {
  return name.starts_with("manifest.") && name.ends_with(".jsonl") &&
         name != kManifestName;
}

// Throws std::invalid_argument for what is no directory.
std::vector<std::string> names_in(const fs::path& directory) {
  try {
    return Directory(directory).names();
  } catch (const std::system_error& error) {
    throw_file_error(directory, "cannot read", error.code(),
                     "the directory of a set");
  }
}

bool has_parts(const fs::path& directory) {
  return std::ranges::any_of(names_in(directory), is_part);
}

// Another task may make or remove it while it is looked for.
std::optional<Manifest> manifest_if_there(const fs::path& directory,
                                          const std::string& name) {
  for (int again = 3;; --again) {
    try {
      return read_manifest(directory, name);
    } catch (const std::invalid_argument&) {
      if (!find_in_set(directory, name)) return {};
      if (again == 0) throw;
    }
  }
}

void take(const fs::path& path, const Manifest& manifest,
          std::optional<ManifestHead>& head, SetState& state) {
  if (!manifest.head) return;
  if (head && *head != *manifest.head)
    throw std::invalid_argument(fmt::format(
        "{}: is of another campaign or program than the other manifests there; "
        "expected parts of one set",
        path.string()));
  head = manifest.head;
  for (const ManifestEntry& entry : manifest.entries)
    state.entries.emplace(entry.index, entry);
}

void require_same(const fs::path& directory, const ManifestHead& met,
                  const ManifestHead& head) {
  if (met == head) return;
  if (met.program_version != head.program_version ||
      met.git_revision != head.git_revision)
    throw std::invalid_argument(fmt::format(
        "{}: holds a set of beamgyro {} ({}), and this is {} ({}): another "
        "program may not make the same bytes; expected the same program or "
        "another directory",
        directory.string(), met.program_version, met.git_revision,
        head.program_version, head.git_revision));
  const std::string what =
      fmt::format("{}: holds a set of another campaign ({}, {} devices",
                  directory.string(), met.campaign, met.devices);
  constexpr const char* kExpected =
      "expected the same campaign, with the same scenarios, device and number "
      "of devices, or another directory";
  if (met.devices == head.devices)
    throw std::invalid_argument(fmt::format("{}); {}", what, kExpected));
  throw option_error("{}, here {}; {} sets them); {}", what, head.devices,
                     NamedOption{"devices"}, kExpected);
}

bool holds_files_of_a_set(const fs::path& directory) {
  return std::ranges::any_of(names_in(directory), [](const std::string& name) {
    return name == kManifestName || is_part(name) || name.ends_with(".h5");
  });
}

// A link in place of a file does not count.
bool is_there(const Directory& directory, const ManifestEntry& entry) {
  const std::optional<FileFacts> facts = directory.find(entry.file);
  return facts && facts->is_regular && facts->bytes == entry.bytes;
}

void drop_missing(const fs::path& path, SetState& state) {
  const Directory directory(path);
  std::erase_if(state.entries, [&](const auto& entry) {
    return !is_there(directory, entry.second);
  });
}

std::vector<std::uint32_t> lacking_files(const fs::path& path,
                                         const SetState& state,
                                         const SetTask& task) {
  std::optional<Directory> directory;
  if (!state.entries.empty()) directory.emplace(path);
  std::vector<std::uint32_t> files;
  for (std::uint32_t index = 0; index < state.planned; ++index) {
    if (!task.makes(index)) continue;
    const auto entry = state.entries.find(index);
    if (entry == state.entries.end() || !is_there(*directory, entry->second))
      files.push_back(index);
  }
  return files;
}

// A view of every run, over all files.
std::vector<ManifestView> views_of(const fs::path& directory,
                                   const ManifestHead& head,
                                   const std::vector<ManifestEntry>& entries) {
  std::vector<ManifestView> views;
  for (std::size_t run = 0; run < head.runs.size(); ++run) {
    std::vector<ManifestEntry> of_run;
    for (std::size_t k = run; k < entries.size(); k += head.runs.size())
      of_run.push_back(entries[k]);
    const ShardFile first(directory, of_run.front().file);
    views.push_back(write_view(directory, first.head(), of_run));
  }
  return views;
}

// Returns whether a complete and merged set has the right views.
bool has_right_views(const fs::path& directory) {
  const Manifest manifest = read_manifest(directory, kManifestName);
  return manifest.views.size() == manifest.head.value().runs.size() &&
         check_views(directory, manifest, {}).empty();
}

// Throws std::invalid_argument when it can be no directory. Whether it is new.
bool make_directory(const fs::path& directory) {
  // Other tasks may make it at the same time.
  std::error_code error, ignored;
  if (fs::create_directory(directory, error)) return true;
  if (fs::is_directory(directory, ignored)) return false;
  if (fs::exists(fs::symlink_status(directory, ignored)))
    throw std::invalid_argument(
        fmt::format("{}: is no directory; expected one, or a new name",
                    directory.string()));
  throw_file_error(directory, "cannot make this directory", error,
                   "a place in a directory that is there and writable");
}

}  // namespace

std::uint64_t SetState::device_runs() const {
  std::uint64_t count = 0;
  for (const auto& [index, entry] : entries) count += entry.devices;
  return count;
}

std::uint64_t SetState::failures() const {
  std::uint64_t count = 0;
  for (const auto& [index, entry] : entries) count += entry.failures.size();
  return count;
}

CautionCounts SetState::cautions() const {
  CautionCounts sum;
  for (const auto& [index, entry] : entries) {
    sum.unpowered += entry.cautions.unpowered;
    sum.not_locked += entry.cautions.not_locked;
    sum.saturated += entry.cautions.saturated;
  }
  return sum;
}

std::vector<std::string> caution_texts(const SetState& state) {
  const CautionCounts count = state.cautions();
  std::vector<std::string> texts;
  for (const auto& [runs, what] :
       {std::pair{count.unpowered, "have no power at any time"},
        std::pair{count.not_locked,
                  "are not locked in half of the powered samples or more"},
        std::pair{count.saturated, "have saturated samples"}})
    if (runs > 0)
      texts.push_back(fmt::format("{} of {} device runs {}", runs,
                                  state.device_runs(), what));
  return texts;
}

// Reads the parts first: they are newer, and may be merged while this reads.
bool every_device_failed(const SetState& state) {
  return state.device_runs() > 0 && state.failures() == state.device_runs();
}

std::string every_device_failed_text(const SetState& state) {
  const ManifestEntry& first = state.entries.begin()->second;
  return fmt::format("every one of its {} device runs failed; device {}: {}",
                     state.device_runs(), first.failures.front().device,
                     first.failures.front().reason);
}

std::optional<SetContents> find_set(const fs::path& directory) {
  if (!fs::is_directory(status_of(directory))) return {};
  std::optional<ManifestHead> head;
  SetState state;
  for (const std::string& name : names_in(directory)) {
    if (!is_part(name)) continue;
    if (const auto part = manifest_if_there(directory, name))
      take(directory / name, *part, head, state);
  }
  if (const auto manifest = manifest_if_there(directory, kManifestName)) {
    take(directory / kManifestName, *manifest, head, state);
    state.is_merged = manifest->is_finished;
  }
  if (!head) return {};
  state.planned = file_count(*head);
  return SetContents{*head, std::move(state)};
}

SetContents set_contents(const fs::path& directory) {
  const fs::file_status status = status_of(directory);
  if (!fs::is_directory(status))
    throw std::invalid_argument(fmt::format(
        "{}: {}; expected the directory of a set", directory.string(),
        fs::exists(status) ? "is no directory" : "is not there"));
  std::optional<SetContents> contents = find_set(directory);
  if (!contents)
    throw std::invalid_argument(fmt::format(
        "{}: holds no set that can be read; expected a directory that generate "
        "made",
        directory.string()));
  return *std::move(contents);
}

SetWriter::SetWriter(const fs::path& directory, ManifestHead head,
                     std::span<const SourceText> sources, const SetTask& task,
                     bool resume)
    : directory_(directory),
      manifest_(task.is_whole() ? std::string(kManifestName)
                                : part_name(task.number, task.of)),
      head_(std::move(head)),
      task_(task) {
  const bool is_new = make_directory(directory_);
  try {
    enter(sources, resume);
  } catch (...) {
    lock_.reset();
    std::error_code ignored;
    if (is_new) fs::remove(directory_, ignored);
    throw;
  }
}

SetWriter::~SetWriter() = default;

void SetWriter::enter(std::span<const SourceText> sources, bool resume) {
  lock_.emplace(directory_,
                task_.is_whole()
                    ? std::string()
                    : fmt::format("{}-of-{}", task_.number, task_.of));
  if (task_.is_whole() && !resume && holds_files_of_a_set(directory_))
    throw option_error(
        "{}: holds a set, or other .h5 files; expected {} to go on with a set, "
        "or another directory",
        directory_.string(), NamedOption{"resume"});
  const std::optional<SetContents> contents = find_set(directory_);
  if (contents) {
    require_same(directory_, contents->head, head_);
    before_ = contents->state;
  }
  before_.planned = file_count(head_);
  remove_unfinished_files(directory_,
                          task_.is_whole() && lock_->is_held_by_kernel());
  copy_sources(directory_, sources);
  const std::optional<Manifest> copy =
      manifest_if_there(directory_, kHeadCopyName);
  if (!copy || copy->head != head_ || !copy->damaged_lines.empty())
    start_manifest(directory_, kHeadCopyName, head_);
  if (lacking().empty() && contents) return;
  // A merged manifest would claim that every file is there, which is wrong now.
  if (task_.is_whole() && before_.is_merged) {
    drop_missing(directory_, before_);
    std::vector<ManifestEntry> kept;
    for (const auto& [index, entry] : before_.entries) kept.push_back(entry);
    start_manifest(directory_, manifest_, head_, kept);
  }
  // Lines after a first one that is lost would not count, and a file that has
  // two names may not be written to.
  const std::optional<Manifest> own = manifest_if_there(directory_, manifest_);
  if (!own || !own->head || find_in_set(directory_, manifest_)->names > 1)
    start_manifest(directory_, manifest_, head_,
                   own ? own->entries : std::vector<ManifestEntry>());
}

std::vector<std::uint32_t> SetWriter::lacking() const {
  return lacking_files(directory_, before_, task_);
}

void SetWriter::add(std::uint32_t index, std::span<const std::byte> bytes,
                    const std::vector<DeviceFailure>& failures,
                    const CautionCounts& cautions) {
  ManifestEntry entry = expected_entry(head_, index);
  entry.bytes = bytes.size();
  entry.sha256 = sha256(bytes);
  entry.failures = failures;
  entry.cautions = cautions;
  publish_file(directory_, entry.file, bytes);
  const std::lock_guard lock(mutex_);
  // Tasks of another division may have merged and removed it.
  if (!find_in_set(directory_, manifest_))
    start_manifest(directory_, manifest_, head_);
  append_entry(directory_, manifest_, entry);
}

void SetWriter::merge(const SetState& state) {
  Manifest merged;
  merged.head = head_;
  for (const auto& [index, entry] : state.entries)
    merged.entries.push_back(entry);
  merged.views = views_of(directory_, head_, merged.entries);
  write_manifest(directory_, kManifestName, merged);
  for (const std::string& name : names_in(directory_)) {
    std::error_code ignored;
    if (is_part(name)) fs::remove(directory_ / name, ignored);
  }
}

SetState SetWriter::finish(bool anew) {
  SetState state = set_contents(directory_).state;
  drop_missing(directory_, state);
  if (state.is_whole() && (anew || !state.is_merged || has_parts(directory_) ||
                           !has_right_views(directory_)))
    merge(state);
  state.is_merged = state.is_whole();
  return state;
}

std::string lacking_tasks(const fs::path& directory, const ManifestHead& head,
                          std::uint32_t of) {
  const std::optional<SetContents> contents = find_set(directory);
  SetState state;
  if (contents) {
    require_same(directory, contents->head, head);
    state = contents->state;
  }
  state.planned = file_count(head);
  // Tasks beyond the number of files have nothing to make.
  const std::uint32_t tasks = std::min(of, state.planned);
  std::vector<bool> lacks(tasks, false);
  for (const std::uint32_t index : lacking_files(directory, state, {}))
    lacks[index % of] = true;
  std::string text;
  for (std::uint32_t first = 0; first < tasks; ++first) {
    if (!lacks[first]) continue;
    std::uint32_t last = first;
    while (last + 1 < tasks && lacks[last + 1]) ++last;
    if (!text.empty()) text += ',';
    text += first == last ? fmt::format("{}", first + 1)
                          : fmt::format("{}-{}", first + 1, last + 1);
    first = last;
  }
  return text;
}

}  // namespace beamgyro::internal
