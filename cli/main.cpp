// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/signals.h"
#include "cli/terminal.h"
#include "cli/version.h"
#include "config/suggestion.h"

namespace beamgyro {
namespace {

constexpr int kWorkFailed = 1, kWrongInput = 2;

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands({}))
    names.push_back(command->get_name());
  return names;
}

// Checks that the first argument that is no option is a command. CLI11 alone
// would only say that a subcommand is required.
void check_command(const CLI::App& program, int argc, char** argv) {
  const std::vector<std::string> names = command_names(program);
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.starts_with('-')) continue;
    if (std::find(names.begin(), names.end(), word) != names.end()) return;
    const std::string meant = suggestion(word, names);
    throw std::invalid_argument(fmt::format(
        "unknown command \"{}\"; {}", word,
        meant.empty() ? "see beamgyro --help"
                      : fmt::format("did you mean \"{}\"?", meant)));
  }
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

int run_program(int argc, char** argv) {
  CLI::App program(
      "Simulates vibrating-beam piezo gyros with thermal drift, and trains and "
      "scores compensators on them.",
      "beamgyro");
  Action action;
  bool quiet = false;
  program.set_version_flag("--version", version_text());
  program.add_flag("-q,--quiet", quiet,
                   "Prints errors only, no notes and no progress");
  program.fallthrough();
  program.require_subcommand(1);
  add_characterise(program, action);
  add_run(program, action);
  add_generate(program, action);
  add_import(program, action);
  add_train(program, action);
  add_compensate(program, action);
  add_export(program, action);
  add_validate(program, action);
  add_allan(program, action);
  add_verify(program, action);
  add_info(program, action);

  check_command(program, argc, argv);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return program.exit(success);
  } catch (const CLI::ParseError& error) {
    throw std::invalid_argument(first_line(error.what()));
  }
  set_quiet(quiet);
  const int status = action();
  print_kept_warnings();
  return status;
}

}  // namespace
}  // namespace beamgyro

int main(int argc, char** argv) {
  using namespace beamgyro;
  handle_interrupts();
  try {
    return run_program(argc, argv);
  } catch (const std::invalid_argument& error) {
    print_error(error.what());
    return kWrongInput;
  } catch (const std::bad_alloc&) {
    print_error("out of memory");
    return kWorkFailed;
  } catch (const std::exception& error) {
    print_error(error.what());
    return kWorkFailed;
  }
}
