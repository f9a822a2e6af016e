// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "validation/external/landlock.h"

namespace beamgyro::internal {

struct ProcessLimits;

/// What is asked of the isolation of foreign code.
struct IsolationOptions {
  // Files and folders that it may read beside those of the system.
  std::vector<std::filesystem::path> plugin_files = {};
  // Files and folders that it must not read, wherever they lie: what it is
  // judged by.
  std::vector<std::filesystem::path> hidden = {};
  bool required = false;
  // Version of the rights of Landlock that are used at most; 0: no isolation.
  int highest_landlock = kNewestLandlock;
};

/// A file or folder beside those of the system that foreign code may read.
struct AllowedFile {
  std::string name;    // without the folder that it is in
  std::string sha256;  // of a folder: of the names and sums of all its files
};

/// How foreign code is kept from what it is judged by.
struct Isolation {
  std::string refusal = {};             // why it is not isolated; empty: it is
  std::vector<AllowedFile> files = {};  // of its command, then of the user
  // All that it may read, with the folders of the system.
  std::vector<std::filesystem::path> readable = {};
  int landlock = 0;  // highest version of the rights; 0: not isolated

  bool holds() const { return refusal.empty(); }
};

/// Returns "isolated", or "not isolated: " and the reason.
std::string isolation_words(const Isolation& isolation);

/// Returns how code that reads nothing but the system is isolated here.
Isolation isolation_of_system(const ProcessLimits& limits);

/// Returns how the command of an argument "cmd:PROGRAM ARGS" is isolated, after
/// trying it. It may read
/// - the folders of the system, without what is hidden;
/// - the scripts, programs and libraries that its words name;
/// - limits.isolation.plugin_files.
/// Throws std::invalid_argument when
/// - a plugin file is missing, hidden, an HDF5 file, or a folder that holds one
///   of these;
/// - a program that the command names lies where it may not read, so that
///   another one would be run in its place;
/// - isolation is required and does not hold.
Isolation isolation_of_command(const std::string& argument,
                               const ProcessLimits& limits);

/// The same for a shared library, which may read itself.
Isolation isolation_of_library(const std::filesystem::path& library,
                               const ProcessLimits& limits);

}  // namespace beamgyro::internal
