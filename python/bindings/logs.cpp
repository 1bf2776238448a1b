// Logs as arrays, and what they say of the drag and of the simulation.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <fmt/format.h>

#include <memory>

#include "bindings/answer.hpp"
#include "bindings/design_object.hpp"
#include "files/log_file.hpp"
#include "files/logs_in_files.hpp"
#include "io/log_questions.hpp"
#include "report/told_diagnosis.hpp"
#include "tethercalc/files/effect_file.hpp"
#include "tethercalc/io/log_summary.hpp"
#include "tethercalc/report/drag_report.hpp"
#include "tethercalc/report/log_report.hpp"
#include "tethercalc/report/result_figures.hpp"

namespace tethercalc::python {
namespace {

using Texts = std::vector<std::string>;

/// An array over the numbers, which it keeps.
py::array_t<double> array_of(std::vector<double> numbers) {
  auto kept = std::make_unique<std::vector<double>>(std::move(numbers));
  const auto size = static_cast<py::ssize_t>(kept->size());
  const double* const first = kept->data();
  const py::capsule owner(kept.release(),
                          [](void* gone) { delete static_cast<std::vector<double>*>(gone); });
  return py::array_t<double>(size, first, owner);
}

/// A log with the bytes that it is read from.
struct OpenLog {
  explicit OpenLog(const std::string& path) : file(path), log(file.bytes(), path) {}
  LogFile file;
  AutopilotLog log;
};

class Log {
 public:
  explicit Log(std::shared_ptr<const OpenLog> open)
      : open_(std::move(open)), summary_(summarize_log(log())) {}

  [[nodiscard]] const AutopilotLog& log() const { return open_->log; }

  [[nodiscard]] Answer answer() const {
    return {[this] { return log_text(summary_, log().name(), {}); },
            [this] { return log_json(summary_, log().name()); },
            [this] { return log_csv(summary_); }};
  }

  /// Numbers as arrays, texts as lists, by the fields' names; with `time_s` where there is one.
  [[nodiscard]] py::dict message(const std::string& name, std::optional<int> instance) const {
    const LogMessageType* const type = log().contents().find(name);
    if (type == nullptr) {
      messages_csv(log(), name, [](std::string_view) {});  // tells the closest one
      throw py::key_error(name);
    }
    Texts fields;
    for (const LogField& field : type->fields) {
      if (field.is_number()) fields.push_back(field.name);
    }
    py::dict out;
    LogSeries series = log().series(name, fields, instance);
    if (!series.time.empty()) {
      out["time_s"] = array_of(std::move(series.time));
    } else {
      series.columns = log().columns(name, fields, instance);
    }
    for (std::size_t i = 0; i < fields.size(); ++i) {
      out[py::str(fields[i])] = array_of(std::move(series.columns[i]));
    }
    return out;
  }

  /// A text field of every message of that name.
  [[nodiscard]] Texts texts(const std::string& name, const std::string& field) const {
    Texts out;
    log().for_each([&](const LogMessageType& type, const std::byte* message) {
      if (type.name != name) return;
      if (const LogField* found = type.find(field)) out.push_back(field_text(message, *found));
    });
    return out;
  }

  [[nodiscard]] Texts names() const {
    Texts out;
    for (const LogSummary::Message& message : summary_.types) {
      const std::string& name = message.name;
      if (std::ranges::find(out, name) == out.end()) out.push_back(name);
    }
    return out;
  }

