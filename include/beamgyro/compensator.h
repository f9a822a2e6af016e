// SPDX-License-Identifier: MIT
/// \file
/// Compensators: from the measured signals of a gyro to a rate without drift.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "beamgyro/recording.h"
#include "beamgyro/shared.h"
#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {
namespace internal {
struct CompensatorState;
}

/// The answers of a compensator to one run.
struct CompensatedRate {
  std::vector<double> rate;  ///< [deg/s], one per sample; NaN where unpowered
  /// [deg/s], 1-sigma of the bias of each, above 0; empty where it states none.
  std::vector<double> sigma = {};
  /// Samples outside the temperatures seen in training, whose temperature was
  /// clamped.
  std::size_t clamped = 0;
  /// What is wrong with the way the compensator answered, in words: it crashed,
  /// gave too few numbers, a NaN, ... Those of a class of the user's own end
  /// compensate() and fail validate().
  std::vector<std::string> faults = {};
};

/// A compensator of any kind: one that was trained, a program or library of the
/// user (open_compensator()), or a class of the user's own. Its const members
/// may be called by many threads at once.
class RateCompensator {
 public:
  RateCompensator() = default;
  virtual ~RateCompensator();

  /// Returns the name that reports give it.
  virtual std::string name() const = 0;

  /// Returns the measured variables that it reads, as recordings name them
  /// (`rate`, `temperature`, ...); none: it is given all that a run has.
  virtual std::vector<std::string> inputs() const = 0;

  /// Returns its answers to the samples of a recording. Compensation and
  /// validation give a class of the user's own one stretch from a power-on to
  /// the next power-off at a time, of which it sees `run`, `time`, `status` and
  /// the measured columns inputs(); it keeps nothing from one call to the next.
  /// An exception that it throws reaches the caller.
  virtual CompensatedRate answer(const Recording& recording) const = 0;

 protected:
  RateCompensator(const RateCompensator&) = default;
  RateCompensator& operator=(const RateCompensator&) = default;
};

/// Returns a compensator that calls `rate_of` with a stretch of samples for
/// their rates [deg/s]. Throws std::invalid_argument without a function.
std::shared_ptr<const RateCompensator> compensator_of(
    std::string name, std::vector<std::string> inputs,
    std::function<std::vector<double>(const Recording&)> rate_of);

/// A trained compensator, (rate - bias(inputs)) / s(T), as `beamgyro train`
/// writes it (docs/reference/compensator_file.md). Immutable; copies share
/// their state, and many threads may use one at once.
class Compensator final : public RateCompensator,
                          public Shared<internal::CompensatorState> {
 public:
  /// Reads a compensator file. Throws std::invalid_argument with line and
  /// column or the key for what is wrong in it.
  static Compensator read(const std::filesystem::path& file);
  /// The same for a text in memory, called `name` in messages.
  static Compensator parse(const std::string& text,
                           const std::string& name = "compensator.json");

  std::string text() const;  ///< of its file, byte for byte
  /// Writes text(). Throws std::invalid_argument for a name that cannot be
  /// written, and std::runtime_error when writing fails.
  void write(const std::filesystem::path& file) const;

  std::string name() const override;
  std::vector<std::string> inputs() const override;
  /// Throws std::invalid_argument for a recording that write_recording()
  /// refuses, and one that lacks an input.
  CompensatedRate answer(const Recording& recording) const override;

  std::string method() const;          ///< "cubic as PX4 fits it", ...
  double lowest_temperature() const;   ///< [degC], seen in training
  double highest_temperature() const;  ///< [degC]
  bool states_sigma() const;
  /// Returns its curve over temperature as JSON, long after power-on at a
  /// steady measured temperature, in lists of one length:
  ///
  ///     temperature_degC   from 8 % of the trained range below it to 8 % above
  ///     bias_deg_per_s     taken away, at the clamped temperature; null where
  ///                        it follows more than the temperature
  ///     cubic_deg_per_s    the same of the cubic of its training
  ///     straight_lines_deg_per_s
  ///                        of the lines between its soaks, or null
  ///     sigma_deg_per_s    stated 1-sigma; null where it states none
  ///
  /// `other_inputs` names the inputs that the temperature does not tell.
  std::string curve() const;
  /// What the data of its training do not support.
  std::vector<std::string> warnings() const;

  using Shared::Shared;
};

/// What a compensator may use that runs in a process of its own.
struct ProcessOptions {
  /// Longest time without taking a sample or giving an answer, above 0.
  double stall_s = 10.0;
  std::size_t memory = std::size_t{2} << 30;  ///< [bytes]; 0: no limit
  /// The program `beamgyro`, which loads shared libraries and isolates commands
  /// (docs/reference/plugins.md) in processes of their own. Without it commands
  /// are not isolated, and nothing keeps them: a command whose caller is killed
  /// by SIGKILL runs on, and so does what it starts and leaves behind. The
  /// limit of memory then holds for each of its processes alone. A keeper needs
  /// a program: a process with threads, as the caller may be, must not do the
  /// work of one in a fork of itself.
  std::filesystem::path program = {};
  /// Files and folders that it may read beside those of the system and the
  /// scripts that a command names.
  std::vector<std::filesystem::path> plugin_files = {};
  /// Files and folders that it must not read, wherever they lie.
  std::vector<std::filesystem::path> hidden_files = {};
  bool require_isolation = false;  ///< refuses to run what is not isolated
};

/// Opens what `beamgyro compensate` takes: FILE.json, a shared library FILE.so
/// with the functions of beamgyro/plugin.h, or "cmd:PROGRAM ARGS". Throws
/// std::invalid_argument when it is none of them or cannot be read, for a
/// library without ProcessOptions::program, for plugin files that are hidden,
/// missing or HDF5 files, or hold one, and where isolation is required and the
/// system has none.
std::shared_ptr<const RateCompensator> open_compensator(
    const std::string& argument, const ProcessOptions& options = {});

/// A recording with the answers of a compensator.
struct CompensatedRun {
  Recording recording;
  std::vector<std::string> warnings;
};

/// Returns `recording` with the columns compensated_rate and, where the
/// compensator states one, compensated_rate_sigma [deg/s], its name and a line
/// of history, as `beamgyro compensate` writes it. Throws std::invalid_argument
/// for a recording that write_recording() refuses, that was compensated already
/// or lacks an input, and for a sigma that is not above 0, and
/// std::runtime_error with its words for a fault of the compensator.
CompensatedRun compensate(const RateCompensator& compensator,
                          Recording recording);

}  // namespace beamgyro
