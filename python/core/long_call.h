// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <future>
#include <memory>
#include <thread>
#include <type_traits>
#include <utility>

#include "include/beamgyro/progress.h"

namespace beamgyro::python {

namespace py = pybind11;

/// Time between two looks at the signals of Python.
constexpr std::chrono::milliseconds kSignalPeriod{50};

/// How long work that was stopped may take to end before it is left to end by
/// itself.
constexpr std::chrono::milliseconds kPatience{100};

/// Counts the threads that long_call() left, until they end.
class LeftWork {
 public:
  LeftWork() { ++count(); }
  ~LeftWork() { --count(); }
  LeftWork(const LeftWork&) = delete;
  LeftWork& operator=(const LeftWork&) = delete;

  /// Waits for all of them, but no longer than `most`.
  static void wait(std::chrono::milliseconds most) {
    const auto end = std::chrono::steady_clock::now() + most;
    while (count() > 0 && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(std::chrono::milliseconds{5});
  }

 private:
  static std::atomic<int>& count() {
    static std::atomic<int> number{0};
    return number;
  }
};

/// How far work is, seen by the thread that waits for it.
struct SharedProgress {
  std::atomic<double> share{0.0};
  std::atomic<bool> is_stopped{false};
};

/// Tells the Python function `on_progress`, unless it is None, the share of the
/// work, and runs the handlers of signals that have come (Ctrl-C). Throws
/// py::error_already_set for an exception of either.
inline void look_at_python(const py::object& on_progress, double share) {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (!on_progress.is_none()) on_progress(share);
}

/// Calls `on_progress` with 0 when work begins, with numbers that do not fall,
/// and with 1 when it is done.
class ReportedProgress {
 public:
  explicit ReportedProgress(const py::object& on_progress)
      : on_progress_(on_progress) {
    look_at_python(on_progress_, reported_);
  }

  void report(double share) {
    if (share > reported_) reported_ = std::min(share, 1.0);
    look_at_python(on_progress_, reported_);
  }

  void report_end() {
    if (reported_ < 1.0) report(1.0);
  }

 private:
  const py::object& on_progress_;
  double reported_ = 0.0;
};

/// Returns work(progress), which runs in a thread of its own without the GIL;
/// the thread of the caller looks at Python meanwhile. What look_at_python()
/// throws stops the work and reaches the caller at once; work that looks at its
/// progress too seldom ends later, in the background. `work` therefore must own
/// everything that it uses, and hold no Python object but by gil_owned().
template <class Work>
auto long_call(const py::object& on_progress, Work work) {
  using Result = std::invoke_result_t<Work, const Progress&>;
  ReportedProgress reported(on_progress);
  const auto state = std::make_shared<SharedProgress>();
  std::packaged_task<Result()> task(
      [state, work = std::move(work)]() mutable -> Result {
        const Progress progress = [&state](double done) {
          state->share = done;
          return !state->is_stopped;
        };
        return work(progress);
      });
  std::future<Result> result = task.get_future();
  std::exception_ptr raised;
  {
    const py::gil_scoped_release released;
    auto left = std::make_unique<LeftWork>();
    std::thread thread(
        [left = std::move(left), own = std::move(task)]() mutable {
          own();
          own = {};  // before it counts as ended
        });
    while (!raised &&
           result.wait_for(kSignalPeriod) != std::future_status::ready) {
      const py::gil_scoped_acquire acquired;
      try {
        reported.report(state->share);
      } catch (const py::error_already_set&) {
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
