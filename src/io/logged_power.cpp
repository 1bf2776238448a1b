#include "io/logged_power.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "io/csv_log_columns.hpp"
#include "io/log_damage.hpp"
#include "io/logged_battery.hpp"
#include "io/logged_wind.hpp"
#include "io/longest_increasing.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

constexpr double longest_estimator_step =
    1;  // s between samples of the estimator, which writes 10 a second
Warning ground_speed_note() {
  return {WarningKind::log_ground_speed,
          "no airspeed and no wind in the log: ground speed is taken as airspeed"};
}

[[noreturn]] void fail_in(const std::string& name, std::string message) {
  throw InputError({{name, std::move(message)}});
}

/// A quantity with a clock of its own, rising.
struct Track {
  std::vector<double> time;
  std::vector<double> value;
};

Track track_of(const std::vector<double>& time, const std::vector<double>& value) {
  Track finite;
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (!std::isfinite(time[i]) || !std::isfinite(value[i])) continue;
    finite.time.push_back(time[i]);
    finite.value.push_back(value[i]);
  }
  Track track;
  for (const std::size_t i : longest_increasing(finite.time)) {
    track.time.push_back(finite.time[i]);
    track.value.push_back(finite.value[i]);
  }
  return track;
}

/// On the straight line between the samples around `t`; NaN outside, or where they are further
/// apart than `longest`.
double value_at(const Track& track, double t, double longest) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const auto after = std::ranges::lower_bound(track.time, t);
  if (after == track.time.end()) return none;
  const auto k = static_cast<std::size_t>(after - track.time.begin());
  if (track.time[k] == t) return track.value[k];
  if (k == 0 || track.time[k] - track.time[k - 1] > longest) return none;
  const double share = (t - track.time[k - 1]) / (track.time[k] - track.time[k - 1]);
  return track.value[k - 1] + share * (track.value[k] - track.value[k - 1]);
}

// --- Battery ---

std::vector<std::string> names_of(const std::vector<LoggedBattery>& batteries) {
  std::vector<std::string> names;
  for (const LoggedBattery& battery : batteries) names.push_back(battery.name());
  return names;
}

/// The monitors that feed the motors.
std::vector<LoggedBattery> chosen_batteries(const AutopilotLog& log,
                                            const std::vector<int>& numbers) {
  std::vector<LoggedBattery> all = logged_batteries(log);
  const bool is_px4 = log.format() == LogFormat::ulog;
  if (all.empty()) {
    fail_in(log.name(),
            is_px4
                ? "no voltage and no current in the log: it has no battery_status messages "
                  "(BAT1_SOURCE says where PX4 measures, bit 0 of SDLOG_PROFILE that it is logged)"
                : "no voltage and no current in the log: it has no BAT or CURR messages "
                  "(BATT_MONITOR, and the bit of the battery in LOG_BITMASK)");
  }
  std::vector<LoggedBattery> measured;
  std::ranges::copy_if(all, std::back_inserter(measured), &LoggedBattery::measures_current);
  if (measured.empty()) {
    fail_in(log.name(),
            fmt::format("no current in {}: it has a voltage, but its current is always "
                        "0 or unknown; is there a sensor, and {} set to it?",
                        fmt::join(names_of(all), ", "), is_px4 ? "BAT1_SOURCE" : "BATT_MONITOR"));
  }
  if (numbers.empty()) {
    if (measured.size() == 1) return measured;
    std::vector<std::string> told;
    for (const LoggedBattery& battery : measured) {
      told.push_back(fmt::format("{} is {} (mean {:.2f} V, {:.2f} A)", battery.number,
                                 battery.name(), battery.mean_voltage(), battery.mean_current()));
    }
    fail_in(log.name(), fmt::format("has {} battery monitors with a current; say which feed the "
                                    "motors: --battery {}, or several to add their currents, "
                                    "--battery {},{}. {}",
                                    measured.size(), measured[0].number, measured[0].number,
                                    measured[1].number, fmt::join(told, "; ")));
  }
  std::vector<LoggedBattery> chosen;
  for (const int number : numbers) {
    const auto found = std::ranges::find(measured, number, &LoggedBattery::number);
    if (found == measured.end()) {
      std::vector<int> known;
      for (const LoggedBattery& battery : measured) known.push_back(battery.number);
      throw InputError("--battery", fmt::format("{} is no battery monitor of {} that measures a "
                                                "current; allowed are {}",
                                                number, log.name(), fmt::join(known, ", ")));
    }
    if (std::ranges::find(chosen, number, &LoggedBattery::number) == chosen.end()) {
      chosen.push_back(*found);
    }
  }
  return chosen;
}

