// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/file_kind.h"
#include "include/beamgyro/validate.h"

namespace beamgyro::internal {

/// A member of ValidationOptions by its type.
template <class T>
using OptionOf = T ValidationOptions::*;
using AnyOption = std::variant<
    OptionOf<std::optional<Device>>, OptionOf<std::optional<Set>>,
    OptionOf<std::vector<std::filesystem::path>>,
    OptionOf<std::optional<std::filesystem::path>>,
    OptionOf<std::vector<std::string>>, OptionOf<std::vector<std::uint32_t>>,
    OptionOf<std::optional<std::uint32_t>>, OptionOf<std::optional<double>>,
    OptionOf<std::optional<std::uint64_t>>, OptionOf<bool>,
    OptionOf<std::vector<OwnMetric>>>;

/// What a compensator may be judged on, as bits.
enum Subject : unsigned { kOnDevice = 1, kOnRecordings = 2, kOnSet = 4 };
constexpr unsigned kOnAny = kOnDevice | kOnRecordings | kOnSet;

/// Heading of the options for libraries and commands alone.
constexpr std::string_view kCodeHeading = "A library or a command";

/// A row for each member of ValidationOptions. The command and Python read
/// their options from it, bundles their keys.
struct ValidationMember {
  std::string_view name;  // of the member
  AnyOption member;
  unsigned subjects;        // that it goes with
  std::string_view needs;   // another member, or empty
  std::string_view python;  // keyword
  // Of the command: "full-scale", "DEG_PER_S", the help, what holds without it.
  // Without an option it is an argument, or read by hand.
  std::string_view option, value, help, without;
  std::string_view heading;     // of the help
  std::string_view bundle_key;  // of the request; empty: not in bundles
  std::optional<FileKind> kind = {};
};

std::span<const ValidationMember> validation_members();

/// Returns the row of a member.
const ValidationMember& member_named(std::string_view name);

/// Returns "file", "files", "text", "texts", "whole", "wholes", "seed",
/// "number", "flag" or "functions";
/// empty for a subject.
std::string_view type_name(const ValidationMember& row);

/// Returns which of "device", "recordings" and "set" it goes with.
std::vector<std::string_view> subject_names(const ValidationMember& row);

bool is_given(const ValidationMember& row, const ValidationOptions& options);

/// Throws OptionError unless there is one subject and every other option goes
/// with it, and std::invalid_argument for recordings that are there twice.
void require_sound(const ValidationOptions& options);

}  // namespace beamgyro::internal
