// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace beamgyro::internal {

/// A program of a command that the process may not read.
struct UnreachableProgram {
  std::filesystem::path file;
  std::filesystem::path plugin_files;  // the folder or file to allow for it
};

/// The programs that the words of a command name, as the shell finds them in
/// this environment: by their paths, in the folders of `search_path`, or in the
/// first line of a script. Made before the process is restricted, and asked
/// afterwards.
class ProgramSearch {
 public:
  ProgramSearch(const std::string& command, const std::string& search_path);

  /// Returns a program that could be read before and cannot be read now, where
  /// the shell would say so, or would run another one that is later in the
  /// search path. The same for a virtual environment of Python whose program is
  /// that of the system.
  std::optional<UnreachableProgram> unreachable() const;

 private:
  // A file that could be read, which tells whether a program can be run.
  struct Probe {
    std::filesystem::path file;
    UnreachableProgram program;
  };

  void add(const std::filesystem::path& file, bool is_run);
  void add_interpreter(const std::filesystem::path& script);
  void add_probe(const std::filesystem::path& file,
                 const UnreachableProgram& program);
  std::optional<std::filesystem::path> program_of(
      const std::string& name) const;

  std::vector<std::filesystem::path> folders_;
  std::vector<Probe> probes_;
};

}  // namespace beamgyro::internal
