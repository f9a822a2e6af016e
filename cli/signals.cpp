// SPDX-License-Identifier: MIT
#include "cli/signals.h"

#include <unistd.h>

#include <csignal>

#include "dataset/files/atomic_file.h"

namespace beamgyro {
namespace {

extern "C" void end_process(int signal) {
  remove_partial_files();
  _exit(128 + signal);
}

}  // namespace

void handle_interrupts() {
  struct sigaction action {};
  action.sa_handler = end_process;
  sigfillset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGHUP, &action, nullptr);
  // A closed pipe and a limit on the size of files are reported by the failed
  // write instead.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace beamgyro