/// Voltage and current of all batteries together, at the times of the first.
struct BusSeries {
  std::vector<double> time;
  std::vector<double> voltage;
  std::vector<double> current;
};

BusSeries bus_of(const std::vector<LoggedBattery>& batteries) {
  constexpr double longest_battery_step = 5;  // s; some are logged once a second, with losses
  std::vector<std::pair<Track, Track>> tracks;
  for (const LoggedBattery& battery : batteries) {
    tracks.emplace_back(track_of(battery.time, battery.voltage),
                        track_of(battery.time, battery.current));
  }
  BusSeries bus;
  for (const double t : tracks.front().second.time) {
    double power = 0;
    double current = 0;
    double voltages = 0;
    for (const auto& [voltage, drawn] : tracks) {
      const double v = value_at(voltage, t, longest_battery_step);
      const double i = value_at(drawn, t, longest_battery_step);
      power += v * i;
      current += i;
      voltages += v;
    }
    if (!std::isfinite(power)) continue;
    bus.time.push_back(t);
    bus.current.push_back(current);
    bus.voltage.push_back(current > 0 ? power / current
                                      : voltages / static_cast<double>(tracks.size()));
  }
  return bus;
}

// --- Airspeed ---

/// The airspeed as a sensor of the autopilot reads it, and which.
std::optional<std::pair<Track, std::string>> measured_airspeed(const AutopilotLog& log) {
  const std::array<std::pair<std::string, std::string>, 2> sensors{
      {{"ARSP", "Airspeed"}, {"airspeed", "true_airspeed_m_s"}}};
  for (const auto& [message, field] : sensors) {
    const std::vector<std::string> fields{field};
    const LogSeries series = log.series(message, fields, 0);
    Track track = track_of(series.time, series.columns.front());
    // A sensor that is not there reads the same all the time.
    const bool moves =
        std::ranges::adjacent_find(track.value, std::not_equal_to<>()) != track.value.end();
    if (moves) return std::pair{std::move(track), message};
  }
  return std::nullopt;
}

/// Airspeed over time, and in a sentence where it comes from.
std::pair<Track, Warning> airspeed_in(const AutopilotLog& log, const FlightLog& flight) {
  if (auto measured = measured_airspeed(log)) {
    return {std::move(measured->first),
            {WarningKind::log_airspeed_derived,
             fmt::format("the airspeed is that of {}: a pitot tube reads the forward part only",
                         measured->second)}};
  }
  const std::optional<LoggedWind> wind = logged_wind(log);
  const Track north = wind ? track_of(wind->time, wind->north) : Track{};
  const Track east = wind ? track_of(wind->time, wind->east) : Track{};
  std::vector<double> speed;
  for (std::size_t i = 0; i < flight.time.size(); ++i) {
    // The estimator writes wind and velocity one after the other, so the last wind of a log may
    // come before its last velocity: then that wind goes on.
    const auto wind_at = [&](const Track& track) {
      if (track.time.empty()) return 0.0;
      const double t = std::clamp(flight.time[i], track.time.front(), track.time.back());
      return value_at(track, t, std::numeric_limits<double>::infinity());
    };
    speed.push_back(std::hypot(flight.north_velocity[i] - wind_at(north),
                               flight.east_velocity[i] - wind_at(east)));
  }
  return {track_of(flight.time, speed),
          wind ? Warning{WarningKind::log_airspeed_derived,
                         fmt::format("the airspeed is the ground speed less the wind that the "
                                     "estimator guesses ({})",
                                     wind->message)}
               : ground_speed_note()};
}

// --- Acceleration ---

