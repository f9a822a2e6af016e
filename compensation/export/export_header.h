// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "compensation/export/export_findings.h"
#include "compensation/export/firmware_model.h"

namespace beamgyro::internal {

/// Returns whether the input needs a low-pass.
bool has_filter(const Input& input);

/// Returns whether the input is a play operator of the temperature.
bool has_play(const Input& input);

/// The parts of the exported code of a compensator.
struct FirmwareParts {
  explicit FirmwareParts(const FittedCompensator& compensator);

  bool uses_inputs;         // the bias is not a constant
  int filters = 0;          // low-passes
  int plays = 0;            // play operators
  bool clock = false;       // since power-on
  bool reads_more = false;  // than the rate and the temperature

  bool follows_temperature() const { return filters + plays > 0; }
};

/// Returns the text of NAME.h: origin of the compensator, warnings and
/// findings, and the interface.
std::string header_text(const FittedCompensator& compensator,
                        const std::string& name, const FirmwareModel& model,
                        const ExportFindings& found);

/// Returns the C99 source of main() of NAME_selftest.c. It calls NAME_step()
/// with temperatures up to 5 K beyond the range and with other inputs within
/// theirs, and compares with FirmwareModel. Its exit status is 0 when all bits
/// are equal. Throws as FirmwareModel.
std::string self_test_source(const FittedCompensator& compensator,
                             const std::string& name);

/// Returns C comments, one for each warning.
std::string warning_comments(const std::vector<std::string>& warnings);

}  // namespace beamgyro::internal
