// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "compensation/training/model_file.h"
#include "dataset/set/source_copies.h"
#include "validation/external/tested_compensator.h"

namespace beamgyro::internal {

/// Returns a trained compensator as one to be validated. It is evaluated in
/// this process.
std::unique_ptr<TestedCompensator> tested(FittedCompensator compensator);

/// What a compensator argument can be.
enum class SourceKind {
  kFile,      // of this program, as train writes it
  kLibrary,   // with the functions of beamgyro/plugin.h
  kCommand,   // "cmd:PROGRAM ARGS"
  kModel,     // a model file, which has to be trained first
  kFunction,  // of the caller
};

/// Returns the name that results give it: "compensator", "library", "command",
/// "model", "function".
std::string_view kind_name(SourceKind kind);

/// Whether code of somebody else runs in a process of its own.
bool is_program(SourceKind kind);

/// Returns what an argument is. "cmd:" begins a command. A file is what its
/// bytes are, whatever it is called: ELF is a library, JSON a compensator file,
/// TOML with a key `kind` a model. Where they tell nothing, or there is no
/// file, the ending of its name does; without one it is a compensator file.
SourceKind source_kind(const std::string& argument);

/// A compensator that is to be asked, wherever it comes from. Its files were
/// read once.
struct CompensatorSource {
  SourceKind kind = SourceKind::kFunction;
  std::string argument;  // as it was named
  std::string name;      // in reports: without directories, a command whole
  std::shared_ptr<const TestedCompensator> tested = {};  // not of a model
  std::optional<FittedCompensator> trained = {};         // of a file
  std::optional<ModelSpec> model = {};
  std::vector<SourceText> files = {};       // that it was read from
  std::optional<Isolation> isolation = {};  // of code of others
  ProcessLimits limits = {};                // of a library or a command

  const Provenance* provenance() const {
    return trained ? &trained->provenance : nullptr;
  }
};

/// Opens what an argument names. Throws std::invalid_argument when it cannot be
/// read, is damaged, or is no library of that interface.
CompensatorSource open_source(const std::string& argument,
                              const ProcessLimits& limits = {});

/// The same for what is in memory; `text` is that of its file.
CompensatorSource source_of(FittedCompensator compensator,
                            const std::string& name, const std::string& text);
CompensatorSource source_of(ModelSpec model, const std::string& name,
                            const std::string& text);
CompensatorSource source_of(std::shared_ptr<const TestedCompensator> function,
                            const std::string& name);

/// Opens a library or a command anew, of which the same files were read, with
/// `more` than it was opened with. Functions are not isolated, and of the
/// others no code runs. Throws std::invalid_argument as isolation_of_command(),
/// and for plugin files of what is no library and no command.
void isolate_code_of(CompensatorSource& source, const IsolationOptions& more);

/// Throws std::runtime_error when one of its files has other bytes by now.
/// Libraries are loaded by the system while they are asked.
void require_unchanged(const CompensatorSource& source);

/// Opens any but a model.
std::shared_ptr<const TestedCompensator> open_tested_compensator(
    const std::string& argument, const ProcessLimits& limits = {});

}  // namespace beamgyro::internal
