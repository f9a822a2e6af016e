// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <csignal>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dataset/files/open_file.h"

namespace beamgyro::internal {

/// How a process ended.
struct ProcessEnd {
  int status = 0;  // of exit
  int signal = 0;  // that ended it, or 0
};

/// Returns the words for it, such as "crashed (signal 11, Segmentation fault)".
/// A status above 128 is the signal that a shell reports.
std::string end_words(const ProcessEnd& end);

/// Returns the last line that a process wrote on standard error as "; it wrote:
/// LINE", or nothing.
std::string last_words(const std::string& text);

/// How a process is started.
struct ProcessStart {
  std::vector<std::string> words;  // a path or a name to be found in PATH first
  // By a keeper (process_keeper.h): the process has a folder of its own, whose
  // path is the last word, and a pipe at kLifeDescriptor.
  bool is_kept = false;
};

/// A process with pipes to its standard input, output and error. It is the
/// leader of a process group of its own, so that Ctrl-C on a terminal does not
/// reach it; whoever handles signals calls kill_child_processes(). No other
/// descriptor is open in it.
class ChildProcess {
 public:
  /// Starts a process. A kept one gets a new and empty folder, below that for
  /// temporary files. Throws std::runtime_error when that fails.
  explicit ChildProcess(const ProcessStart& start);

  /// Kills the processes if that was not done, reaps the first one, and removes
  /// its folder.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  // Our ends. They do not block.
  std::optional<OpenFile>& input() { return input_; }
  std::optional<OpenFile>& output() { return output_; }
  std::optional<OpenFile>& error() { return error_; }

  /// Returns how the process ended if it ends within `seconds`.
  std::optional<ProcessEnd> wait(double seconds);

  /// Kills all processes that it started when it is kept, and otherwise those
  /// of its group.
  void kill();

 private:
  std::optional<OpenFile> input_, output_, error_;
  std::optional<OpenFile> life_;  // of a kept one; closed, it ends
  pid_t id_ = 0;
  std::size_t slot_ = 0;  // in the table of processes
  std::string folder_;    // or empty
  bool killed_ = false;
};

// The three functions below try again after a signal, and throw
// std::system_error where a pipe fails otherwise.

/// Appends to `into` what a pipe of a child holds and closes it at its end.
/// Returns whether there was something.
bool read_available(std::optional<OpenFile>& pipe, std::string& into);

/// The longest text that is read to its end [bytes].
inline constexpr std::size_t kLongestReading = std::size_t{1} << 25;

/// Returns what a pipe of a child gives until its end or for `seconds`, and
/// whether it ended in that time. Reads no more once it is longer than
/// kLongestReading.
std::string read_until_end(OpenFile& file, double seconds, bool& in_time);

/// Writes as much of `bytes` as the pipe to a child takes and closes it when
/// the child no longer reads. Returns how many it took. Call within a
/// NoBrokenPipeSignal.
std::size_t write_available(std::optional<OpenFile>& pipe,
                            std::string_view bytes);

/// Kills all ChildProcess and what they started. May be called from a signal
/// handler that ends this process.
void kill_child_processes() noexcept;

/// Keeps SIGPIPE from this thread: a write to a process that ended fails with
/// EPIPE.
class NoBrokenPipeSignal {
 public:
  NoBrokenPipeSignal();
  ~NoBrokenPipeSignal();
  NoBrokenPipeSignal(const NoBrokenPipeSignal&) = delete;
  NoBrokenPipeSignal& operator=(const NoBrokenPipeSignal&) = delete;

 private:
  sigset_t before_;
};

}  // namespace beamgyro::internal
