// SPDX-License-Identifier: MIT
#include "validation/external/plugin_host.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>

#include "dataset/files/open_file.h"
#include "include/beamgyro/plugin.h"
#include "validation/external/landlock.h"
#include "validation/external/process_keeper.h"
#include "validation/external/program_search.h"
#include "validation/external/refused_calls.h"

namespace beamgyro::internal {
namespace {

constexpr std::size_t kBatchBytes = 1 << 16;
constexpr std::size_t kAnswerBatch = 64;  // lost at most when the library hangs
constexpr std::string_view kOutOfMemory = "out of memory\n";
constexpr std::size_t kMostOfTraining = std::size_t{1} << 24;  // characters

// Answers that are not written yet, where the handler of a crash finds them.
struct PendingAnswers {
  int descriptor = -1;
  volatile std::size_t count = 0;
  std::array<double, kAnswerBatch> values{};
} pending;

void write_pending() noexcept {
  const auto* bytes = reinterpret_cast<const char*>(pending.values.data());
  const std::size_t size = pending.count * sizeof(double);
  for (std::size_t done = 0; done < size;) {
    const ssize_t n = ::write(pending.descriptor, bytes + done, size - done);
    if (n < 0 && errno != EINTR) break;
    if (n > 0) done += static_cast<std::size_t>(n);
  }
  pending.count = 0;
}

void write_error(std::string_view text) noexcept {
  static_cast<void>(!::write(STDERR_FILENO, text.data(), text.size()));
}

// A pointer from a failed malloc() that is used crashes with errno as malloc()
// left it.
extern "C" {
static void report_crash(int signal) {
  const bool no_memory = errno == ENOMEM;
  write_pending();
  if (no_memory) write_error(kOutOfMemory);
  std::signal(signal, SIG_DFL);
  raise(signal);
}
}

void handle_crashes() {
  static std::array<std::byte, 1 << 16> stack;  // also for an endless recursion
  stack_t alternate{};
  alternate.ss_sp = stack.data();
  alternate.ss_size = stack.size();
  ::sigaltstack(&alternate, nullptr);
  struct sigaction action {};
  action.sa_handler = report_crash;
  action.sa_flags = SA_ONSTACK | SA_NODEFER;
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT})
    ::sigaction(signal, &action, nullptr);
}

struct Plugin {
  decltype(&beamgyro_plugin_signals) signals;
  decltype(&beamgyro_plugin_create) create;
  decltype(&beamgyro_plugin_reset) reset;
  decltype(&beamgyro_plugin_step) step;
  decltype(&beamgyro_plugin_destroy) destroy;
  decltype(&beamgyro_plugin_training) training;  // null: has none
};

template <class Function>
Function function_of(void* library, const char* name) {
  void* found = ::dlsym(library, name);
  if (found == nullptr)
    throw std::invalid_argument(fmt::format(
        "has no function {}(); expected those of beamgyro/plugin.h", name));
  return reinterpret_cast<Function>(found);
}

Plugin load_plugin(const std::filesystem::path& file) {
  void* library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    std::string why = ::dlerror();  // "FILE: why"
    if (why.starts_with(file.string() + ": "))
      why = why.substr(file.string().size() + 2);
    throw std::invalid_argument("cannot be loaded: " + why);
  }
  const auto version = function_of<decltype(&beamgyro_plugin_abi)>(
      library, "beamgyro_plugin_abi")();
  if (version != BEAMGYRO_PLUGIN_ABI)
    throw std::invalid_argument(
        fmt::format("is made for version {} of beamgyro/plugin.h; expected {}",
                    version, BEAMGYRO_PLUGIN_ABI));
  Plugin plugin{};
  plugin.signals =
      function_of<decltype(plugin.signals)>(library, "beamgyro_plugin_signals");
  plugin.create =
      function_of<decltype(plugin.create)>(library, "beamgyro_plugin_create");
  plugin.reset =
      function_of<decltype(plugin.reset)>(library, "beamgyro_plugin_reset");
  plugin.step =
      function_of<decltype(plugin.step)>(library, "beamgyro_plugin_step");
  plugin.destroy =
      function_of<decltype(plugin.destroy)>(library, "beamgyro_plugin_destroy");
  plugin.training = reinterpret_cast<decltype(plugin.training)>(
      ::dlsym(library, "beamgyro_plugin_training"));
  return plugin;
}

