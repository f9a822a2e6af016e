// SPDX-License-Identifier: MIT
#include "cli/signals.h"

#include <unistd.h>

#include <csignal>

#include "cli/terminal.h"
#include "dataset/files/atomic_file.h"
#include "validation/external/child_process.h"

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

}  // namespace

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

}  // namespace beamgyro::internal
