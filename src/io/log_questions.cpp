#include "io/log_questions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

#include "identify/slow_log.hpp"
#include "io/checked_values.hpp"
#include "io/closest_name.hpp"
#include "tethercalc/diagnose/hypothesis.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

/// Whether a stretch of `part`, of those at its begin, its end and between, is in `whole`, too.
bool has_stretch_of(const std::vector<double>& whole, const std::vector<double>& part) {
  constexpr std::size_t stretch = 50;  // samples: noise of as many digits never comes twice
  constexpr std::size_t stretches = 5;
  if (part.size() < stretch) return false;
  for (std::size_t k = 0; k < stretches; ++k) {
    const auto first =
        part.begin() + static_cast<std::ptrdiff_t>((part.size() - stretch) * k / (stretches - 1));
    const auto last = first + stretch;
    const bool changes = std::adjacent_find(first, last, std::not_equal_to<>()) != last;
    if (changes && std::search(whole.begin(), whole.end(), first, last) != whole.end()) return true;
  }
  return false;
}

/// Adds a channel of a log to those of others; whether it has a part of one of them.
bool repeats_another(std::vector<double> channel, std::vector<std::vector<double>>& others) {
  const bool repeats = std::any_of(others.begin(), others.end(), [&](const auto& other) {
    return (channel == other && !channel.empty()) || has_stretch_of(other, channel) ||
           has_stretch_of(channel, other);
  });
  others.push_back(std::move(channel));
  return repeats;
}

void refuse_repeated(const std::string& name, const std::vector<double>& channel,
                     std::vector<std::vector<double>>& of_others) {
  if (!repeats_another(channel, of_others)) return;
  throw InputError(name,
                   "is the same flight as another of these logs, or a part of it; counted twice it "
                   "would seem to tell more than it does");
}

bool is_given(const LogsAsked& options, LogKind kind) {
  return kind == LogKind::flight ? !options.flight_logs.empty() : !options.power_logs.empty();
}

/// The effects of --base that a log of `kind` can show. Every name must be one of a given log.
std::vector<std::string> base_effects(const LogsAsked& options, LogKind kind,
                                      std::span<const Effect> own) {
  std::vector<std::string> chosen;
  for (const Effect* effect : effects_for(kind, own)) {
    if (std::find(options.base.begin(), options.base.end(), effect->id) != options.base.end()) {
      chosen.push_back(effect->id);
    }
  }
  return chosen;
}

[[noreturn]] void fail_without_log(const char* option, const std::string& id, LogKind kind) {
  const bool flight = kind == LogKind::flight;
  throw InputError(option,
                   fmt::format("\"{}\" is an effect of {} logs; give one with {}", id,
                               flight ? "flight" : "power", flight ? "--flight" : "--power"));
}

/// What --base and --effects name must be of a log that is given.
void check_effects(const LogsAsked& options, std::span<const Effect> own) {
  for (const Effect& effect : own) {
    if (!is_given(options, effect.log)) fail_without_log("--effects", effect.id, effect.log);
  }
  std::vector<std::string> known;
  for (const LogKind kind : {LogKind::flight, LogKind::power}) {
    for (const Effect* effect : effects_for(kind, own)) {
      if (is_given(options, kind)) known.push_back(effect->id);
    }
  }
  for (const std::string& id : options.base) {
    if (std::find(known.begin(), known.end(), id) != known.end()) continue;
    if (const Effect* effect = find_effect(id)) fail_without_log("--base", id, effect->log);
    throw InputError("--base", fmt::format("\"{}\" is not an effect; allowed are {}{}", id,
                                           fmt::join(known, ", "), did_you_mean(id, known)));
  }
}

LoggedFlight read_flights(const LogsAsked& options, std::span<const Effect> own,
                          const LogReaders& read, std::vector<Warning>& notes) {
  LoggedFlight flight;
  flight.mass = flown_mass(options.flight);
  flight.air_density = air_density(options.flight);
  flight.options.base = base_effects(options, LogKind::flight, own);
  flight.options.pitch_offset = pitch_offset(options.flight, read);
  const auto from = log_position("--from", options.flight.from);
  const auto to = log_position("--to", options.flight.to);
  std::vector<std::vector<double>> pitches;
  for (const std::string& name : options.flight_logs) {
    FlightLogReading reading = read.flight(name, {.core = options.flight.core,
                                                  .level_where_missing = true,
                                                  .columns = options.flight.columns});
    refuse_repeated(name, reading.log.pitch, pitches);
    const bool several = options.flight_logs.size() > 1;
    if (several) {
      notes.push_back({WarningKind::log_flight_of_several,
                       fmt::format("flight {} is {}", flight.flights.size() + 1, name)});
    }
    for (Warning& note : reading.notes) {
      if (several)
        note.sentence = fmt::format("flight {}: {}", flight.flights.size() + 1, note.sentence);
      notes.push_back(std::move(note));
    }
    MeasuredFlight& measured =
        flight.flights.emplace_back(MeasuredFlight{std::move(reading.log), {}});
    try {
      if (from || to) measured.range = select_range(measured.log, from, to);
    } catch (const std::invalid_argument& error) {
      throw InputError(name, error.what());
    }
  }
  return flight;
}