std::string signals_of(const Plugin& plugin) {
  const char* names = plugin.signals();
  if (names == nullptr)
    throw std::invalid_argument("beamgyro_plugin_signals() returned no names");
  return names;
}

// Returns "\nTEXT", or nothing for a library that states no training.
std::string training_of(const Plugin& plugin) {
  if (plugin.training == nullptr) return "";
  const char* const* piece = plugin.training();
  if (piece == nullptr) return "";
  std::string text = "\n";
  for (; *piece != nullptr; ++piece) {
    text += *piece;
    if (text.size() > kMostOfTraining)
      throw std::invalid_argument(fmt::format(
          "beamgyro_plugin_training() returned more than {} characters",
          kMostOfTraining));
  }
  return text;
}

void limit_resource(decltype(RLIMIT_AS) kind, rlim_t most) {
  const rlimit both{most, most};
  ::setrlimit(kind, &both);
}

// The memory that this program has anyway [bytes].
std::size_t memory_in_use() {
  std::array<std::byte, 64> text{};
  const std::size_t count = OpenFile("/proc/self/statm", O_RDONLY).read(text);
  std::size_t pages = 0;
  const auto* first = reinterpret_cast<const char*>(text.data());
  std::from_chars(first, first + count, pages);
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

void reset(const Plugin& plugin, void* instance, double period) {
  if (const int status = plugin.reset(instance, period); status != 0)
    throw std::runtime_error(fmt::format(
        "beamgyro_plugin_reset() returned {} for a period of {:.6g} s", status,
        period));
}

void answer_record(const Plugin& plugin, void* instance,
                   std::span<const double> record) {
  if (record[0] != static_cast<double>(HostRecord::kStep)) {
    reset(plugin, instance, record[1]);
    return;
  }
  const double rate = plugin.step(instance, record[1], record.data() + 2);
  pending.values[pending.count] = rate;
  pending.count = pending.count + 1;
  if (pending.count == kAnswerBatch) write_pending();
}

void answer_records(const Plugin& plugin, OpenFile& input) {
  const std::string names = signals_of(plugin);
  const std::size_t width =
      3 + static_cast<std::size_t>(std::ranges::count(names, ','));
  errno = 0;
  void* instance = plugin.create();
  if (instance == nullptr) {
    if (errno == ENOMEM) throw std::bad_alloc();
    throw std::runtime_error("beamgyro_plugin_create() returned no instance");
  }
  // Also when a sample or a reset is refused.
  const std::unique_ptr<void, decltype(plugin.destroy)> owner(instance,
                                                              plugin.destroy);
  // The library sees one sample at a time, and nothing of the next.
  std::vector<double> record(width);
  const std::size_t size = width * sizeof(double);
  std::vector<std::byte> batch(std::max(kBatchBytes, size));
  for (std::size_t held = 0;;) {
    const ssize_t n =
        ::read(input.descriptor(), batch.data() + held, batch.size() - held);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    held += static_cast<std::size_t>(n);
    std::size_t used = 0;
    for (; held - used >= size; used += size) {
      std::memcpy(record.data(), batch.data() + used, size);
      errno = 0;
      answer_record(plugin, instance, record);
    }
    std::memmove(batch.data(), batch.data() + used, held - used);
    held -= used;
    write_pending();
  }
}

// Takes over standard input and output: what the library prints goes to
// standard error.
OpenFile take_over(int standard, int replacement) {
  OpenFile file(::fcntl(standard, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
  ::dup2(replacement, standard);
  return file;
}

void serve(const std::filesystem::path& file, bool describe) {
  const OpenFile nothing("/dev/null", O_RDONLY);
  OpenFile input = take_over(STDIN_FILENO, nothing.descriptor());
  OpenFile output = take_over(STDOUT_FILENO, STDERR_FILENO);
  pending.descriptor = output.descriptor();
  handle_crashes();
  const Plugin plugin = load_plugin(file);
  if (!describe) return answer_records(plugin, input);
  const std::string text =
      signals_of(plugin) + training_of(plugin) + kEndOfDescription;
  output.write(std::as_bytes(std::span(text)));
}

// What the words of a host ask for.
struct HostedWork {
  HostTask task;
  std::size_t memory;
  int landlock;
  std::string target;
  std::vector<std::filesystem::path> readable;
  std::filesystem::path folder;
};

HostedWork parsed_work(const std::vector<std::string>& words) {
  constexpr std::size_t kFirstReadable = 4;
  const auto is_number = [](const std::string& word) {
    return !word.empty() && std::ranges::all_of(word, [](char c) {
      return c >= '0' && c <= '9';
    });
  };
  if (words.size() <= kFirstReadable || !is_number(words[0]) ||
      !is_number(words[1]) || !is_number(words[2]))
    throw std::invalid_argument("is started by beamgyro itself only");
  return {static_cast<HostTask>(std::stoi(words[0])),
          std::stoull(words[1]),
          std::stoi(words[2]),
          words[3],
          {words.begin() + kFirstReadable, words.end() - 1},
          words.back()};
}

void isolate_process(const HostedWork& work) {
  if (work.landlock == 0) return;
  restrict_files(work.readable, work.folder, work.landlock);
  refuse_calls();
}

int try_isolation_of(const HostedWork& work, const std::string& search_path) {
  const ProgramSearch search(work.target, search_path);
  isolate_process(work);
  const std::optional<UnreachableProgram> lost = search.unreachable();
  if (!lost) return 0;
  write_error(lost->file.string() + '\n' + lost->plugin_files.string());
  return kProgramOutOfReach;
}

void become_command(const HostedWork& work) {
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_DFL);
  if (work.memory > 0) limit_resource(RLIMIT_AS, work.memory);
  ::execl("/bin/sh", "/bin/sh", "-c", work.target.c_str(), nullptr);
  throw std::runtime_error(std::string("/bin/sh: ") + std::strerror(errno));
}

int hosted(const HostedWork& work, const std::string& search_path) {
  limit_resource(RLIMIT_CORE, 0);
  if (work.task == HostTask::kTry) return try_isolation_of(work, search_path);
  const std::size_t memory = memory_in_use();
  isolate_process(work);
  if (work.task == HostTask::kCommand) become_command(work);
  if (work.memory > 0) limit_resource(RLIMIT_AS, work.memory + memory);
  serve(work.target, work.task == HostTask::kDescribe);
  return 0;
}

}  // namespace

ProcessStart host_start(const ProcessLimits& limits, const Isolation& isolation,
                        HostTask task, const std::string& target) {
  ProcessStart start{
      {limits.program.string(), std::string(kPluginHostWord),
       std::to_string(static_cast<int>(task)), std::to_string(limits.memory),
       std::to_string(isolation.landlock), target},
      true};
  if (isolation.landlock > 0)
    for (const std::filesystem::path& path : isolation.readable)
      start.words.push_back(path.string());
  return start;
}

int host_plugin(const std::vector<std::string>& words,
                const std::string& search_path) try {
  const HostedWork work = parsed_work(words);
  const std::size_t together =
      work.memory > 0 ? work.memory + memory_in_use() : 0;
  if (const auto status = keep_child(together, work.folder)) return *status;
  ::setenv("HOME", work.folder.c_str(), 1);
  ::setenv("TMPDIR", work.folder.c_str(), 1);
  return hosted(work, search_path);
} catch (const std::bad_alloc&) {
  write_pending();
  write_error(kOutOfMemory);
  return 1;
} catch (const std::invalid_argument& error) {
  write_error(error.what());
  return 2;
} catch (const std::exception& error) {
  write_pending();
  write_error(error.what());
  return 1;
}

}  // namespace beamgyro::internal