 private:
  std::shared_ptr<const OpenLog> open_;
  LogSummary summary_;
};

Log read_log(const py::object& path) {
  const auto name = py::module_::import("os").attr("fspath")(path).cast<std::string>();
  return Log(interruptible([=](const StopFlag&) { return std::make_shared<const OpenLog>(name); }));
}

/// What the command says on standard error, as Python's warnings where the package was called.
void warn(const std::vector<Warning>& notes) {
  for (const Warning& note : notes) {
    const auto told = py::module_::import("tethercalc._errors").attr("in_arguments")(note.sentence);
    if (PyErr_WarnEx(PyExc_UserWarning, told.cast<std::string>().c_str(), 2) != 0) {
      throw py::error_already_set();
    }
  }
}

Answer drag(const Texts& logs, const FlightOptions& flight) {
  const auto learned = std::make_shared<const LearnedDrag>(
      interruptible([=](const StopFlag&) { return learned_drag(logs, flight, logs_in_files()); }));
  warn(learned->notes);
  return {[=] { return drag_text(learned->study.identified, {}); },
          [=] { return drag_json(learned->study.identified, learned->notes); },
          [=] { return drag_csv(learned->study.identified); },
          {{"speed", [=] { return drag_figure(learned->study); }},
           {"surface", [=] { return drag_surface_figure(learned->study); }}}};
}

ToldDiagnosis diagnosed(const DesignFile& file, const LogsAsked& asked, const Texts& effect_files,
                        const StopFlag& stop) {
  struct Unwanted {};
  const AskedDiagnosis question =
      diagnosis_question(asked, file.design, read_effect_files(effect_files), logs_in_files());
  return told_diagnosis(studied_diagnosis(question, asked,
                                          [&](const std::string&) {
                                            if (*stop) throw Unwanted();
                                          }),
                        file);
}

Answer diagnosis_answer(const std::shared_ptr<const ToldDiagnosis>& told,
                        const std::string& flight_name, const std::string& power_name) {
  Answer answer{[=] { return told_text(*told, {}); }, [=] { return told_json(*told); },
                [=] { return told_csv(*told); }};
  const auto draw = [&](const std::string& name, const std::string& log,
                        const std::optional<Diagnosis>& one) {
    if (!one || one->compared.empty()) return;
    answer.figures.push_back({name, [told, log, &one] { return diagnosis_figure(log, *one); }});
  };
  draw("flight", flight_name, told->flight);
  draw("power", power_name, told->power);
  return answer;
}

Answer diagnose(const py::object& spec, const Texts& flight_logs, const Texts& power_logs,
                const Texts& whole_logs, const Texts& base, const Texts& effect_files,
                const Texts& batteries, bool free_flight, const FlightOptions& flight) {
  const auto file = design_of(spec)->file();
  const LogsAsked asked =
      with_halves({flight_logs, power_logs, whole_logs, batteries, free_flight, base, flight});
  const auto told = std::make_shared<const ToldDiagnosis>(interruptible(
      [=](const StopFlag& stop) { return diagnosed(*file, asked, effect_files, stop); }));
  return diagnosis_answer(told, heading_of(asked.flight_logs), heading_of(asked.power_logs));
}

}  // namespace

void bind_logs(py::module_& module) {
  py::class_<Log> log(module, "Log",
                      "An autopilot's log. log[\"XKF1\"] has the numbers of all its messages of "
                      "that name as arrays.");
  add_answer_methods(log);
  log.def_property_readonly("messages", &Log::names, "The names of its messages.")
      .def_property_readonly(
          "parameters", [](const Log& l) { return l.log().contents().parameters; },
          "The autopilot's parameters at the log's beginning.")
      .def(
          "instances", [](const Log& l, const std::string& m) { return l.log().instances(m); },
          py::arg("message"), "Which sensors or estimators wrote messages of that name.")
      .def("message", &Log::message, py::arg("name"), py::arg("instance") = py::none(),
           "The numbers of all messages of that name, or of one instance of it: an array a field, "
           "and \"time_s\" since the controller started.")
      .def("__getitem__", [](const Log& l, const std::string& name) { return l.message(name, {}); })
      .def("__contains__",
           [](const Log& l, const std::string& name) { return l.log().contents().count(name) > 0; })
      .def("__repr__",
           [](const Log& l) {
             return fmt::format("<tethercalc.Log of {} messages>", l.log().contents().messages);
           })
      .def("texts", &Log::texts, py::arg("message"), py::arg("field"),
           "A field of all messages of that name as texts.");
  module.def("read_log", read_log, py::arg("path"),
             "Reads an autopilot's log: ArduPilot's DataFlash or PX4's ULog, compressed or not.");
  using Number = std::optional<double>;
  using Text = const std::string&;
  // In the order of its fields.
  py::class_<FlightOptions>(module, "_Flight")
      .def(py::init<int, Text, Text, Text, Number, Number, Number, Number, Number, bool, Texts>(),
           py::arg("core"), py::arg("start"), py::arg("end"), py::arg("trim_log"),
           py::arg("pitch_offset_deg"), py::arg("mass_g"), py::arg("air_density_kg_m3"),
           py::arg("pressure_hPa"), py::arg("temperature_C"), py::arg("published_kinematics"),
           py::arg("columns"));
  module.def("_drag", drag, py::arg("logs"), py::arg("flown"));
  module.def("_diagnose", diagnose, py::arg("spec"), py::arg("flight"), py::arg("power"),
             py::arg("log"), py::arg("base"), py::arg("effects"), py::arg("batteries"),
             py::arg("free_flight"), py::arg("flown"));
}

}  // namespace tethercalc::python
