// SPDX-License-Identifier: MIT
#include "validation/external/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

#include "config/cut_text.h"
#include "validation/external/answering.h"
#include "validation/external/process_keeper.h"

extern char** environ;

namespace beamgyro::internal {
namespace {

using std::chrono::milliseconds;

constexpr int kPipeBytes = 1 << 20;
constexpr std::size_t kLongestLine = 200;  // bytes
constexpr pid_t kFreeSlot = 0, kTakenSlot = -1;
constexpr double kPatience = 30.0;  // [s]

// Keepers, and leaders of process groups without one, where a signal handler
// may read them.
static_assert(std::atomic<pid_t>::is_always_lock_free);
std::array<std::atomic<pid_t>, 256> live_groups;
std::array<std::atomic<bool>, 256> is_keeper;

// With more processes than slots it waits.
std::size_t take_process_slot() {
  for (;; std::this_thread::sleep_for(milliseconds(1)))
    for (std::size_t k = 0; k < live_groups.size(); ++k)
      if (pid_t expected = kFreeSlot;
          live_groups[k].compare_exchange_strong(expected, kTakenSlot))
        return k;
}

// Makes a folder that the user alone may enter.
std::string made_folder() {
  const std::filesystem::path place = std::filesystem::temp_directory_path();
  std::string name = (place / "beamgyro-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr)
    throw std::runtime_error(fmt::format("{}: cannot make a folder there: {}",
                                         place.string(), std::strerror(errno)));
  return name;
}

// Kills the processes that a keeper keeps, or those of a group.
void end_processes(pid_t id, bool is_kept) noexcept {
  if (!is_kept) {
    ::kill(-id, SIGKILL);
    return;
  }
  ::kill(id, SIGTERM);
  ::kill(id, SIGCONT);  // if foreign code has stopped it
}

void free_process_slot(std::size_t slot, const std::string& folder) {
  std::error_code ignored;
  if (!folder.empty()) std::filesystem::remove_all(folder, ignored);
  live_groups[slot] = kFreeSlot;
}

struct Pipe {
  OpenFile reads, writes;
};

// Above the standard ones, which are set in the child one after the other.
OpenFile above_standard(int descriptor) {
  OpenFile original(descriptor);
  if (descriptor > STDERR_FILENO) return original;
  return OpenFile(::fcntl(descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
}

Pipe make_pipe() {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw std::system_error(errno, std::generic_category(), "a pipe");
  OpenFile reads(ends[0]), writes(ends[1]);
  return {above_standard(reads.release()), above_standard(writes.release())};
}

void make_nonblocking(OpenFile& file) {
  const int flags = ::fcntl(file.descriptor(), F_GETFL);
  ::fcntl(file.descriptor(), F_SETFL, flags | O_NONBLOCK);
}

// The attributes of a new process: a group of its own and signals as usual.
class SpawnAttributes {
 public:
  SpawnAttributes() {
    posix_spawnattr_init(&attributes_);
    sigset_t none, usual;
    sigemptyset(&none);
    sigemptyset(&usual);
    for (const int signal :
         {SIGPIPE, SIGXFSZ, SIGINT, SIGTERM, SIGHUP, SIGQUIT})
      sigaddset(&usual, signal);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setsigdefault(&attributes_, &usual);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETPGROUP |
                                               POSIX_SPAWN_SETSIGMASK |
                                               POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnAttributes() { posix_spawnattr_destroy(&attributes_); }
  SpawnAttributes(const SpawnAttributes&) = delete;
  SpawnAttributes& operator=(const SpawnAttributes&) = delete;
  const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_;
};

// The first descriptors of a new process; it has no others.
class FirstFiles {
 public:
  explicit FirstFiles(std::initializer_list<const OpenFile*> files) {
    posix_spawn_file_actions_init(&actions_);
    int first = STDIN_FILENO;
    for (const OpenFile* file : files)
      posix_spawn_file_actions_adddup2(&actions_, file->descriptor(), first++);
    posix_spawn_file_actions_addclosefrom_np(&actions_, first);
  }
  ~FirstFiles() { posix_spawn_file_actions_destroy(&actions_); }
  FirstFiles(const FirstFiles&) = delete;
  FirstFiles& operator=(const FirstFiles&) = delete;
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

}  // namespace

std::string end_words(const ProcessEnd& end) {
  const int signal =
      end.signal != 0 ? end.signal : (end.status > 128 ? end.status - 128 : 0);
  if (signal > 0 && signal < NSIG)
    return fmt::format(
        "crashed (signal {}, {})", signal,
        ::sigdescr_np(signal) == nullptr ? "unknown" : ::sigdescr_np(signal));
  return fmt::format("ended with status {}", end.status);
}

std::string last_words(const std::string& text) {
  const std::size_t end = text.find_last_not_of(" \t\r\n");
  if (end == text.npos) return "";
  const std::size_t before = text.find_last_of("\r\n", end);
  const std::size_t begin = before == text.npos ? 0 : before + 1;
  const std::string_view line(text.data() + begin, end + 1 - begin);
  return "; it wrote: " + std::string(cut_text(line, kLongestLine));
}

ChildProcess::ChildProcess(const ProcessStart& start) try {
  Pipe in = make_pipe(), out = make_pipe(), error = make_pipe();
  Pipe life = make_pipe();
  const SpawnAttributes attributes;
  static_assert(kLifeDescriptor == STDERR_FILENO + 1);
  const FirstFiles files =
      start.is_kept
          ? FirstFiles{&in.reads, &out.writes, &error.writes, &life.reads}
          : FirstFiles{&in.reads, &out.writes, &error.writes};
  std::vector<char*> arguments;
  for (const std::string& word : start.words)
    arguments.push_back(const_cast<char*>(word.c_str()));
  if (start.is_kept) {
    folder_ = made_folder();
    arguments.push_back(folder_.data());
  }
  arguments.push_back(nullptr);
  slot_ = take_process_slot();
  is_keeper[slot_] = start.is_kept;
  const int failed =
      ::posix_spawnp(&id_, arguments[0], files.get(), attributes.get(),
                     arguments.data(), environ);
  if (failed == 0)
    live_groups[slot_] = id_;
  else
    free_process_slot(slot_, folder_);
  if (failed != 0)
    throw std::system_error(failed, std::generic_category(), "a process");
  input_.emplace(std::move(in.writes));
  if (start.is_kept) life_.emplace(std::move(life.writes));
  output_.emplace(std::move(out.reads));
  error_.emplace(std::move(error.reads));
  for (auto* file : {&input_, &output_, &error_}) make_nonblocking(**file);
  // So that neither side waits for the other to be scheduled; if the system
  // refuses, the pipes are as they were.
  for (auto* file : {&input_, &output_})
    ::fcntl((*file)->descriptor(), F_SETPIPE_SZ, kPipeBytes);
} catch (const std::system_error& failure) {
  throw std::runtime_error(fmt::format("cannot start {}: {}", start.words[0],
                                       failure.code().message()));
}

std::optional<ProcessEnd> ChildProcess::wait(double seconds) {
  const Stopwatch watch;
  for (;;) {
    siginfo_t about{};
    if (::waitid(P_PID, static_cast<id_t>(id_), &about,
                 WEXITED | WNOHANG | WNOWAIT) == 0 &&
        about.si_pid == id_) {
      if (about.si_code == CLD_EXITED) return ProcessEnd{about.si_status, 0};
      return ProcessEnd{0, about.si_status};
    }
    if (watch.seconds() >= seconds) return std::nullopt;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
}

void ChildProcess::kill() {
  // Both have this number as long as the process is not reaped.
  if (!killed_) end_processes(id_, life_.has_value());
  life_.reset();
  killed_ = true;
}

ChildProcess::~ChildProcess() {
  kill();
  live_groups[slot_] = kTakenSlot;
  // A keeper that foreign code has stopped or ends too slowly.
  if (is_keeper[slot_] && !wait(kPatience)) ::kill(id_, SIGKILL);
  while (::waitpid(id_, nullptr, 0) < 0 && errno == EINTR) {
  }
  free_process_slot(slot_, folder_);
}

namespace {

// After a call on a pipe has failed with errno. Throws std::system_error unless
// it may be made once more.
void require_another_try() {
  if (errno != EAGAIN && errno != EINTR)
    throw std::system_error(errno, std::generic_category(),
                            "a pipe to a process");
}

}  // namespace

bool read_available(std::optional<OpenFile>& pipe, std::string& into) {
  std::array<char, 1 << 16> bytes;
  const ssize_t n = ::read(pipe->descriptor(), bytes.data(), bytes.size());
  if (n > 0) {
    into.append(bytes.data(), static_cast<std::size_t>(n));
    return true;
  }
  if (n == 0)
    pipe.reset();
  else
    require_another_try();
  return false;
}

std::string read_until_end(OpenFile& file, double seconds, bool& in_time) {
  std::string text;
  const Stopwatch watch;
  for (;;) {
    pollfd wait{file.descriptor(), POLLIN, 0};
    const double left = seconds - watch.seconds();
    in_time = left > 0.0;
    if (!in_time) return text;
    if (::poll(&wait, 1, static_cast<int>(1e3 * left) + 1) <= 0) continue;
    std::array<char, 4096> bytes;
    const ssize_t n = ::read(file.descriptor(), bytes.data(), bytes.size());
    if (n == 0) return text;
    if (n < 0) {
      require_another_try();
      continue;
    }
    text.append(bytes.data(), static_cast<std::size_t>(n));
    if (text.size() > kLongestReading) return text;
  }
}

std::size_t write_available(std::optional<OpenFile>& pipe,
                            std::string_view bytes) {
  const ssize_t n = ::write(pipe->descriptor(), bytes.data(), bytes.size());
  if (n > 0) return static_cast<std::size_t>(n);
  if (errno == EPIPE)
    pipe.reset();
  else
    require_another_try();
  return 0;
}

void kill_child_processes() noexcept {
  for (std::size_t k = 0; k < live_groups.size(); ++k)
    if (const pid_t id = live_groups[k]; id > 0)
      end_processes(id, is_keeper[k]);
}

NoBrokenPipeSignal::NoBrokenPipeSignal() {
  sigset_t pipe;
  sigemptyset(&pipe);
  sigaddset(&pipe, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &pipe, &before_);
}

NoBrokenPipeSignal::~NoBrokenPipeSignal() {
  if (sigismember(&before_, SIGPIPE) == 0) {
    sigset_t pipe;
    sigemptyset(&pipe);
    sigaddset(&pipe, SIGPIPE);
    const timespec at_once{};
    sigtimedwait(&pipe, nullptr, &at_once);  // takes a waiting one
  }
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

}  // namespace beamgyro::internal