/// The power of all flights, one after the other.
PowerLog read_power(const LogsAsked& options, const LogReaders& read, std::vector<Warning>& notes) {
  const bool several = options.power_logs.size() > 1;
  if (several && !options.free_flight) {
    throw InputError(
        options.whole_logs.empty() ? "--power" : "--log",
        "is several logs, whose power is judged together for free flights only "
        "(--free-flight): on a tether the heat of the cable does not go on from one to "
        "the next");
  }
  const PowerLogOptions how{options.free_flight, battery_numbers(options.batteries),
                            options.flight.core, options.flight.columns};
  PowerLog all;
  std::vector<std::vector<double>> powers;
  for (const std::string& name : options.power_logs) {
    PowerLogReading reading = read.power(name, how);
    refuse_repeated(name, bus_power_of(reading.log), powers);
    try {
      append_flight(all, reading.log);
    } catch (const std::invalid_argument& error) {
      throw InputError(name, error.what());
    }
    if (several) {
      notes.push_back(
          {WarningKind::log_flight_of_several,
           fmt::format("{} is judged as the flight from {:.0f} s to {:.0f} s", name,
                       all.time.back() - (reading.log.time.back() - reading.log.time.front()),
                       all.time.back())});
    }
    for (Warning& note : reading.notes) {
      if (several) note.sentence = fmt::format("{}: {}", name, note.sentence);
      notes.push_back(std::move(note));
    }
  }
  return all;
}

std::vector<Warning> assumptions_of(const FlightOptions& flight, const DragFitConditions& taken) {
  std::vector<Warning> out;
  if (!flight.air_density_kg_m3 && !flight.pressure_hPa) {
    out.push_back(
        {WarningKind::air_density_assumed,
         fmt::format("no air density given, {} kg/m³ taken (--air-density, or --pressure-hPa with "
                     "--temperature-C)",
                     taken.air_density)});
  }
  if (!flight.pitch_offset_deg && flight.trim_log.empty()) {
    out.push_back({WarningKind::pitch_offset_assumed,
                   "no pitch offset given, 0° taken; what it misses ends up in the wind "
                   "(--trim-log or --pitch-offset-deg)"});
  }
  return out;
}

}  // namespace

void check_options_have_logs(const LogsAsked& options, bool own_effects) {
  Problems problems;
  const FlightOptions& flight = options.flight;
  const auto refuse = [&problems](bool given, const char* option, const char* why) {
    if (given) problems.add(option, why);
  };
  if (options.power_logs.empty()) {
    const char* const of_power = "is of the power; give --power LOG, or --log LOG";
    refuse(options.free_flight, "--free-flight", of_power);
    refuse(!options.batteries.empty(), "--battery", of_power);
  }
  if (options.flight_logs.empty()) {
    const char* const of_a_flight = "is of a flight; give --flight LOG, or --log LOG";
    refuse(!flight.from.empty(), "--from", of_a_flight);
    refuse(!flight.to.empty(), "--to", of_a_flight);
    refuse(flight.pitch_offset_deg.has_value(), "--pitch-offset-deg", of_a_flight);
    refuse(!flight.trim_log.empty(), "--trim-log", of_a_flight);
  }
  if (options.flight_logs.empty() && options.power_logs.empty()) {
    const char* const of_a_log = "is of a log; give --flight LOG, --power LOG, or --log LOG";
    refuse(flight.mass_g.has_value(), "--mass-g", of_a_log);
    refuse(flight.air_density_kg_m3.has_value(), "--air-density", of_a_log);
    refuse(flight.pressure_hPa.has_value(), "--pressure-hPa", of_a_log);
    refuse(flight.temperature_C.has_value(), "--temperature-C", of_a_log);
    refuse(flight.core != 0, "--core", of_a_log);
    refuse(!flight.columns.empty(), "--columns", of_a_log);
    refuse(!options.base.empty(), "--base", of_a_log);
    refuse(own_effects, "--effects", of_a_log);
  }
  problems.throw_if_any();
}

