// SPDX-License-Identifier: MIT
#include "fmu/c_interface.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace beamgyro::internal {
namespace {

// A hexadecimal byte after '%', or -1.
int escaped(std::string_view digits) {
  int value = -1;
  if (digits.size() < 2) return -1;
  const char* end = digits.data() + 2;
  const auto [read, error] = std::from_chars(digits.data(), end, value, 16);
  return error == std::errc() && read == end && value > 0 ? value : -1;
}

}  // namespace

void FmuComponent::keep(FmuInstance::State state, void** held_by_master) {
  require_arrays(1, held_by_master);
  auto kept = std::make_unique<FmuInstance::State>(std::move(state));
  forget(held_by_master);
  void* const pointer = kept.get();
  states.emplace(pointer, std::move(kept));
  *held_by_master = pointer;
}

FmuInstance::State& FmuComponent::held(const void* state) {
  const auto found = states.find(state);
  if (found == states.end())
    throw std::invalid_argument(
        "the state is none of this instance; expected one that it gave and "
        "that was not freed");
  return *found->second;
}

void FmuComponent::forget(void** held_by_master) {
  require_arrays(1, held_by_master);
  if (*held_by_master == nullptr) return;
  held(*held_by_master);
  states.erase(*held_by_master);
  *held_by_master = nullptr;
}

void FmuComponent::serialise(const void* state, void* bytes, std::size_t size) {
  const std::string written = instance.bytes_of(held(state));
  if (written.size() != size)
    throw std::invalid_argument(
        fmt::format("there is room for {} bytes of the state; expected {}",
                    size, written.size()));
  std::memcpy(bytes, written.data(), size);
}

FmuComponent* made_component(
    const char* name, const char* token, FmiVersion version,
    const std::function<std::string()>& resources,
    const std::function<void(const char*)>& log) noexcept {
  try {
    if (name == nullptr || *name == '\0')
      throw std::invalid_argument("the instance has no name; expected one");
    if (token == nullptr)
      throw std::invalid_argument(
          "the token is missing; expected that of the model description");
    return new FmuComponent{{PackedDevice::read(resources()), version, token},
                            log};
  } catch (const std::exception& error) {
    log(error.what());
  } catch (...) {
    log("failed for a reason that is not known");
  }
  return nullptr;
}

int refused(void* component, const char* what) noexcept {
  return answered(component, [&](FmuComponent&) {
    throw std::invalid_argument(
        fmt::format("this FMU has no {}; expected co-simulation", what));
  });
}

void require_none(std::size_t count, const char* type) {
  if (count > 0)
    throw std::invalid_argument(
        fmt::format("no variable is of the type {}; expected the types of the "
                    "model description",
                    type));
}

void require_categories(std::size_t count, const char* const* categories) {
  require_arrays(count, categories);
  for (std::size_t i = 0; i < count; ++i)
    if (categories[i] == nullptr ||
        std::string_view(categories[i]) != kErrorCategory)
      throw std::invalid_argument(fmt::format(
          "the log has no category \"{}\"; expected {}",
          categories[i] == nullptr ? "" : categories[i], kErrorCategory));
}

std::string folder_of_uri(const char* uri) {
  constexpr std::string_view kScheme = "file:";
  std::string_view rest = uri == nullptr ? "" : uri;
  const auto fail = [&] {
    throw std::invalid_argument(fmt::format(
        "the resources are at \"{}\"; expected a URI file:///FOLDER",
        uri == nullptr ? "" : uri));
  };
  if (!rest.starts_with(kScheme)) fail();
  rest.remove_prefix(kScheme.size());
  if (rest.starts_with("//")) {  // a host, which may be empty
    rest.remove_prefix(2);
    rest.remove_prefix(std::min(rest.find('/'), rest.size()));
  }
  if (!rest.starts_with('/')) fail();
  std::string folder;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (rest[i] != '%') {
      folder += rest[i];
      continue;
    }
    const int byte = escaped(rest.substr(i + 1));
    if (byte < 0) fail();
    folder += static_cast<char>(byte);
    i += 2;
  }
  return folder;
}

}  // namespace beamgyro::internal
