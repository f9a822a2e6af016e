// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace beamgyro {

/// Carries out a parsed command and returns the exit status.
using Action = std::function<int()>;

/// Each function adds one subcommand with its options. It sets `action` when
/// that subcommand is called.
void add_characterise(CLI::App& program, Action& action);
void add_run(CLI::App& program, Action& action);
void add_generate(CLI::App& program, Action& action);
void add_import(CLI::App& program, Action& action);
void add_train(CLI::App& program, Action& action);
void add_compensate(CLI::App& program, Action& action);
void add_export(CLI::App& program, Action& action);
void add_validate(CLI::App& program, Action& action);
void add_allan(CLI::App& program, Action& action);
void add_verify(CLI::App& program, Action& action);
void add_info(CLI::App& program, Action& action);

}  // namespace beamgyro