std::optional<LogPosition> log_position(const std::string& option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  const bool is_percent = text.ends_with('%');
  const bool has_unit = is_percent || text.ends_with('s');
  const auto value = parsed_number(std::string_view(text).substr(0, text.size() - has_unit));
  if (!value) {
    throw InputError(option,
                     "\"" + text +
                         "\" is not a place in a log; allowed are seconds (120 or 120s) and "
                         "percent of the samples (25%)");
  }
  return LogPosition{*value, is_percent};
}

double pitch_offset(const FlightOptions& options, const LogReaders& read) {
  if (options.pitch_offset_deg && !options.trim_log.empty()) {
    throw InputError("--trim-log",
                     "and --pitch-offset-deg both give the pitch offset; only one can be right");
  }
  if (options.pitch_offset_deg) {
    const double degrees = *options.pitch_offset_deg;
    check_range("--pitch-offset-deg", degrees, -45, 45, "degrees");
    return degrees * unit::degree;
  }
  if (options.trim_log.empty()) return 0;
  try {
    return pitch_offset_from_hover(
        read.flight(options.trim_log, {.core = options.core, .columns = options.columns}).log);
  } catch (const UnsuitableFlight& error) {
    throw InputError(options.trim_log, error.what());
  }
}

std::vector<int> battery_numbers(const std::vector<std::string>& typed) {
  std::vector<int> numbers;
  for (const std::string& text : typed) {
    const auto number = parsed_number(text);
    constexpr double most = 255;
    if (!number || !(*number >= 0 && *number <= most) || *number != std::floor(*number)) {
      throw InputError("--battery",
                       fmt::format("\"{}\" is no number of a battery monitor; allowed are whole "
                                   "numbers from 0 to {:g}, separated by commas",
                                   text, most));
    }
    numbers.push_back(static_cast<int>(*number));
  }
  return numbers;
}

LogsAsked with_halves(LogsAsked options) {
  if (options.whole_logs.empty()) return options;
  if (!options.flight_logs.empty() || !options.power_logs.empty()) {
    throw InputError("--log", "is both, flight and power; give it, or --flight and --power");
  }
  options.flight_logs = options.whole_logs;
  options.power_logs = options.whole_logs;
  return options;
}

std::optional<double> flown_mass(const FlightOptions& options) {
  if (!options.mass_g) return std::nullopt;
  check_range("--mass-g", *options.mass_g, *find_field("drone.mass_g"));
  return *options.mass_g * unit::gram;
}

std::optional<double> air_density(const FlightOptions& options) {
  const bool by_weather = options.pressure_hPa || options.temperature_C;
  if (options.air_density_kg_m3) {
    if (by_weather) {
      throw InputError("--air-density",
                       "goes without --pressure-hPa and --temperature-C: they give it too");
    }
    check_range("--air-density", *options.air_density_kg_m3, 0.1, 2, "kg/m³");
    return options.air_density_kg_m3;
  }
  if (!by_weather) return std::nullopt;
  if (!options.pressure_hPa || !options.temperature_C) {
    throw InputError("--pressure-hPa",
                     "and --temperature-C give the air density together, not alone");
  }
  check_range("--pressure-hPa", *options.pressure_hPa, 100, 1200, "hPa");
  check_range("--temperature-C", *options.temperature_C, -80, 80, "°C");
  constexpr double pascal_per_hPa = 100;
  return dry_air_density(*options.pressure_hPa * pascal_per_hPa,
                         *options.temperature_C + zero_celsius_K);
}

FlightOptions flown_as(FlightOptions options, const Design& design) {
  if (!options.mass_g) options.mass_g = design.drone.mass / unit::gram;
  if (!air_density(options)) options.air_density_kg_m3 = design.flight.air_density;
  options.gravity_m_s2 = design.flight.gravity;
  return options;
}

DragIdentificationOptions identification_options(const FlightOptions& flight,
                                                 const LogReaders& read) {
  DragIdentificationOptions options;
  const auto mass = flown_mass(flight);
  if (!mass) {
    throw InputError("--mass-g", "is needed: drag is force, the log knows only accelerations");
  }
  options.conditions.mass = *mass;
  if (const auto density = air_density(flight)) options.conditions.air_density = *density;
  if (flight.gravity_m_s2) options.conditions.gravity = *flight.gravity_m_s2;
  options.from = log_position("--from", flight.from);
  options.to = log_position("--to", flight.to);
  options.pitch_offset = pitch_offset(flight, read);
  if (flight.published_kinematics) options.kinematics = Kinematics::published;
  return options;
}

