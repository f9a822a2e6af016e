// SPDX-License-Identifier: MIT
#include "validation/external/process_keeper.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

constexpr int kLookAtMemory = 50;  // [ms]
constexpr std::string_view kTooMuchMemory = "out of memory\n";

fs::path place_of(pid_t process) {
  return fs::path("/proc") / std::to_string(process);
}

/// The children of a process, those of all its threads.
std::vector<pid_t> children_of(pid_t process) {
  std::vector<pid_t> children;
  std::error_code ended;  // meanwhile
  fs::directory_iterator thread(place_of(process) / "task", ended);
  for (; !ended && thread != fs::directory_iterator();
       thread.increment(ended)) {
    std::ifstream list(thread->path() / "children");
    for (pid_t child = 0; list >> child;) children.push_back(child);
  }
  return children;
}

/// All that descend from this process.
std::vector<pid_t> descendants() {
  std::vector<pid_t> all = children_of(::getpid());
  for (std::size_t k = 0; k < all.size(); ++k)
    for (const pid_t child : children_of(all[k])) all.push_back(child);
  return all;
}

std::size_t resident_bytes(pid_t process) {
  std::ifstream file(place_of(process) / "statm");
  std::size_t size = 0, resident = 0;
  file >> size >> resident;
  return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// The same with a share of the pages that several processes have. It costs
/// milliseconds for gigabytes.
std::size_t proportional_bytes(pid_t process) {
  std::ifstream file(place_of(process) / "smaps_rollup");
  std::size_t kibibytes = 0;
  for (std::string word; file >> word;)
    if (word == "Pss:" && file >> kibibytes) return kibibytes * 1024;
  return resident_bytes(process);
}

std::size_t memory_of(const std::vector<pid_t>& processes,
                      std::size_t (*bytes)(pid_t)) {
  std::size_t sum = 0;
  for (const pid_t process : processes) sum += bytes(process);
  return sum;
}

bool exceeds(std::size_t memory) {
  const std::vector<pid_t> all = descendants();
  return memory_of(all, resident_bytes) > memory &&
         memory_of(all, proportional_bytes) > memory;
}

/// Ends all children; what they had started become children of this process.
void end_children() {
  for (;;) {
    for (const pid_t child : descendants()) ::kill(child, SIGKILL);
    if (::waitpid(-1, nullptr, 0) < 0 && errno == ECHILD) return;
  }
}

/// Ends by the signal that ended the child, or returns its status.
int end_as(int status) {
  if (!WIFSIGNALED(status)) return WEXITSTATUS(status);
  const int signal = WTERMSIG(status);
  std::signal(signal, SIG_DFL);
  sigset_t one;
  sigemptyset(&one);
  sigaddset(&one, signal);
  ::raise(signal);
  ::sigprocmask(SIG_UNBLOCK, &one, nullptr);  // here it ends
  return 1;
}

/// Waits for the first reason to end. Returns whether the child ended by
/// itself, and how.
bool has_ended(pid_t child, int signals, std::size_t memory, int& status) {
  std::array<pollfd, 2> waits = {pollfd{kLifeDescriptor, POLLIN, 0},
                                 pollfd{signals, POLLIN, 0}};
  for (;;) {
    const int timeout = memory > 0 ? kLookAtMemory : -1;
    ::poll(waits.data(), waits.size(), timeout);
    if (waits[0].revents != 0) return false;
    signalfd_siginfo met{};
    while (::read(signals, &met, sizeof met) == sizeof met)
      if (met.ssi_signo != SIGCHLD) return false;
    for (int ended = 0; const pid_t id = ::waitpid(-1, &ended, WNOHANG);) {
      if (id < 0) break;
      if (id != child) continue;  // one that it had left behind
      status = ended;
      return true;
    }
    if (memory > 0 && exceeds(memory)) {
      status = W_EXITCODE(1, 0);
      end_children();
      static_cast<void>(!::write(STDERR_FILENO, kTooMuchMemory.data(),
                                 kTooMuchMemory.size()));
      return false;
    }
  }
}

int keep(pid_t child, int signals, std::size_t memory, const fs::path& folder) {
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int pipe : {STDIN_FILENO, STDOUT_FILENO}) ::dup2(nothing, pipe);
  int status = W_EXITCODE(0, SIGKILL);
  const bool by_itself = has_ended(child, signals, memory, status);
  end_children();
  std::error_code ignored;
  if (!by_itself) fs::remove_all(folder, ignored);
  return end_as(status);
}

}  // namespace

std::optional<int> keep_child(std::size_t memory, const fs::path& folder) {
  sigset_t waited, none;
  sigemptyset(&none);
  sigemptyset(&waited);
  for (const int signal : {SIGCHLD, SIGTERM, SIGINT, SIGHUP, SIGQUIT})
    sigaddset(&waited, signal);
  ::sigprocmask(SIG_BLOCK, &waited, nullptr);
  const int signals = ::signalfd(-1, &waited, SFD_NONBLOCK | SFD_CLOEXEC);
  if (signals < 0 || ::prctl(PR_SET_CHILD_SUBREAPER, 1) != 0)
    throw std::system_error(errno, std::generic_category());
  const pid_t keeper = ::getpid(), child = ::fork();
  if (child < 0) throw std::system_error(errno, std::generic_category());
  if (child > 0) return keep(child, signals, memory, folder);
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != keeper) ::raise(SIGKILL);  // it ended before
  ::close(signals);
  ::close(kLifeDescriptor);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  return std::nullopt;
}

}  // namespace beamgyro::internal
