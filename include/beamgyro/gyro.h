// SPDX-License-Identifier: MIT
/// \file
/// A gyro inside another simulation: rates and temperatures go in, step by
/// step, and what it shows comes out.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "beamgyro/device.h"
#include "beamgyro/progress.h"
#include "beamgyro/recording.h"

namespace beamgyro {

/// What acts on a gyro at one moment.
struct GyroInputs {
  double rate = 0;  ///< about the input axis [degree/s]
  double cross_rate_x = 0, cross_rate_y = 0;  ///< [degree/s]
  double acceleration_x = 0, acceleration_y = 0,
         acceleration_z = 0;        ///< [m/s2]
  double ambient_temperature = 25;  ///< [degC]
  bool powered = true;  ///< over the step that these inputs are given for

  friend bool operator==(const GyroInputs&, const GyroInputs&) = default;
};

/// How a gyro begins.
struct GyroStart {
  std::string fidelity = "quasistatic";  ///< or "envelope"
  std::uint64_t seed = 0;                ///< of its noise
  bool noise = true;
  /// The noise changes at this rate [Hz] and holds in between, so steps may be
  /// cut anywhere: at the output rate of a scenario it is that of its run. 0:
  /// one over the duration of the first step.
  double noise_rate_Hz = 0;
  bool stirred = false;    ///< whether a fan moves the air of a chamber
  GyroInputs inputs = {};  ///< what acts at the start, and has for long
  /// Of every part of the gyro [degC]; none: the ambient temperature.
  std::optional<double> temperature_degC = {};
  std::optional<double> age_hours = {};  ///< since the factory trim
  /// Times [s], the last 0, and temperatures [degC] before the start, of a gyro
  /// that remembers.
  std::vector<std::pair<double, double>> history = {};
};

/// What a gyro shows at one moment, under the names and in the units of a
/// recording (docs/reference/recording.md). NaN: what is measured without
/// power, and what this gyro does not have.
struct GyroSample {
  double time = 0;  ///< [s] since the start
  double output = 0, rate = 0, temperature = 0;
  double drive_frequency = 0, drive_voltage = 0, quadrature = 0;
  std::uint8_t status = 0;  ///< StatusBit mask
};

/// The truth at the same moment, which no gyro shows.
struct GyroTruth {
  double true_rate = 0, true_bias = 0, true_spurious_bias = 0;
  double true_drive_frequency = 0;
  double true_cross_rate_x = 0, true_cross_rate_y = 0;
  double true_acceleration_x = 0, true_acceleration_y = 0;
  double true_acceleration_z = 0;
  double true_fictive_temperature = 0, true_hysteresis = 0;
  double true_beam_temperature = 0, true_pzt_temperature = 0;
  double true_mount_temperature = 0, true_housing_temperature = 0;
  double true_board_temperature = 0, true_sensor_temperature = 0;
  double true_ambient_temperature = 0;
};

/// An input of a gyro that is a number.
struct GyroInputSignal {
  const char* name;   ///< that of the member
  const char* units;  ///< as in recordings
  double GyroInputs::*value;
};
/// All of them, in the order of the members.
std::span<const GyroInputSignal> gyro_inputs();

/// A signal of a sample that is a number: measured, or truth.
struct GyroSignal {
  const char* name;              ///< as in recordings, and that of the member
  double GyroSample::*measured;  ///< null for a truth
  double GyroTruth::*truth;      ///< null for what is measured

  double of(const GyroSample& sample, const GyroTruth& truths) const {
    return measured != nullptr ? sample.*measured : truths.*truth;
  }
};
/// All of them but the time, in the order of the members.
std::span<const GyroSignal> gyro_signals();

/// How inputs of a series act: each is held over its step, or reached at its
/// end along a straight line from the one before.
enum class GyroSteps { kHeld, kLinear };

/// One gyro that goes on step by step without knowing what comes later: the
/// quasi-static or the envelope model of simulate(). The envelope has no units
/// that remember; it starts at rest, and locks within a second of power.
/// Replayed on the samples of a scenario made of straight lines it shows what
/// the run shows (docs/guide/in_the_loop.md). A copy is a snapshot. Different
/// objects may be used in different threads, one object in one thread at a
/// time.
///
/// Whatever a call throws, the gyro is as it was before.
class Gyro {
 public:
  /// Throws std::invalid_argument for a value of `start` that is out of range,
  /// and std::runtime_error for a device whose drive loop cannot lock.
  explicit Gyro(const Device& device, const GyroStart& start = {});
  Gyro(const Gyro& other);
  Gyro(Gyro&& other) noexcept;
  Gyro& operator=(Gyro other) noexcept;
  ~Gyro();

  /// The sample at the end of the last step, or at the start. Where the rate of
  /// the noise is that of the first step the sample at the start has no noise.
  const GyroSample& now() const;
  const GyroTruth& truth() const;

  /// Advances by `duration` [s], above 0 and at most 1e5, with held inputs, and
  /// returns now(). Throws std::invalid_argument for a value that is not finite
  /// or out of range, std::runtime_error with the time for a gyro that cannot
  /// go on.
  const GyroSample& step(double duration, const GyroInputs& held);

  /// The same with inputs that go from one value to another along straight
  /// lines. The power is that of `to`, over the whole step.
  const GyroSample& step(double duration, const GyroInputs& from,
                         const GyroInputs& to);

  /// As many calls of step() with equal durations [s] as there are inputs, to
  /// the last bit. Returns the samples as a recording, which needs `duration`
  /// to be no shorter than 1e-6 s. Throws as step(), with the number of the
  /// step, and Cancelled; the gyro is as it was before.
  Recording advance(double duration, std::span<const GyroInputs> inputs,
                    GyroSteps steps = GyroSteps::kHeld,
                    const Progress& progress = {});

  /// Returns the state as bytes, for restore() in another process with the same
  /// program, device and start.
  std::string state() const;
  /// Goes back to a state(). Throws std::invalid_argument for bytes that are
  /// none of this program, device and start.
  void restore(std::string_view state);

  /// The inputs at the end of the last step, or of the start.
  const GyroInputs& inputs() const;

  const Device& device() const;
  const GyroStart& start() const;

 private:
  friend void step_all(std::span<Gyro* const> gyros, double duration,
                       std::span<const GyroInputs> from,
                       std::span<const GyroInputs> to, unsigned threads);
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Makes one step of several gyros, each with inputs of its own, as
/// Gyro::step() does: all of them, or none if one throws, whose number is in
/// the message. `threads` 0: one per core. Throws std::invalid_argument also
/// for spans of another length, a null pointer and a gyro that is there twice.
void step_all(std::span<Gyro* const> gyros, double duration,
              std::span<const GyroInputs> from, std::span<const GyroInputs> to,
              unsigned threads = 1);

}  // namespace beamgyro