std::vector<FlightLog> read_flight_logs(const std::vector<std::string>& names,
                                        const FlightOptions& flight, const LogReaders& read,
                                        const NoteTaker& note) {
  std::vector<FlightLog> logs;
  std::vector<std::vector<double>> pitches;
  for (const std::string& name : names) {
    FlightLogReading reading = read.flight(name, {.core = flight.core, .columns = flight.columns});
    refuse_repeated(name, reading.log.pitch, pitches);
    if (reading.log.time.size() > 1) {
      if (auto slow = slow_log_warning(median_step(reading.log.time))) {
        reading.notes.push_back(std::move(*slow));
      }
    }
    for (const auto& [kind, amiss] : reading.notes)
      note({kind, fmt::format("{}: {}", name, amiss)});
    if (!reading.log.north_wind.empty()) {
      note({WarningKind::log_wind_unused,
            name + ": the measured wind is not used: a steady one is fitted"});
    }
    logs.push_back(std::move(reading.log));
  }
  return logs;
}

std::string heading_of(const std::vector<std::string>& logs) {
  if (logs.size() != 1) return fmt::format("{} flights", logs.size());
  if (logs.front() == "-") return "standard input";
  return logs.front().substr(logs.front().find_last_of('/') + 1);
}

LearnedDrag learned_drag(const std::vector<std::string>& logs, const FlightOptions& flight,
                         const LogReaders& read, const NoteTaker& note) {
  LearnedDrag learned;
  const NoteTaker keep = [&](const Warning& amiss) {
    learned.notes.push_back(amiss);
    if (note) note(amiss);
  };
  const DragIdentificationOptions how = identification_options(flight, read);
  try {
    const std::vector<FlightLog> read_logs = read_flight_logs(logs, flight, read, keep);
    learned.study = study_drag(heading_of(logs), read_logs, how);
    for (std::size_t i = 0; i < logs.size(); ++i) {
      if (const auto unused = unused_flights_warning(read_logs[i], how)) {
        keep({unused->kind, fmt::format("{}: {}", logs[i], unused->sentence)});
      }
    }
  } catch (const UnsuitableFlight& error) {
    throw InputError(logs.size() == 1 ? logs.front() : "drag", error.what());
  }
  learned.assumed = assumptions_of(flight, how.conditions);
  learned.notes.insert(learned.notes.end(), learned.assumed.begin(), learned.assumed.end());
  return learned;
}

AskedDiagnosis diagnosis_question(const LogsAsked& options, const Design& design,
                                  std::vector<Effect> own, const LogReaders& read) {
  if (options.flight_logs.empty() && options.power_logs.empty()) {
    throw InputError("diagnose",
                     "needs a measured log: --flight LOG, --power LOG, or --log LOG for both");
  }
  check_options_have_logs(options, !own.empty());
  AskedDiagnosis asked{{design}, {}, {}};
  DiagnosisQuestion& question = asked.question;
  question.hypotheses = std::move(own);
  check_effects(options, question.hypotheses);
  if (!options.flight_logs.empty())
    question.flight = read_flights(options, question.hypotheses, read, asked.flight_notes);
  if (!options.power_logs.empty()) {
    question.power = {.log = read_power(options, read, asked.power_notes),
                      .base = base_effects(options, LogKind::power, question.hypotheses)};
    // Beside another log's flight these are that one's.
    if (options.flight_logs.empty() || !options.whole_logs.empty()) {
      question.power->mass = flown_mass(options.flight);
      question.power->air_density = air_density(options.flight);
    }
  }
  question.one_flight = !options.whole_logs.empty();
  return asked;
}

DiagnosisStudy studied_diagnosis(const AskedDiagnosis& asked, const LogsAsked& options,
                                 const SelectionProgress& progress) {
  const auto with_notes = [](std::optional<Diagnosis>& of, const std::vector<Warning>& notes) {
    if (of) of->notes.insert(of->notes.begin(), notes.begin(), notes.end());
  };
  try {
    DiagnosisStudy study = study_diagnosis(asked.question, progress);
    with_notes(study.flight, asked.flight_notes);
    with_notes(study.power, asked.power_notes);
    return study;
  } catch (const UnsuitableLog& error) {
    const auto& logs = error.kind() == LogKind::flight ? options.flight_logs : options.power_logs;
    throw InputError(fmt::format("{}", fmt::join(logs, ", ")), error.what());
  }
}

}  // namespace tethercalc
