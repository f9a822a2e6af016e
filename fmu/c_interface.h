// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "fmu/instance.h"

namespace beamgyro::internal {

/// The answers that both versions of FMI have under these numbers.
inline constexpr int kFmiOk = 0, kFmiError = 3;
inline constexpr const char* kErrorCategory = "logStatusError";

/// What a master holds by a pointer: an instance, the states that it took from
/// it, and where messages go.
struct FmuComponent {
  FmuInstance instance;
  std::function<void(const char* message)> log;
  std::map<const void*, std::unique_ptr<FmuInstance::State>> states = {};

  /// Stores a state; `*held` is null or one that is stored, which it replaces.
  void keep(FmuInstance::State state, void** held);
  /// The state that the master holds. Throws std::invalid_argument for what is
  /// none of this instance.
  FmuInstance::State& held(const void* state);
  void forget(void** held);
  /// Writes the bytes of a held state, which must be `size` ones.
  void serialise(const void* state, void* bytes, std::size_t size);
};

/// Returns the instance of a call of the C interface, or a null pointer after a
/// message. No exception leaves it.
FmuComponent* made_component(
    const char* name, const char* token, FmiVersion version,
    const std::function<std::string()>& resources,
    const std::function<void(const char*)>& log) noexcept;

/// Does the work of a call of the C interface. No exception leaves it: its text
/// goes to the log of the component, the answer is kFmiError.
template <class Work>
int answered(void* component, const Work& work) noexcept {
  if (component == nullptr) return kFmiError;
  FmuComponent& called = *static_cast<FmuComponent*>(component);
  try {
    work(called);
    return kFmiOk;
  } catch (const std::exception& error) {
    called.log(error.what());
  } catch (...) {
    called.log("failed for a reason that is not known");
  }
  return kFmiError;
}

/// A function of the standard that this FMU does not have.
int refused(void* component, const char* what) noexcept;

/// Throws std::invalid_argument unless there are arrays where `count` is not 0.
template <class... Pointers>
void require_arrays(std::size_t count, const Pointers*... arrays) {
  if (count > 0 && ((arrays == nullptr) || ...))
    throw std::invalid_argument("an array is missing; expected a pointer");
}

/// No variable of the FMU has this type.
void require_none(std::size_t count, const char* type);

/// Throws std::invalid_argument for a category that the model description does
/// not have.
void require_categories(std::size_t count, const char* const* categories);

/// Returns the folder of a URI "file:///folder" or "file://host/folder", its
/// escapes decoded. Throws std::invalid_argument for another text.
std::string folder_of_uri(const char* uri);

}  // namespace beamgyro::internal
