// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "compensation/inputs/input.h"
#include "compensation/rows/training_rows.h"
#include "config/document.h"

namespace beamgyro::internal {

struct BiasModel;
struct Fit;
struct Population;

/// The inputs that a method takes.
enum class InputRule {
  kNamed,             // those that the model file names
  kAny,               // whatever they are: it reads none
  kTemperatureFirst,  // the temperature, then inputs that do not see the rate
  kOneTemperature,    // the temperature, measured or through a low-pass
  kMeasuredOnly,      // the measured temperature
  kChannels,          // the temperature, then channels of the gyro
  kOfItsOwn,          // read() sets them
};

/// The model file from which a method is read.
struct MethodSource {
  const ConfigDocument& document;
  std::vector<Input> inputs;                 // keep to the method's rule
  std::vector<std::filesystem::path> files;  // read besides the document
  /// The population of a compensator file. Throws std::invalid_argument.
  std::function<Population(const std::filesystem::path&)> read_population;

  ConfigTable root() const { return document.root(); }
  /// The method's own table, without keys when it is absent.
  ConfigTable table(const char* name) const {
    return root().table_or_empty(name);
  }
};

/// What a method is fitted to. `held_out` may be empty.
struct FitTask {
  const std::vector<Input>& inputs;  // the columns of the rows
  const TrainingRows& rows;
  const TrainingRows& held_out;
  std::uint64_t seed;
};

// A method S of training, one of the alternatives of FitSpec, holds what its
// model file says and has
//
//   static constexpr const char* kName;       `kind` and table of the file
//   static constexpr InputRule kInputRule;
//   using Function = ...;                     kind of bias function it gives
//   static S read(MethodSource&);             throws as ConfigTable
//   std::string method_name() const;          for people: "cubic spline"
//   Fit fit(const FitTask&) const;            throws as fit_model()
//
// and, where they are not the usual ones,
//
//   static constexpr bool kFitsSamples = true;   rows are samples by default
//   static constexpr bool kIsCandidate = true;   `kind = "auto"` may name it

}  // namespace beamgyro::internal
