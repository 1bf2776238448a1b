// Logs as arrays, and what they say of the drag and of the simulation.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>

#include "bindings/answer.hpp"
#include "bindings/design_object.hpp"
#include "files/log_file.hpp"
#include "io/log_options.hpp"
#include "tethercalc/files/effect_file.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/log_summary.hpp"
#include "tethercalc/io/spec_writer.hpp"
#include "tethercalc/report/design_report.hpp"
#include "tethercalc/report/diagnosis_report.hpp"
#include "tethercalc/report/drag_report.hpp"
#include "tethercalc/report/log_report.hpp"
#include "tethercalc/report/result_figures.hpp"
#include "tethercalc/study/diagnosis.hpp"

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

/// The number where a field of a spec holds it, in SI; throws where it is out of that field's
/// range.
double as_field(const char* path, const char* argument, double value) {
  Design design;
  const SpecField& field = *find_field(path);
  try {
    set_field(design, field, value);
  } catch (const std::invalid_argument& error) {
    throw InputError(argument, error.what());
  }
  return *field_value_si(design, field);
}

std::optional<double> flown_mass(std::optional<double> mass_g) {
  return mass_g ? std::optional(as_field("drone.mass_g", "mass_g", *mass_g)) : std::nullopt;
}

std::optional<double> flown_air(std::optional<double> density) {
  constexpr const char* path = "flight.air_density_kg_m3";
  return density ? std::optional(as_field(path, "air_density_kg_m3", *density)) : std::nullopt;
}

std::string heading(const Texts& logs) {
  return logs.size() == 1 ? std::filesystem::path(logs.front()).filename().string()
                          : fmt::format("{} flights", logs.size());
}

Answer drag(const Texts& logs, double mass_g, std::optional<double> air_density,
            double pitch_offset_deg, const std::string& from, const std::string& to, int core,
            bool published_kinematics) {
  DragIdentificationOptions how;
  how.conditions.mass = *flown_mass(mass_g);
  if (const auto air = flown_air(air_density)) how.conditions.air_density = *air;
  how.pitch_offset = pitch_offset_deg * unit::degree;
  how.from = log_position("--from", from);
  how.to = log_position("--to", to);
  if (published_kinematics) how.kinematics = Kinematics::published;
  const auto study = std::make_shared<const DragStudy>(interruptible([=](const StopFlag&) {
    std::vector<FlightLog> flights;
    for (const std::string& log : logs) flights.push_back(read_flight_log(log, {core}).log);
    try {
      return study_drag(heading(logs), flights, how);
    } catch (const UnsuitableFlight& error) {
      throw InputError(fmt::format("{}", fmt::join(logs, ", ")), error.what());
    }
  }));
  return {[=] { return drag_text(study->identified, {}); },
          [=] { return drag_json(study->identified); },
          [=] { return drag_csv(study->identified); },
          {{"speed", [=] { return drag_figure(*study); }},
           {"surface", [=] { return drag_surface_figure(*study); }}}};
}

/// What a diagnosis is asked, in Python's words.
struct DiagnosisArguments {
  Texts flight_logs;
  std::string power_log;
  std::string whole_log;  ///< both halves in one
  Texts base;
  Texts effect_files;
  std::vector<int> batteries;
  bool free_flight = false;
  std::optional<double> mass;         ///< kg
  std::optional<double> air_density;  ///< kg/m³
  double pitch_offset = 0;            ///< rad
  std::optional<LogPosition> from;
  std::optional<LogPosition> to;
  int core = 0;
};

/// A diagnosis, the notes of the readers, and the extended spec.
struct Told {
  DiagnosisStudy study;
  nlohmann::ordered_json spec;
};

LoggedFlight read_flights(const DiagnosisArguments& asked, std::span<const Effect> own,
                          Texts& notes) {
  LoggedFlight flight;
  flight.mass = asked.mass;
  flight.air_density = asked.air_density;
  flight.options.base = base_effects(asked.base, LogKind::flight, own);
  flight.options.pitch_offset = asked.pitch_offset;
  for (const std::string& name : asked.flight_logs) {
    FlightLogReading reading =
        read_flight_log(name, {.core = asked.core, .level_where_missing = true});
    for (const std::string& note : reading.notes) notes.push_back(name + ": " + note);
    MeasuredFlight measured{std::move(reading.log), {}};
    if (asked.from || asked.to) measured.range = select_range(measured.log, asked.from, asked.to);
    flight.flights.push_back(std::move(measured));
  }
  return flight;
}

