// SPDX-License-Identifier: MIT
/// \file
/// Data cards: what a set is, for those who find it somewhere.
#pragma once

#include <string>
#include <vector>

#include "beamgyro/progress.h"
#include "beamgyro/set.h"
#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {

/// What no set knows of itself. Croissant 1.0 requires all but the version.
struct SetCardOptions {
  std::string license = {};  ///< an address, or a name of SPDX
  std::string url = {};      ///< of the page of the set
  std::string creator = {};  ///< a person or an organisation
  std::string date = {};     ///< of publication, as 2026-11-28
  std::string version = "1.0.0";
  Progress progress = {};  ///< of the comparison with the manifest
};

struct SetCard {
  std::string croissant;  ///< of croissant.json: JSON-LD, Croissant 1.0
  std::string readme;     ///< of README.md
  std::vector<std::string> warnings;
};

/// Returns the card of a set: its files with sizes and checksums, devices,
/// splits, variables, and what it can and cannot teach. The texts depend on the
/// set and the options alone. Throws std::invalid_argument for an option that
/// is not what it should be and for a set with other bytes than its manifest
/// says, and Cancelled.
SetCard card_of(const Set& set, const SetCardOptions& options = {});

/// Writes croissant.json and README.md into the directory of the set, and
/// returns the warnings. Throws as card_of(), std::invalid_argument where
/// another README.md or croissant.json is there that card_of() did not make,
/// and std::runtime_error when writing fails.
std::vector<std::string> write_card(const Set& set,
                                    const SetCardOptions& options = {});

}  // namespace beamgyro
