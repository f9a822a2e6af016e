// SPDX-License-Identifier: MIT
#pragma once

#include "cli/command_line.h"

namespace beamgyro::internal {

// Headings of the list of commands.
constexpr const char* kSimulation = "Simulation";
constexpr const char* kCompensation = "Compensation";
constexpr const char* kFiles = "Recordings and sets";

/// Each function adds one command with its options.
void add_characterise(CommandLine& program);
void add_device(CommandLine& program);
void add_run(CommandLine& program);
void add_generate(CommandLine& program);
void add_live(CommandLine& program);
void add_sensitivity(CommandLine& program);
void add_fmu(CommandLine& program);
void add_import(CommandLine& program);
void add_train(CommandLine& program);
void add_compensate(CommandLine& program);
void add_export(CommandLine& program);
void add_validate(CommandLine& program);
void add_plan(CommandLine& program);
void add_allan(CommandLine& program);
void add_card(CommandLine& program);
void add_verify(CommandLine& program);
void add_info(CommandLine& program);
void add_plot(CommandLine& program);

}  // namespace beamgyro::internal