Told diagnosed(const DesignFile& file, const DiagnosisArguments& asked, const StopFlag& stop) {
  DiagnosisQuestion question{file.design};
  for (const std::string& path : asked.effect_files) {
    for (Effect& effect : read_effects(path)) question.hypotheses.push_back(std::move(effect));
  }
  const bool one_log = !asked.whole_log.empty();
  check_effects(asked.base, question.hypotheses,
                {!asked.flight_logs.empty(), !asked.power_log.empty()});
  Texts flight_notes;
  Texts power_notes;
  if (!asked.flight_logs.empty()) {
    question.flight = read_flights(asked, question.hypotheses, flight_notes);
  }
  if (!asked.power_log.empty()) {
    PowerLogReading reading =
        read_power_log(asked.power_log, {asked.free_flight, asked.batteries, asked.core});
    question.power = {.log = std::move(reading.log),
                      .base = base_effects(asked.base, LogKind::power, question.hypotheses)};
    if (asked.flight_logs.empty() || one_log) {
      question.power->mass = asked.mass;
      question.power->air_density = asked.air_density;
    }
    power_notes = std::move(reading.notes);
  }
  question.one_flight = one_log;
  struct Unwanted {};
  Told told{study_diagnosis(question,
                            [&](const std::string&) {
                              if (*stop) throw Unwanted();
                            }),
            {}};
  const auto put_first = [](std::optional<Diagnosis>& of, const Texts& notes) {
    if (of) of->notes.insert(of->notes.begin(), notes.begin(), notes.end());
  };
  put_first(told.study.flight, flight_notes);
  put_first(told.study.power, power_notes);
  told.spec =
      read_design_document(spec_with(file, told.study.extended), file.file, file.load).document;
  return told;
}

Answer diagnosis_answer(const std::shared_ptr<const Told>& told, const std::string& flight_name,
                        const std::string& power_name) {
  const auto& [study, spec] = *told;
  Answer answer;
  if (study.flight && study.power) {
    answer.text = [=] { return joint_diagnosis_text(*told->study.flight, *told->study.power, {}); };
    answer.json = [=] {
      return joint_diagnosis_json(*told->study.flight, *told->study.power, told->spec);
    };
  } else {
    const Diagnosis* only = study.flight ? &*study.flight : &*study.power;
    answer.text = [=] { return diagnosis_text(*only, {}); };
    answer.json = [only, told] { return diagnosis_json(*only, told->spec); };
  }
  answer.csv = [=] {
    std::vector<Finding> findings;
    for (const auto* one : {&told->study.flight, &told->study.power}) {
      if (*one) findings.insert(findings.end(), (*one)->findings.begin(), (*one)->findings.end());
    }
    return diagnosis_csv(findings);
  };
  const auto draw = [&](const std::string& name, const std::string& log,
                        const std::optional<Diagnosis>& one) {
    if (!one || one->compared.empty()) return;
    answer.figures.push_back({name, [told, log, &one] { return diagnosis_figure(log, *one); }});
  };
  draw("flight", flight_name, study.flight);
  draw("power", power_name, study.power);
  return answer;
}

Answer diagnose(const py::object& spec, const Texts& flight_logs, const std::string& power_log,
                const std::string& whole_log, const Texts& base, const Texts& effect_files,
                const std::vector<int>& batteries, bool free_flight, std::optional<double> mass_g,
                std::optional<double> air_density, double pitch_offset_deg, const std::string& from,
                const std::string& to, int core) {
  const auto file = design_of(spec)->file();
  DiagnosisArguments asked{flight_logs,
                           power_log,
                           whole_log,
                           base,
                           effect_files,
                           batteries,
                           free_flight,
                           flown_mass(mass_g),
                           flown_air(air_density),
                           pitch_offset_deg * unit::degree,
                           log_position("--from", from),
                           log_position("--to", to),
                           core};
  if (!whole_log.empty()) {
    if (!flight_logs.empty() || !power_log.empty()) {
      throw InputError("log", "is both, flight and power; give it, or flight and power");
    }
    asked.flight_logs = {whole_log};
    asked.power_log = whole_log;
  }
  if (asked.flight_logs.empty() && asked.power_log.empty()) {
    throw InputError("diagnose", "needs a measured log: flight, power, or log for both");
  }
  const auto told = std::make_shared<const Told>(interruptible([=](const StopFlag& stop) {
    try {
      return diagnosed(*file, asked, stop);
    } catch (const UnsuitableLog& error) {
      throw InputError(error.kind() == LogKind::flight
                           ? fmt::format("{}", fmt::join(asked.flight_logs, ", "))
                           : asked.power_log,
                       error.what());
    } catch (const UnsuitableFlight& error) {
      throw InputError(fmt::format("{}", fmt::join(asked.flight_logs, ", ")), error.what());
    }
  }));
  return diagnosis_answer(told, heading(asked.flight_logs), heading({asked.power_log}));
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
  module.def("_drag", drag, py::arg("logs"), py::arg("mass_g"), py::arg("air_density_kg_m3"),
             py::arg("pitch_offset_deg"), py::arg("start"), py::arg("end"), py::arg("core"),
             py::arg("published_kinematics"));
  module.def("_diagnose", diagnose, py::arg("spec"), py::arg("flight"), py::arg("power"),
             py::arg("log"), py::arg("base"), py::arg("effects"), py::arg("batteries"),
             py::arg("free_flight"), py::arg("mass_g"), py::arg("air_density_kg_m3"),
             py::arg("pitch_offset_deg"), py::arg("start"), py::arg("end"), py::arg("core"));
}

}  // namespace tethercalc::python
