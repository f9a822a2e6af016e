// SPDX-License-Identifier: MIT
#include "validation/external/compensator_source.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>
#include <utility>

#include "compensation/compensator/compensator_file.h"
#include "config/option_message.h"
#include "dataset/files/text_file.h"
#include "validation/external/answering.h"
#include "validation/external/command_compensator.h"
#include "validation/external/library_compensator.h"

namespace beamgyro::internal {
namespace {

constexpr std::string_view kCommandPrefix = "cmd:";
constexpr std::string_view kElf =
    "\x7f"
    "ELF";
constexpr std::size_t kEnoughToTell = 65536;  // bytes

std::string first_bytes(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) return "";
  std::ifstream file(path, std::ios::binary);
  std::string bytes(kEnoughToTell, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

// Whether a line begins with the key `kind`.
bool has_kind(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (!line.starts_with("kind")) continue;
    line.remove_prefix(4);
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (line.starts_with('=')) return true;
  }
  return false;
}

std::string without_folder(const std::string& argument) {
  return std::filesystem::path(argument).filename().string();
}

CompensatorSource source_of_code(SourceKind kind, const std::string& argument,
                                 const ProcessLimits& limits) {
  CompensatorSource source{kind, argument, argument};
  source.limits = limits;
  if (kind == SourceKind::kCommand) {
    source.isolation = isolation_of_command(argument, limits);
    source.tested = open_command(argument, limits, *source.isolation);
    return source;
  }
  source.name = without_folder(argument);
  source.isolation = isolation_of_library(argument, limits);
  source.tested = open_library(argument, limits, *source.isolation);
  source.files.push_back({argument, read_text_file(argument)});
  return source;
}

class FileCompensator : public TestedCompensator {
 public:
  explicit FileCompensator(FittedCompensator compensator)
      : compensator_(std::move(compensator)) {}

  std::vector<std::string> inputs() const override {
    std::set<std::string> names = {"rate", "temperature"};
    for (const Input& input : compensator_.inputs)
      if (!input.column.empty()) names.insert(input.column);
    return {names.begin(), names.end()};
  }

  const Provenance* provenance() const override {
    return &compensator_.provenance;
  }

  std::vector<Answer> answers(
      const std::vector<const Recording*>& runs) const override {
    std::vector<Answer> all;
    for (const Recording* run : runs) {
      const Stopwatch watch;
      Answer& answer = all.emplace_back();
      answer.rate = compensated_rate(compensator_, *run);
      answer.sigma = compensated_rate_sigma(compensator_, *run);
      answer.seconds = watch.seconds();
      answer.clamped = clamped_samples(compensator_, *run);
      add_fault_of_values(*run, answer);
      add_fault_of_speed(*run, answer);
    }
    return all;
  }

 private:
  FittedCompensator compensator_;
};

}  // namespace

std::unique_ptr<TestedCompensator> tested(FittedCompensator compensator) {
  return std::make_unique<FileCompensator>(std::move(compensator));
}

std::string_view kind_name(SourceKind kind) {
  switch (kind) {
    case SourceKind::kFile:
      return "compensator";
    case SourceKind::kLibrary:
      return "library";
    case SourceKind::kCommand:
      return "command";
    case SourceKind::kModel:
      return "model";
    case SourceKind::kFunction:
      break;
  }
  return "function";
}

bool is_program(SourceKind kind) {
  return kind == SourceKind::kLibrary || kind == SourceKind::kCommand;
}

SourceKind source_kind(const std::string& argument) {
  if (argument.starts_with(kCommandPrefix)) return SourceKind::kCommand;
  const std::string bytes = first_bytes(argument);
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (bytes.starts_with(kElf)) return SourceKind::kLibrary;
  if (first != std::string::npos && bytes[first] == '{')
    return SourceKind::kFile;
  if (argument.ends_with(".toml")) return SourceKind::kModel;
  if (argument.ends_with(".so")) return SourceKind::kLibrary;
  return !argument.ends_with(".json") && has_kind(bytes) ? SourceKind::kModel
                                                         : SourceKind::kFile;
}

CompensatorSource open_source(const std::string& argument,
                              const ProcessLimits& limits) {
  switch (const SourceKind kind = source_kind(argument)) {
    case SourceKind::kCommand:
    case SourceKind::kLibrary:
      return source_of_code(kind, argument, limits);
    case SourceKind::kModel: {
      ModelSpec model = read_model(std::filesystem::path(argument));
      const std::string text = model.text;
      return source_of(std::move(model), argument, text);
    }
    case SourceKind::kFile:
    case SourceKind::kFunction:
      break;
  }
  const std::string text = read_compensator_text(argument);
  return source_of(parse_compensator(text, argument), argument, text);
}

CompensatorSource source_of(FittedCompensator compensator,
                            const std::string& name, const std::string& text) {
  CompensatorSource source{SourceKind::kFile, name, without_folder(name),
                           tested(compensator), std::move(compensator)};
  source.files.push_back({name, text});
  return source;
}

CompensatorSource source_of(ModelSpec model, const std::string& name,
                            const std::string& text) {
  CompensatorSource source{SourceKind::kModel, name, without_folder(name)};
  source.files.push_back({name, text});
  for (std::size_t k = 1; k < model.files.size(); ++k)  // the first is its own
    source.files.push_back({model.files[k], read_text_file(model.files[k])});
  source.model = std::move(model);
  return source;
}

CompensatorSource source_of(std::shared_ptr<const TestedCompensator> function,
                            const std::string& name) {
  return {SourceKind::kFunction, name, name, std::move(function)};
}

void isolate_code_of(CompensatorSource& source, const IsolationOptions& more) {
  if (!is_program(source.kind)) {
    if (!more.plugin_files.empty())
      throw option_error("{} is for a library or a command; {} is neither",
                         NamedOption{"plugin_files"}, source.argument);
    if (source.kind != SourceKind::kFunction) return;
    source.isolation = Isolation{"it runs in the process that judges it"};
    if (more.required)
      throw option_error("{}: {} is {}", NamedOption{"require_isolation"},
                         source.name, isolation_words(*source.isolation));
    return;
  }
  IsolationOptions& options = source.limits.isolation;
  for (const auto list :
       {&IsolationOptions::hidden, &IsolationOptions::plugin_files})
    (options.*list)
        .insert((options.*list).end(), (more.*list).begin(),
                (more.*list).end());
  options.required = options.required || more.required;
  CompensatorSource again =
      source_of_code(source.kind, source.argument, source.limits);
  source.tested = std::move(again.tested);
  source.isolation = std::move(again.isolation);
}

void require_unchanged(const CompensatorSource& source) {
  if (source.kind != SourceKind::kLibrary) return;
  for (const SourceText& file : source.files)
    if (read_text_file(file.path) != file.text)
      throw std::runtime_error(fmt::format(
          "{}: changed while it was asked, so the answers may be those of two "
          "libraries",
          file.path.string()));
}

std::shared_ptr<const TestedCompensator> open_tested_compensator(
    const std::string& argument, const ProcessLimits& limits) {
  CompensatorSource source = open_source(argument, limits);
  if (source.model)
    throw std::invalid_argument(fmt::format(
        "{}: is a model, which has no answers; expected a compensator",
        argument));
  return source.tested;
}

}  // namespace beamgyro::internal
