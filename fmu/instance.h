// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fmu/packed_device.h"
#include "fmu/variables.h"
#include "sim/numerics/state_archive.h"
#include "sim/stepper/gyro_stepper.h"

namespace beamgyro::internal {

/// What a master has set, in the units of the variables.
struct FmuSettings {
  std::array<double, kRealInputs> inputs{};
  std::array<double, kRealInputs> slopes{};  // of the inputs, per second
  bool powered = true, noise = true, stirred = false, starts_at_ambient = true;
  double noise_rate = 0, age = 0, start_temperature = 25;  // [Hz] [h] [degC]
  std::uint64_t seed = 0;
  std::vector<double> keys = {};  // of the device

  void archive(StateArchive& archive);
};

/// Where an instance is in its life. Numbers are those of serialised states.
enum class FmuPhase : std::int32_t {
  kInstantiated,
  kInitialization,
  kStepping,
  kTerminated
};

/// One instance of an FMU: the life that both versions of FMI give it, and a
/// GyroStepper inside. It has no global state, so a process may have many.
/// Every function throws std::invalid_argument or std::runtime_error for a call
/// that is refused or fails, and has then changed nothing.
class FmuInstance {
 public:
  /// All that changes. A copy is a snapshot.
  struct State {
    FmuPhase phase = FmuPhase::kInstantiated;
    double start = 0;  // [s]
    std::optional<double> stop = {};
    FmuSettings settings = {};
    FmuSettings first = {};  // those that the stepper began with
    std::optional<GyroStepper> stepper = {};
  };

  /// `token` is what the master read in the model description.
  FmuInstance(PackedDevice device, FmiVersion version, std::string_view token);

  void set_up(double start, std::optional<double> stop);
  void enter_initialization();
  void exit_initialization();
  void terminate();
  void reset();

  /// Advances from `time` to `time + size` [s].
  void step(double time, double size);
  double time() const;  // [s]
  FmuPhase phase() const { return state_->phase; }

  /// Values of variables of one type.
  void get_reals(std::span<const std::uint32_t> references, double* values);
  void get_integers(std::span<const std::uint32_t> references,
                    std::int32_t* values);
  bool get_boolean(std::uint32_t reference);
  std::uint64_t get_unsigned64(std::uint32_t reference) const;

  void set_reals(std::span<const std::uint32_t> references,
                 const double* values);
  void set_integers(std::span<const std::uint32_t> references,
                    const std::int32_t* values);
  void set_booleans(std::span<const std::uint32_t> references,
                    const bool* values);
  void set_unsigned64(std::uint32_t reference, std::uint64_t value);

  /// The first derivatives of inputs over the next step [1/s].
  void set_slopes(std::span<const std::uint32_t> references,
                  const std::int32_t* orders, const double* values);

  const State& state() const { return *state_; }
  /// `state` must be one of this device.
  void set_state(const State& state) {
    state_ = std::make_unique<State>(state);
  }
  /// Returns the bytes of a state: a version, the length, the token of the
  /// device and a checksum, then plain numbers.
  std::string bytes_of(const State& state) const;
  /// Throws std::invalid_argument for bytes that bytes_of() of the same device
  /// and program has not made.
  State state_of(std::string_view bytes);

 private:
  const FmuVariable& variable(std::uint32_t reference, VariableType type) const;
  const FmuVariable& settable(std::uint32_t reference, VariableType type) const;
  void require_phase(std::initializer_list<FmuPhase> phases,
                     const char* call) const;
  void require_signals();
  void note_change();
  double real(std::uint32_t reference) const;
  std::int32_t integer(std::uint32_t reference) const;
  bool& flag(std::uint32_t reference);
  void put_real(std::uint32_t reference, double value);
  void put_integer(std::uint32_t reference, std::int32_t value);
  void start_stepper();
  GyroStepper stepper_of(const FmuSettings& settings);

  PackedDevice device_;
  std::vector<FmuVariable> variables_;
  std::vector<const FmuVariable*> by_reference_;  // those below kFirstKey
  std::unique_ptr<State> state_;
  // The model of the last keys that one was made for.
  std::shared_ptr<const StepperModel> model_;
  std::vector<double> model_keys_;
};

}  // namespace beamgyro::internal