/// By how much `speed` grows at `t`, m/s², in the mean over what the slowest estimators write
/// twice in; NaN where samples are missing about there.
double growth(const Track& speed, double t) {
  constexpr double over = 0.4;  // s
  return (value_at(speed, t + over / 2, longest_estimator_step) -
          value_at(speed, t - over / 2, longest_estimator_step)) /
         over;
}

/// Gives `log` its acceleration over ground, of which the airspeed's growth is the part along it:
/// the wind is steady meanwhile. None where velocities are missing.
void add_acceleration(const Track& north, const Track& east, const Track& airspeed, PowerLog& log) {
  for (const double t : log.time) {
    const double all = std::hypot(growth(north, t), growth(east, t));
    const double along = std::clamp(growth(airspeed, t), -all, all);
    const bool known = std::isfinite(all) && std::isfinite(along);
    log.acceleration_along.push_back(known ? along : 0);
    log.acceleration_across.push_back(known ? std::sqrt(all * all - along * along) : 0);
  }
}

// --- What is flown ---

/// From take-off to landing; from the first movement to the last where neither is told.
std::vector<LogSummary::Flight> flown_times(const AutopilotLog& log,
                                            const std::optional<LogSummary::Flying>& flying) {
  if (!flying || !flying->whole) {
    fail_in(log.name(), fmt::format("the log shows no flight{}",
                                    flying ? " (" + flying->determined_by + ")" : ""));
  }
  if (!flying->flights.empty()) return flying->flights;
  return {*flying->whole};
}

std::string duration_words(const std::vector<double>& time) {
  return time.empty() ? "nothing" : fmt::format("{:.0f} s", time.back() - time.front());
}

}  // namespace

PowerLogReading logged_power(const AutopilotLog& log, const FlightLogReading& flight,
                             const std::optional<LogSummary::Flying>& flying,
                             const PowerLogOptions& options) {
  if (!flight.log.other_vehicle.empty()) {
    fail_in(log.name(), fmt::format("it is {}, no multirotor", flight.log.other_vehicle));
  }
  const std::vector<LoggedBattery> batteries = chosen_batteries(log, options.batteries);
  const std::vector<LogSummary::Flight> flights = flown_times(log, flying);
  if (flight.height.empty() && !options.free_flight) {
    fail_in(log.name(), fmt::format("{} tells no height", flight.source));
  }
  const BusSeries bus = bus_of(batteries);
  const auto [airspeed, airspeed_note] = airspeed_in(log, flight.log);
  const Track height = flight.height.empty() ? Track{} : track_of(flight.log.time, flight.height);

  PowerLogReading reading;
  PowerLog& power = reading.log;
  power.free_flight = options.free_flight;
  std::optional<double> ground;
  for (std::size_t i = 0; i < bus.time.size(); ++i) {
    const double t = bus.time[i];
    const bool is_flown = std::ranges::any_of(
        flights, [t](const LogSummary::Flight& f) { return t >= f.start && t <= f.end; });
    const double v = value_at(airspeed, t, longest_estimator_step);
    const double h = height.time.empty() ? 0 : value_at(height, t, longest_estimator_step);
    if (!is_flown || !std::isfinite(v) || !std::isfinite(h)) continue;
    if (!ground) ground = h;
    power.time.push_back(t);
    power.airspeed.push_back(v);
    if (!height.time.empty()) power.height.push_back(h - *ground);
    power.bus_voltage.push_back(bus.voltage[i]);
    power.bus_current.push_back(bus.current[i]);
  }
  add_acceleration(track_of(flight.log.time, flight.log.north_velocity),
                   track_of(flight.log.time, flight.log.east_velocity), airspeed, power);
  reading.source = fmt::format("{} and {}", fmt::join(names_of(batteries), " + "), flight.source);
  if (power.time.empty()) {
    fail_in(log.name(),
            fmt::format("while the drone flew {} tell nothing at the same time", reading.source));
  }
  reading.notes.push_back(
      {WarningKind::log_bus_chosen,
       fmt::format("the bus is {}{}; {} flown ({})", fmt::join(names_of(batteries), " and "),
                   batteries.size() > 1 ? ", their currents added" : "", duration_words(power.time),
                   flying->determined_by)});
  reading.notes.push_back(airspeed_note);
  note_damage(log.contents(), reading.notes);
  return reading;
}

