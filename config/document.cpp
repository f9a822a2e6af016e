// SPDX-License-Identifier: MIT
#include "config/document.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "config/document_state.h"
#include "config/file_error.h"
#include "config/readable_files.h"
#include "config/toml_parser.h"

namespace beamgyro::internal {
namespace {

constexpr std::string_view kExpected = "a TOML file";

[[noreturn]] void fail(const std::filesystem::path& file) {
  throw_file_error(file, "cannot read",
                   std::error_code(errno, std::generic_category()), kExpected);
}

std::string read_rest(int descriptor, const std::filesystem::path& file) {
  std::string text;
  for (std::array<char, 65536> piece{};;) {
    const ssize_t size = uninterrupted(
        [&] { return ::read(descriptor, piece.data(), piece.size()); });
    if (size < 0) fail(file);
    if (size == 0 || text.size() > kLargestToml) return text;
    text.append(piece.data(), static_cast<std::size_t>(size));
  }
}

std::string read_file(const std::filesystem::path& file) {
  require_readable(file);
  const std::filesystem::file_status kind = status_of(file);
  if (std::filesystem::exists(kind) &&
      !std::filesystem::is_regular_file(kind)) {
    throw std::invalid_argument(fmt::format(
        "{}: cannot read: it is a {}; expected {}", file.string(),
        std::filesystem::is_directory(kind) ? "directory" : "device or pipe",
        kExpected));
  }
  const int descriptor =
      uninterrupted([&] { return ::open(file.c_str(), O_RDONLY | O_CLOEXEC); });
  if (descriptor < 0) fail(file);
  const std::unique_ptr<const int, void (*)(const int*)> owner(
      &descriptor, [](const int* opened) { ::close(*opened); });
  return read_rest(descriptor, file);
}

void insert_all(DocumentState& state) {
  const std::vector<Override>& all = state.overrides->overrides;
  for (std::size_t i = 0; i < all.size(); ++i)
    insert_override(all[i], i, state.name, state.root);
}

// A value of an override has its place where its key is.
void settle(ConfigNode& node) {
  if (node.origin) node.position = node.key_position;
  node.origin.reset();
  node.bridge = node.known = false;
  for (ConfigNode& child : node.children) settle(child);
}

// By its first line.
bool looks_like_csv(std::string_view text) {
  const std::string_view first = text.substr(0, text.find('\n'));
  return first.find_first_of("=[#{<") == std::string_view::npos &&
         first.find_first_of(",;\t") != std::string_view::npos;
}

}  // namespace

ConfigDocument::ConfigDocument(std::shared_ptr<DocumentState> state)
    : state_(std::move(state)), root_(state_, state_->root, "", true) {}

ConfigDocument ConfigDocument::read(const std::filesystem::path& file,
                                    const Overrides& overrides) {
  const std::string text = read_file(file);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == text.npos)
    throw std::invalid_argument(
        fmt::format("{}: is empty; expected {}", file.string(), kExpected));
  if (text[first] == '{')
    throw std::invalid_argument(
        fmt::format("{}: is JSON, as compensators and results are; expected {}",
                    file.string(), kExpected));
  return parse(text, file.string(), overrides);
}

ConfigDocument ConfigDocument::parse(std::string_view text,
                                     const std::string& name,
                                     const Overrides& overrides) {
  auto state = std::make_shared<DocumentState>();
  state->path = name;
  state->name = name;
  state->text = text;
  state->overrides = overrides.state_;
  try {
    state->root = parse_toml(state->text);
  } catch (const TomlError& error) {
    throw std::invalid_argument(fmt::format(
        "{}:{}:{}: not TOML: {}{}", state->name, error.position.line,
        error.position.column, error.what(),
        looks_like_csv(state->text)
            ? "; the file looks like CSV, expected one of keys and values"
            : ""));
  }
  state->file_root = std::make_shared<const ConfigNode>(state->root);
  insert_all(*state);
  return ConfigDocument(std::move(state));
}

ConfigDocument ConfigDocument::with(const Overrides& overrides,
                                    const std::string& name) const {
  auto state = std::make_shared<DocumentState>();
  state->path = state_->path;
  state->name = name.empty() ? state_->name : name;
  state->text = state_->text;
  state->file_root = state_->file_root;
  state->root = *state_->file_root;
  state->overrides = overrides.state_;
  insert_all(*state);
  return ConfigDocument(std::move(state));
}

ConfigDocument ConfigDocument::settled() const {
  auto state = std::make_shared<DocumentState>();
  state->path = state_->path;
  state->name = state_->name;
  state->text = state_->text;
  state->root = state_->root;
  settle(state->root);
  state->file_root = std::make_shared<const ConfigNode>(state->root);
  state->overrides = std::make_shared<OverrideSet>();
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

void ConfigDocument::collect_numbers(std::vector<NumberRead>* numbers) const {
  state_->numbers = numbers;
}

const std::string& ConfigDocument::text() const { return state_->text; }

const std::filesystem::path& ConfigDocument::path() const {
  return state_->path;
}

void ConfigDocument::reject_unknown_keys() const {
  state_->reject_unknown_keys();
}

}  // namespace beamgyro::internal
