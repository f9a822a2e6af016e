// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "fmu/instance.h"
#include "fmu/text_digest.h"
#include "include/beamgyro/version.h"

namespace beamgyro::internal {
namespace {

// What bytes of a state begin with.
std::string head_of(const std::string& token, std::string_view content) {
  return fmt::format("beamgyro FMU state 1 of {}.{}.{}\n{}\n{}\n{}\n",
                     BEAMGYRO_VERSION_MAJOR, BEAMGYRO_VERSION_MINOR,
                     BEAMGYRO_VERSION_PATCH, token, content.size(),
                     text_digest(content));
}

// All but the stepper.
void archive_plain(StateArchive& archive, FmuInstance::State& state,
                   bool& is_started) {
  auto phase = static_cast<std::int32_t>(state.phase);
  bool stops = state.stop.has_value();
  double stop = state.stop.value_or(0);
  archive(phase, state.start, stops, stop, state.settings, is_started);
  state.phase = FmuPhase{phase};
  if (stops) state.stop = stop;
  if (is_started) archive(state.first);
}

}  // namespace

// The number of keys is that of the device, which the token names.
void FmuSettings::archive(StateArchive& archive) {
  archive(inputs, slopes, powered, noise, stirred, starts_at_ambient,
          noise_rate, age, start_temperature, seed);
  for (double& key : keys) archive(key);
}

std::string FmuInstance::bytes_of(const State& state) const {
  std::string content;
  StateArchive archive = StateArchive::writer(content);
  State copy = state;
  bool is_started = state.stepper.has_value();
  archive_plain(archive, copy, is_started);
  if (is_started) content += state.stepper->state();
  return head_of(device_.token(), content) + content;
}

FmuInstance::State FmuInstance::state_of(std::string_view bytes) {
  constexpr int kLinesOfHead = 4;
  std::size_t end = 0;
  for (int line = 0; line < kLinesOfHead && end != bytes.npos; ++line)
    end = bytes.find('\n', end == 0 ? 0 : end + 1);
  const std::string_view content =
      end == bytes.npos ? std::string_view() : bytes.substr(end + 1);
  if (bytes.substr(0, bytes.size() - content.size()) !=
      head_of(device_.token(), content))
    throw std::invalid_argument(
        "the bytes are no state of this device and program; expected those of "
        "a serialised state of the same FMU");
  StateArchive archive = StateArchive::reader(content);
  State state;
  state.settings.keys = state.first.keys = state_->settings.keys;
  bool is_started = false;
  archive_plain(archive, state, is_started);
  if (!is_started) return state;
  state.stepper.emplace(stepper_of(state.first));
  state.stepper->restore(archive.rest());
  return state;
}

}  // namespace beamgyro::internal
