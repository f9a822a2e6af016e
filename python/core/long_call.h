// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <future>
#include <memory>
#include <stdexcept>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "include/beamgyro/progress.h"

namespace beamgyro::python {

namespace py = pybind11;

/// Marks a compensator of Python as asked for an answer by this thread, and by
/// the threads of long_call() that work for it meanwhile.
class Asked {
 public:
  using Compensators = std::vector<const void*>;  // outer ones first

  explicit Asked(const void* compensator) { here().push_back(compensator); }
  ~Asked() { here().pop_back(); }
  Asked(const Asked&) = delete;
  Asked& operator=(const Asked&) = delete;

  /// Those that wait for this thread.
  static const Compensators& all() { return here(); }
  /// Begins a thread that works for those compensators.
  static void inherit(Compensators all) { here() = std::move(all); }

 private:
  static Compensators& here() {
    static thread_local Compensators all;
    return all;
  }
};

/// Time between two looks at the signals of Python.
constexpr std::chrono::milliseconds kSignalPeriod{50};

/// How long work that was stopped may take to end before it is left to end by
/// itself.
constexpr std::chrono::milliseconds kPatience{100};

/// Counts long_call()s and their threads, until they end.
class RunningWork {
 public:
  RunningWork() { ++count(); }
  ~RunningWork() { --count(); }
  RunningWork(const RunningWork&) = delete;
  RunningWork& operator=(const RunningWork&) = delete;

  /// Asks all of them to end, now and in future.
  static void stop() { stopped() = true; }
  static bool is_stopped() { return stopped(); }
  /// Whether there is any in this process. A child has the count of its parent
  /// and none of its threads.
  static bool is_any() { return count() > 0 && getpid() == kProcess; }

 private:
  inline static const pid_t kProcess = getpid();

  static std::atomic<int>& count() {
    static std::atomic<int> number{0};
    return number;
  }
  static std::atomic<bool>& stopped() {
    static std::atomic<bool> flag{false};
    return flag;
  }
};

/// Ends what still runs when Python does, which destroys what threads of ours
/// use. Waits for work that cannot be stopped, such as a function of the user;
/// a signal during that time (Ctrl-C) ends the process with status 130.
inline void end_running_work() {
  RunningWork::stop();
  while (RunningWork::is_any()) {
    {
      const py::gil_scoped_release released;
      std::this_thread::sleep_for(std::chrono::milliseconds{5});
    }
    if (PyErr_CheckSignals() == 0) continue;
    PyErr_Clear();
    try {
      py::module_::import("sys").attr("stdout").attr("flush")();
    } catch (const py::error_already_set&) {  // nobody reads it any more
    }
    std::_Exit(130);
  }
}

/// How far work is, seen by the thread that waits for it.
struct SharedProgress {
  std::atomic<double> share{0.0};
  std::atomic<bool> is_stopped{false};
};

/// Tells the Python function `on_progress`, unless it is None, the share of the
/// work, and runs the handlers of signals that have come (Ctrl-C). Returns
/// whether to go on: not where the function returned False. Throws
/// py::error_already_set for an exception of either.
inline bool look_at_python(const py::object& on_progress, double share) {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  return on_progress.is_none() || on_progress(share).ptr() != Py_False;
}

/// Calls `on_progress` with 0 when work begins, with numbers that do not fall,
/// and with 1 when it is done. Throws Cancelled where it returns False before.
class ReportedProgress {
 public:
  explicit ReportedProgress(const py::object& on_progress)
      : on_progress_(on_progress) {
    if (!look_at_python(on_progress_, reported_)) throw Cancelled();
  }

  void report(double share) {
    if (share > reported_) reported_ = std::min(share, 1.0);
    if (!look_at_python(on_progress_, reported_)) throw Cancelled();
  }

  /// Nothing is left to be stopped.
  void report_end() {
    if (reported_ < 1.0) look_at_python(on_progress_, 1.0);
  }

 private:
  const py::object& on_progress_;
  double reported_ = 0.0;
};

/// Returns work(progress), which runs in a thread of its own without the GIL;
/// the thread of the caller looks at Python meanwhile. What ReportedProgress
/// throws stops the work and reaches the caller at once; work that looks at its
/// progress too seldom ends later, in the background. `work` therefore must own
/// everything that it uses, and hold no Python object but by gil_owned().
template <class Work>
auto long_call(const py::object& on_progress, Work work) {
  using Result = std::invoke_result_t<Work, const Progress&>;
  const RunningWork here;
  if (RunningWork::is_stopped())
    throw std::runtime_error("Python is ending; no work begins any more");
  ReportedProgress reported(on_progress);
  const auto state = std::make_shared<SharedProgress>();
  std::packaged_task<Result()> task(
      [state, work = std::move(work)]() mutable -> Result {
        const Progress progress = [&state](double done) {
          state->share = done;
          return !state->is_stopped && !RunningWork::is_stopped();
        };
        return work(progress);
      });
  std::future<Result> result = task.get_future();
  std::exception_ptr raised;
  {
    const py::gil_scoped_release released;
    auto running = std::make_unique<RunningWork>();
    std::thread thread([running = std::move(running), own = std::move(task),
                        asked = Asked::all()]() mutable {
      Asked::inherit(std::move(asked));
      own();
      own = {};  // before it counts as ended
    });
    while (!raised &&
           result.wait_for(kSignalPeriod) != std::future_status::ready) {
      const py::gil_scoped_acquire acquired;
      try {
        reported.report(state->share);
      } catch (...) {  // of Python, or Cancelled
        raised = std::current_exception();
        state->is_stopped = true;
      }
    }
    if (raised && result.wait_for(kPatience) != std::future_status::ready)
      thread.detach();
    else
      thread.join();
  }
  if (raised) std::rethrow_exception(raised);
  Result found = result.get();
  reported.report_end();
  return found;
}

/// Returns an owner of a Python object that any thread may destroy.
inline std::shared_ptr<py::object> gil_owned(py::object object) {
  return {new py::object(std::move(object)), [](py::object* owned) {
            const py::gil_scoped_acquire acquired;
            delete owned;
          }};
}

}  // namespace beamgyro::python
