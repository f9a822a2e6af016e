// SPDX-License-Identifier: MIT
#include "config/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "config/document_state.h"
#include "config/toml_parser.h"

namespace beamgyro {
namespace {

std::string read_file(const std::filesystem::path& file) {
  const auto reject = [&](const std::string& reason) {
    throw std::invalid_argument(fmt::format(
        "{}: cannot read: {}; expected a TOML file", file.string(), reason));
  };
  std::error_code status_error;
  const auto kind = std::filesystem::status(file, status_error);
  if (std::filesystem::is_directory(kind)) reject("it is a directory");
  if (std::filesystem::exists(kind) && !std::filesystem::is_regular_file(kind))
    reject("it is a device or pipe");
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) reject(std::generic_category().message(errno));
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (stream.bad()) reject(std::generic_category().message(errno));
  return text;
}

void insert_all(const OverrideSet& sets, DocumentState& state) {
  for (std::size_t i = 0; i < sets.overrides.size(); ++i)
    insert_override(sets.overrides[i], i, state.name, state.root);
}

}  // namespace

ConfigDocument::ConfigDocument(std::shared_ptr<DocumentState> state)
    : state_(std::move(state)), root_(state_, state_->root, "", true) {}

ConfigDocument ConfigDocument::read(const std::filesystem::path& file,
                                    Overrides& overrides) {
  return parse(read_file(file), file, overrides.state_);
}

ConfigDocument ConfigDocument::read(const std::filesystem::path& file) {
  return parse(read_file(file), file, Overrides().state_);
}

ConfigDocument ConfigDocument::parse(std::string_view text,
                                     const std::string& name,
                                     Overrides& overrides) {
  return parse(std::string(text), name, overrides.state_);
}

ConfigDocument ConfigDocument::parse(std::string_view text,
                                     const std::string& name) {
  return parse(std::string(text), name, Overrides().state_);
}

ConfigDocument ConfigDocument::parse(std::string text,
                                     const std::filesystem::path& path,
                                     const std::shared_ptr<OverrideSet>& sets) {
  auto state = std::make_shared<DocumentState>();
  state->path = path;
  state->name = path.string();
  state->text = std::move(text);
  state->overrides = sets;
  try {
    state->root = parse_toml(state->text);
  } catch (const TomlError& error) {
    throw std::invalid_argument(
        fmt::format("{}:{}:{}: not TOML: {}", state->name, error.position.line,
                    error.position.column, error.what()));
  }
  state->file_root = std::make_shared<const ConfigNode>(state->root);
  insert_all(*sets, *state);
  return ConfigDocument(std::move(state));
}

ConfigDocument ConfigDocument::with(Overrides& overrides,
                                    const std::string& name) const {
  auto state = std::make_shared<DocumentState>();
  state->path = state_->path;
  state->name = name.empty() ? state_->name : name;
  state->text = state_->text;
  state->file_root = state_->file_root;
  state->root = *state_->file_root;
  state->overrides = overrides.state_;
  insert_all(*overrides.state_, *state);
  return ConfigDocument(std::move(state));
}

const ConfigNode* ConfigDocument::value(std::string_view dotted_key) const {
  const ConfigNode* node = &state_->root;
  while (node != nullptr && !dotted_key.empty()) {
    const std::size_t dot = std::min(dotted_key.find('.'), dotted_key.size());
    node = find_child(*node, dotted_key.substr(0, dot));
    dotted_key.remove_prefix(std::min(dot + 1, dotted_key.size()));
  }
  return node;
}

const std::string& ConfigDocument::text() const { return state_->text; }

const std::filesystem::path& ConfigDocument::path() const {
  return state_->path;
}

void ConfigDocument::reject_unknown_keys() const {
  state_->reject_unknown_keys();
}

}  // namespace beamgyro
