// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "compensation/compensator.h"
#include "compensation/export_findings.h"
#include "compensation/firmware_model.h"

namespace beamgyro {

bool has_filter(const Input& input);

/// Whether the input is a signal other than the temperature.
bool reads_a_signal(const Input& input);

/// What the exported code of a compensator consists of.
struct FirmwareParts {
  explicit FirmwareParts(const Compensator& compensator);

  bool uses_inputs;         // the bias is not a constant
  int filters = 0;          // of the temperature
  bool clock = false;       // since power-on
  bool reads_more = false;  // than the rate and the temperature
};

/// NAME.h: what was trained, its warnings and findings, and the interface.
std::string header_text(const Compensator& compensator, const std::string& name,
                        const FirmwareModel& model,
                        const ExportFindings& found);

/// Comments of C, one for each warning.
std::string warning_comments(const std::vector<std::string>& warnings);

}  // namespace beamgyro