PowerLogReading parse_power_log(const AutopilotLog& log, const PowerLogOptions& options) {
  check_no_columns(options.columns, log.name());
  return logged_power(log, parse_flight_log(log, {.core = options.core}), time_in_the_air(log),
                      options);
}

namespace {

/// Airspeed of a table that has none, from its velocity over ground and the wind on board.
std::vector<double> made_airspeed(LogTable& table, const std::string& name,
                                  std::vector<Warning>& notes) {
  const std::vector<double>& north = table["vn_m_s"];
  const std::vector<double>& east = table["ve_m_s"];
  if (north.empty() || east.empty()) {
    fail_in(name + ":1",
            "column \"airspeed_m_s\" is missing from the header, and so are vn_m_s and ve_m_s, of "
            "which it can be made");
  }
  const std::vector<double>& forward = table["airspeed_forward_m_s"];
  if (!forward.empty() && !table.has("yaw_deg")) {
    fail_in(name + ":1",
            "column \"yaw_deg\" is missing from the header: without it airspeed_forward_m_s has "
            "no direction (or give airspeed_m_s)");
  }
  const std::vector<double>& yaw = table["yaw_deg"];
  const std::vector<double>& wind_north = table["wind_north_m_s"];
  const std::vector<double>& wind_east = table["wind_east_m_s"];
  std::vector<double> speed;
  for (std::size_t i = 0; i < north.size(); ++i) {
    if (!forward.empty()) {
      const double heading = yaw[i] * unit::degree;
      const double aside = east[i] * std::cos(heading) - north[i] * std::sin(heading);
      speed.push_back(std::hypot(forward[i], aside));
    } else if (!wind_north.empty()) {
      speed.push_back(std::hypot(north[i] - wind_north[i], east[i] - wind_east[i]));
    } else {
      speed.push_back(std::hypot(north[i], east[i]));
    }
  }
  if (forward.empty() && wind_north.empty()) notes.push_back(ground_speed_note());
  return speed;
}

PowerLogReading power_of_table(std::string_view text, const std::string& name,
                               const PowerLogOptions& options) {
  if (!options.batteries.empty()) {
    throw InputError("--battery", "chooses among the battery monitors of an autopilot's log; " +
                                      name + " is CSV");
  }
  std::vector<std::string_view> optional{"airspeed_m_s"};
  if (options.free_flight) optional.emplace_back("height_m");
  LogTable table(text, name, &LogCsvColumn::power, options.columns, optional);
  check_wind_columns(table, name);
  if (table.has("bus_power_W") && (table.has("bus_voltage_V") || table.has("bus_current_A"))) {
    fail_in(name, "bus_power_W goes without bus_voltage_V and bus_current_A: they give it too");
  }
  PowerLogReading reading{.log = {}, .source = "CSV"};
  table.note_passed_over(reading.notes);
  if (!table.has("airspeed_m_s")) {
    table["airspeed_m_s"] = made_airspeed(table, name, reading.notes);
  }
  reading.log.free_flight = options.free_flight;
  reading.log.time = std::move(table["time_s"]);
  for (const PowerChannel& channel : power_channels) {
    reading.log.*channel.values = std::move(table[channel.name]);
  }
  PowerLog& log = reading.log;
  const bool tells_acceleration =
      !log.acceleration_along.empty() || !log.acceleration_across.empty();
  if (table.has("vn_m_s") && table.has("ve_m_s") && !tells_acceleration) {
    add_acceleration(track_of(log.time, table["vn_m_s"]), track_of(log.time, table["ve_m_s"]),
                     track_of(log.time, log.airspeed), log);
  }
  return reading;
}

}  // namespace

PowerLogReading parse_power_log(std::span<const std::byte> content, const std::string& name,
                                const PowerLogOptions& options) {
  if (!looks_like_table(content)) return parse_power_log(AutopilotLog(content, name), options);
  check_no_core(options.core, name);
  return power_of_table({reinterpret_cast<const char*>(content.data()), content.size()}, name,
                        options);
}

}  // namespace tethercalc
