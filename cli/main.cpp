// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/Version.hpp>
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/program_version.h"
#include "api/validation_members.h"
#include "cli/commands.h"
#include "cli/terminal.h"
#include "dataset/files/atomic_file.h"
#include "dataset/netcdf/hdf5_exit.h"
#include "include/beamgyro/option_error.h"
#include "validation/external/child_process.h"
#include "validation/external/plugin_host.h"

namespace beamgyro::internal {
namespace {

// Dies by the signal, so that a loop of the shell ends, too.
extern "C" void end_process(int signal) {
  kill_child_processes();
  remove_partial_files();
  print_interrupted();
  std::signal(signal, SIG_DFL);
  raise(signal);
  sigset_t mask;
  sigemptyset(&mask);
  sigaddset(&mask, signal);
  sigprocmask(SIG_UNBLOCK, &mask, nullptr);  // here it ends
  _exit(128 + signal);
}

/// Makes SIGINT, SIGTERM and SIGHUP remove the unfinished files of this
/// process, print what is kept, and end it by the same signal; a shell sees
/// status 130, 143 or 129. One that was ignored stays so.
void handle_interrupts() {
  struct sigaction action {};
  action.sa_handler = end_process;
  sigfillset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    // nohup ignores SIGHUP, a script SIGINT in what it starts in its
    // background.
    if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
  // A closed pipe and a limit on the size of files are reported by the failed
  // write instead.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

// Program, revision and libraries.
std::string version_text() {
  return fmt::format(
      "beamgyro {} ({})\n"
      "Eigen {}, SUNDIALS {}, HDF5 {}, CLI11 {}, fmt {}, {}",
      kProgramVersion, kGitRevision, BEAMGYRO_EIGEN_VERSION,
      BEAMGYRO_SUNDIALS_VERSION, BEAMGYRO_HDF5_VERSION, CLI11_VERSION,
      FMT_VERSION,
#ifdef __clang__
      "clang " __clang_version__
#else
      "gcc " __VERSION__
#endif
  );
}

constexpr int kWorkFailed = 1, kWrongInput = 2;

/// Options whose names on the command line are not those of the library.
constexpr std::pair<std::string_view, std::string_view> kOtherNames[] = {
    {"axes", "axis"},
    {"chamber_degC", "chamber"},
    {"column", "dataset"},
    {"cross_validation", "cv"},
    {"from_s", "from"},
    {"hold_min", "hold"},
    {"range_degC", "range"},
    {"residual_deg_per_s", "residual"},
    {"round_deg_per_s", "round"},
    {"start_degC", "start"},
    {"to_s", "to"},
    {"zero_at_degC", "zero-at"}};

/// Returns "--name value" for the option that the library calls `name`.
std::string on_command_line(std::string_view name, std::string_view value) {
  const auto* const other = std::ranges::find(
      kOtherNames, name, &std::pair<std::string_view, std::string_view>::first);
  std::string option(other == std::end(kOtherNames) ? name : other->second);
  for (const ValidationMember& row : validation_members())
    if (row.name == name && !row.option.empty()) option = row.option;
  std::ranges::replace(option, '_', '-');
  return fmt::format("--{}{}{}", option, value.empty() ? "" : " ", value);
}

int run_program(const std::vector<std::string>& words) {
  if (!words.empty() && words[0] == kPluginHostWord) {
    const char* search_path = std::getenv("PATH");
    return host_plugin({words.begin() + 1, words.end()},
                       search_path == nullptr ? "" : search_path);
  }
  CommandLine program(
      "Simulates vibrating-beam piezo gyros with thermal drift, and trains and "
      "scores compensators on them.",
      version_text());
  add_characterise(program);
  add_device(program);
  add_run(program);
  add_generate(program);
  add_live(program);
  add_sensitivity(program);
  add_train(program);
  add_compensate(program);
  add_validate(program);
  add_export(program);
  add_fmu(program);
  add_plan(program);
  add_import(program);
  add_info(program);
  add_plot(program);
  add_verify(program);
  add_card(program);
  add_allan(program);
  const Action action = program.parse(words);
  set_quiet(program.quiet());
  const int status = action();
  print_kept_warnings();
  return status;
}

}  // namespace
}  // namespace beamgyro::internal

int main(int argc, char** argv) {
  using namespace beamgyro::internal;
  handle_interrupts();
  try {
    keep_hdf5_open_at_exit();
    return run_program({argv + std::min(argc, 1), argv + argc});
  } catch (const beamgyro::OptionError& error) {
    print_error(error.words(on_command_line));
    return kWrongInput;
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
