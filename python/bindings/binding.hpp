// What the bindings of all topics share: JSON as Python's own values, work without Python's lock,
// and errors with every problem.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>

#include "tethercalc/report/figure.hpp"

namespace tethercalc::python {

namespace py = pybind11;

/// Objects, lists, texts, numbers and truth values as Python's own; null is None.
[[nodiscard]] py::object to_python(const nlohmann::ordered_json& json);

/// The same backwards, tuples as lists. Throws TypeError for what JSON does not know.
[[nodiscard]] nlohmann::ordered_json to_json(py::handle value);

/// Keeps a thread whose answer nobody waits for any more until it ends: no code of this module may
/// run once the interpreter is gone.
void leave_running(std::thread thread);

/// Waits for those threads, at the interpreter's end.
void join_left_running();

/// Whether the work that it was given to is still wanted.
using StopFlag = std::shared_ptr<std::atomic<bool>>;

/// Calls `work(stop)` on a thread of its own while other Python threads run. Where a signal's
/// handler raises meanwhile, as Ctrl-C does, that exception is thrown at once; `stop` is set, and
/// what the work still does is lost. So `work` must own all that it uses.
template <class Work>
auto interruptible(Work work) {
  using Result = decltype(work(StopFlag()));
  const StopFlag stop = std::make_shared<std::atomic<bool>>(false);
  std::packaged_task<Result()> task([work = std::move(work), stop] { return work(stop); });
  std::future<Result> result = task.get_future();
  std::thread thread(std::move(task));
  constexpr std::chrono::milliseconds between_looks{20};
  for (;;) {
    {
      const py::gil_scoped_release released;
      if (result.wait_for(between_looks) == std::future_status::ready) break;
    }
    if (PyErr_CheckSignals() != 0) {
      *stop = true;
      leave_running(std::move(thread));
      throw py::error_already_set();
    }
  }
  thread.join();
  return result.get();
}

/// A picture, drawn when asked for.
void bind_figures(py::module_& module);
void bind_designs(py::module_& module);
void bind_optima(py::module_& module);
void bind_sweeps(py::module_& module);
void bind_cables(py::module_& module);
void bind_logs(py::module_& module);

}  // namespace tethercalc::python
