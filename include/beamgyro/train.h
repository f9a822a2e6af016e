// SPDX-License-Identifier: MIT
/// \file
/// Training: from recordings to a compensator.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "beamgyro/compensator.h"
#include "beamgyro/progress.h"
#include "beamgyro/recording.h"
#include "beamgyro/set.h"
#include "beamgyro/shared.h"
#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {
namespace internal {
struct ModelSpec;
}

/// What to train, read from a model file (docs/reference/model_file.md) and
/// checked. Immutable; copies share their state, and many threads may use one
/// at once.
class Model : public Shared<internal::ModelSpec> {
 public:
  /// Reads a model file. Throws std::invalid_argument "file:line:column: key:
  /// ..." for what is wrong in it.
  static Model read(const std::filesystem::path& file);
  /// The same for a text in memory, called `name` in messages. A population
  /// that it adapts is named relative to the folder of `name`.
  static Model parse(const std::string& text,
                     const std::string& name = "model.toml");

  std::string text() const;  ///< byte for byte as read
  std::string name() const;  ///< of the file, in messages
  std::vector<std::filesystem::path> files() const;  ///< that were read

  using Shared::Shared;
};

struct TrainingOptions {
  std::uint64_t seed = 0;  ///< of the initial weights
  /// Groups that are held out in turn: "run", "cycle", "leg"; empty: none.
  std::string cross_validation = {};
  /// Takes each epoch of a network, and returns whether to go on. It is
  /// called from any thread, but never by two at once.
  std::function<bool(const TrainingProgress&)> progress = {};
};

/// A recording that is trained on or held out. `name` stands in messages and in
/// the provenance of the compensator.
struct NamedRecording {
  std::string name;
  Recording recording;
};

/// Part of a set that is trained on.
struct SetChoice {
  std::vector<std::string> runs = {};  ///< names; none: all
  /// None: the training devices are fitted, the validation devices held out.
  /// Otherwise these are fitted, and nothing is held out; one device alone can
  /// be cross-validated.
  std::vector<std::uint32_t> devices = {};
};

struct TrainedCompensator {
  Compensator compensator;
  std::vector<std::string> warnings;  ///< what the data do not support
  std::string text;                   ///< what `beamgyro train` prints
};

/// Fits a model to recordings. A network stops early on those that are held
/// out. The result does not depend on the number of threads; the text of the
/// compensator is byte for byte what `beamgyro train` writes for the same
/// files. All throw std::invalid_argument when
/// - a recording lacks an input, or is both fitted and held out;
/// - the temperatures are too few or too close together, or an input never
///   varies;
/// - a network has neither held-out recordings nor cross-validation;
/// std::runtime_error when the fit fails, and Cancelled.
TrainedCompensator train(
    const Model& model, const std::vector<std::filesystem::path>& files,
    const std::vector<std::filesystem::path>& held_out = {},
    const TrainingOptions& options = {});

/// The same for recordings in memory; one that write_recording() would refuse
/// throws std::invalid_argument. In the provenance the checksums of what
/// was measured stand in place of those of files.
TrainedCompensator train(const Model& model,
                         const std::vector<NamedRecording>& recordings,
                         const std::vector<NamedRecording>& held_out = {},
                         const TrainingOptions& options = {});

/// The same for the devices of a set. Also throws std::invalid_argument for a
/// run or device that it does not have, and for cross-validation of several
/// devices.
TrainedCompensator train(const Model& model, const Set& set,
                         const SetChoice& choice = {},
                         const TrainingOptions& options = {});

}  // namespace beamgyro
