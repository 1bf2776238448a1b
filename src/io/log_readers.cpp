#include "tethercalc/io/log_readers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "io/csv.hpp"
#include "io/longest_increasing.hpp"
#include "tethercalc/diagnose/power_log.hpp"
#include "tethercalc/io/dataflash.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

// What attitude angles and a drone's velocity can be; see FlightLogReading::samples_implausible.
constexpr double steepest_pitch_deg = 90;
constexpr double furthest_roll_deg = 360;  // upside down, logged rolls run past 180°
constexpr double fastest_m_s = 500;
// A thousand turns: some tools export yaw without wraps.
constexpr double furthest_yaw_deg = 360'000;

/// Samples as logged: time in s, angles in degrees, velocities in m/s.
enum LogColumn : std::size_t {
  time_s,
  roll_deg,
  pitch_deg,
  yaw_deg,
  vn,
  ve,
  vd,
  wind_north,
  wind_east,
  airspeed_forward,
  channel_count
};
using Samples = std::vector<std::vector<double>>;

bool is_plausible(const Samples& samples, std::size_t i) {
  const auto within = [&](LogColumn channel, double limit) {
    return std::abs(samples[channel][i]) <= limit;  // false for NaN
  };
  return std::isfinite(samples[time_s][i]) && within(roll_deg, furthest_roll_deg) &&
         within(pitch_deg, steepest_pitch_deg) && within(yaw_deg, furthest_yaw_deg) &&
         within(vn, fastest_m_s) && within(ve, fastest_m_s) && within(vd, fastest_m_s);
}

/// Returns the number of samples removed.
std::size_t keep(Samples& samples, std::span<const std::size_t> kept) {
  const std::size_t before = samples[time_s].size();
  for (auto& channel : samples) {
    if (channel.empty()) continue;  // the log has none
    for (std::size_t i = 0; i < kept.size(); ++i) channel[i] = channel[kept[i]];
    channel.resize(kept.size());
  }
  return before - kept.size();
}

std::size_t remove_implausible(Samples& samples) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < samples[time_s].size(); ++i) {
    if (is_plausible(samples, i)) kept.push_back(i);
  }
  return keep(samples, kept);
}

/// Whether a velocity leaps to sample i and back, faster than anything flies: by 20 g for the time
/// between, and by 10 m/s at least.
bool is_leap(const Samples& samples, std::size_t i) {
  const std::vector<double>& time = samples[time_s];
  const double most = std::max(10.0, 200 * (time[i + 1] - time[i - 1]) / 2);
  return std::ranges::any_of(std::array{vn, ve, vd}, [&](LogColumn channel) {
    const std::vector<double>& v = samples[channel];
    if (v.empty()) return false;
    const double up = v[i] - v[i - 1];
    const double down = v[i] - v[i + 1];
    return up * down > 0 && std::min(std::abs(up), std::abs(down)) > most &&
           std::abs(v[i + 1] - v[i - 1]) < most;
  });
}

/// `samples` in the order of their time. Returns the number removed.
std::size_t remove_leaps(Samples& samples) {
  const std::size_t size = samples[time_s].size();
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < size; ++i) {
    if (i == 0 || i + 1 == size || !is_leap(samples, i)) kept.push_back(i);
  }
  return keep(samples, kept);
}

std::size_t remove_out_of_order(Samples& samples) {
  const std::vector<double>& time = samples[time_s];
  if (std::ranges::adjacent_find(time, std::greater_equal<>()) == time.end()) return 0;
  return keep(samples, longest_increasing(time));
}

std::vector<double> in_radians(std::vector<double> degrees) {
  for (double& angle : degrees) angle *= unit::degree;
  return degrees;
}

/// Removes jumps of more than half a turn by adding whole turns.
std::vector<double> without_wraps(std::vector<double> angle) {
  constexpr double turn = 2 * std::numbers::pi;
  double turns = 0;
  for (std::size_t i = 1; i < angle.size(); ++i) {
    angle[i] += turns * turn;
    const double correction = -std::round((angle[i] - angle[i - 1]) / turn);
    angle[i] += correction * turn;
    turns += correction;
  }
  return angle;
}

/// The wind that makes up the difference to the speed over ground; none to the right.
void take_wind_from_airspeed(FlightLog& log, const std::vector<double>& airspeed) {
  for (std::size_t i = 0; i < airspeed.size(); ++i) {
    const double ahead_north = std::cos(log.yaw[i]);
    const double ahead_east = std::sin(log.yaw[i]);
    const double wind =
        ahead_north * log.north_velocity[i] + ahead_east * log.east_velocity[i] - airspeed[i];
    log.north_wind.push_back(ahead_north * wind);
    log.east_wind.push_back(ahead_east * wind);
  }
}

FlightLog to_flight_log(Samples samples) {
  samples.resize(channel_count);
  FlightLog log;
  log.time = std::move(samples[time_s]);
  log.roll = in_radians(std::move(samples[roll_deg]));
  log.pitch = in_radians(std::move(samples[pitch_deg]));
  log.yaw = without_wraps(in_radians(std::move(samples[yaw_deg])));
  log.north_velocity = std::move(samples[vn]);
  log.east_velocity = std::move(samples[ve]);
  log.down_velocity = std::move(samples[vd]);
  log.north_wind = std::move(samples[wind_north]);
  log.east_wind = std::move(samples[wind_east]);
  take_wind_from_airspeed(log, samples[airspeed_forward]);
  return log;
}

/// Where a DataFlash log has the wanted samples.
struct EstimatorMessage {
  const DataFlashFormat* format = nullptr;
  std::optional<DataFlashInstance> core;
  std::string description;
};

[[noreturn]] void fail(const std::string& name, std::string message) {
  throw InputError({{name, std::move(message)}});
}

[[noreturn]] void fail_without_core(std::span<const std::byte> content, const std::string& name,
                                    std::string_view message, int core) {
  std::string cores;
  const std::vector<std::string> field = {"C"};
  const auto found = extract_columns(content, message, field);
  for (const double c : std::set<double>(found[0].begin(), found[0].end())) {
    cores += (cores.empty() ? "" : ", ") + fmt::format("{}", c);
  }
  fail(name, fmt::format("there is no EKF core {} in the log's {} messages; it has core {}", core,
                         message, cores.empty() ? "0" : cores));
}

[[noreturn]] void fail_without_estimator(const DataFlashContents& contents,
                                         const std::string& name) {
  require_messages(contents, name);
  fail(name, fmt::format("the log holds {} messages, but no attitude and velocity: expected XKF1, "
                         "NKF1 or EKF1 messages (set bit 'attitude' of LOG_BITMASK to log them)",
                         contents.messages));
}

/// The newest estimator that wrote into the log.
EstimatorMessage find_estimator(std::span<const std::byte> content,
                                const DataFlashContents& contents, const std::string& name,
                                int core) {
  for (const std::string_view message : {"XKF1", "NKF1", "EKF1"}) {
    if (contents.count(message) == 0) continue;
    const DataFlashFormat* const format = contents.find(message);
    // Logs from before there were several cores have no field that tells them apart.
    if (format->find_number("C") != nullptr) {
      return {format, DataFlashInstance{"C", static_cast<double>(core)},
              fmt::format("{} of EKF core {}", message, core)};
    }
    if (core == 0) return {format, std::nullopt, std::string(message)};
    if (core == 1 && message == "NKF1" && contents.count("NKF6") > 0) {
      return {contents.find("NKF6"), std::nullopt, "NKF6"};
    }
    fail_without_core(content, name, message, core);
  }
  fail_without_estimator(contents, name);
}

/// What flew by the firmware's own first words, where it is no multirotor; of a log's first part,
/// where the firmware introduces itself.
std::string other_vehicle(std::span<const std::byte> content) {
  constexpr std::size_t introduction = 1 << 20;
  constexpr std::array<std::pair<std::string_view, std::string_view>, 7> firmwares{
      {{"ArduPlane", "an aeroplane"},
       {"APM:Plane", "an aeroplane"},
       {"ArduRover", "a rover"},
       {"APM:Rover", "a rover"},
       {"ArduSub", "a submarine"},
       {"Blimp", "an airship"},
       {"AntennaTracker", "an antenna tracker"}}};
  std::string found;
  for_each_message(content.first(std::min(content.size(), introduction)),
                   [&](const DataFlashFormat& format, const std::byte* message) {
                     if (!found.empty()) return;
                     const std::string text = message_words(format, message);
                     for (const auto& [name, kind] : firmwares) {
                       if (text.starts_with(name)) found = fmt::format("{}, {}", text, kind);
                     }
                   });
  return found;
}

Samples read_samples(std::span<const std::byte> content, const EstimatorMessage& from,
                     const std::string& name) {
  const auto time = time_of(*from.format);
  if (!time) fail(name, fmt::format("{} messages have no time", from.format->name));
  const std::vector<std::string> fields = {
      time->field.name, "Roll", "Pitch", "Yaw", "VN", "VE", "VD"};
  for (const std::string& field : fields) {
    if (from.format->find_number(field) == nullptr) {
      fail(name, fmt::format("{} messages have no number {}; their fields are {}",
                             from.format->name, field, from.format->labels));
    }
  }
  Samples samples = extract_columns(content, from.format->name, fields, from.core);
  for (double& t : samples[time_s]) t /= time->counts_per_second;
  return samples;
}

void note_damage(FlightLogReading& reading, const DataFlashContents& contents) {
  if (contents.skipped_bytes > 0) {
    reading.notes.push_back(
        fmt::format("the log is damaged or cut: {} bytes and at least {} message{} were skipped",
                    contents.skipped_bytes, contents.skipped_messages,
                    contents.skipped_messages == 1 ? "" : "s"));
  }
  reading.notes.insert(reading.notes.end(), contents.rejected_definitions.begin(),
                       contents.rejected_definitions.end());
}

void note_removed(FlightLogReading& reading) {
  if (reading.samples_implausible > 0) {
    reading.notes.push_back(fmt::format("{} samples left out: values that no flight can have",
                                        reading.samples_implausible));
  }
  if (reading.samples_out_of_order > 0) {
    reading.notes.push_back(fmt::format("{} samples left out: their time does not increase",
                                        reading.samples_out_of_order));
  }
}

FlightLogReading read_dataflash(std::span<const std::byte> content, const std::string& name,
                                const FlightLogOptions& options) {
  const DataFlashContents contents = scan_dataflash(content);
  const EstimatorMessage from = find_estimator(content, contents, name, options.core);
  Samples samples = read_samples(content, from, name);
  if (samples[time_s].empty() && from.core) {
    fail_without_core(content, name, from.format->name, options.core);
  }
  FlightLogReading reading;
  reading.source = from.description;
  reading.samples_implausible = remove_implausible(samples);
  reading.samples_out_of_order = remove_out_of_order(samples);
  reading.samples_implausible += remove_leaps(samples);
  note_damage(reading, contents);
  note_removed(reading);
  reading.log = to_flight_log(std::move(samples));
  reading.log.other_vehicle = other_vehicle(content);
  return reading;
}

FlightLogReading read_csv(std::string_view text, const std::string& name,
                          const FlightLogOptions& options) {
  if (text.starts_with("FMT,")) {
    fail(name, "is a DataFlash log converted to text; expected the .bin log itself, or CSV");
  }
  constexpr auto within = [](std::string_view column, double limit) {
    return CsvColumn{.name = column, .minimum = -limit, .maximum = limit};
  };
  std::array<CsvColumn, channel_count> wanted = {CsvColumn{.name = "time_s", .increasing = true},
                                                 within("roll_deg", furthest_roll_deg),
                                                 within("pitch_deg", steepest_pitch_deg),
                                                 within("yaw_deg", furthest_yaw_deg),
                                                 within("vn_m_s", fastest_m_s),
                                                 within("ve_m_s", fastest_m_s),
                                                 within("vd_m_s", fastest_m_s),
                                                 within("wind_north_m_s", fastest_m_s),
                                                 within("wind_east_m_s", fastest_m_s),
                                                 within("airspeed_forward_m_s", fastest_m_s)};
  for (const LogColumn measured : {wind_north, wind_east, airspeed_forward}) {
    wanted[measured].required = false;
  }
  FlightLogReading reading;
  reading.source = "CSV";
  wanted[roll_deg].required = wanted[vd].required = !options.level_where_missing;
  Samples samples = read_csv_columns(text, name, wanted, OtherCsvColumns::rejected);
  for (const auto& [channel, taken_for] :
       {std::pair{roll_deg, "level flight"}, std::pair{vd, "flight at one height"}}) {
    if (!samples[channel].empty()) continue;
    samples[channel].assign(samples[time_s].size(), 0.0);
    reading.notes.push_back(
        fmt::format("{} is missing: taken for {}", wanted[channel].name, taken_for));
  }
  if (samples[wind_north].empty() != samples[wind_east].empty()) {
    fail(name, "wind_north_m_s and wind_east_m_s are one wind: give both or none");
  }
  if (!samples[wind_north].empty() && !samples[airspeed_forward].empty()) {
    fail(name,
         "airspeed_forward_m_s goes without wind_north_m_s and wind_east_m_s: each gives the "
         "other, and only one can be what was measured");
  }
  reading.samples_implausible = remove_leaps(samples);
  note_removed(reading);
  reading.log = to_flight_log(std::move(samples));
  return reading;
}

}  // namespace

bool looks_like_dataflash(std::span<const std::byte> content) {
  constexpr std::size_t looked_at = 4096;
  const auto head = content.first(std::min(content.size(), looked_at));
  constexpr std::array mark = {std::byte{0xA3}, std::byte{0x95}};
  return std::ranges::find(head, std::byte{0}) != head.end() ||
         std::search(head.begin(), head.end(), mark.begin(), mark.end()) != head.end();
}

FlightLogReading parse_flight_log(std::span<const std::byte> content, const std::string& name,
                                  const FlightLogOptions& options) {
  if (options.core < 0 || options.core > 255) {
    fail("core", fmt::format("{} is no EKF core, expected 0 to 255", options.core));
  }
  if (looks_like_dataflash(content)) return read_dataflash(content, name, options);
  return read_csv({reinterpret_cast<const char*>(content.data()), content.size()}, name, options);
}

PowerLog parse_power_log(std::string_view text, std::string_view name) {
  std::vector<CsvColumn> wanted{{.name = "time_s", .increasing = true}};
  for (const PowerChannel& channel : power_channels) {
    wanted.push_back({.name = channel.name, .required = !channel.optional});
    if (channel.values == &PowerLog::ambient_temperature_C) wanted.back().minimum = -zero_celsius_K;
  }
  auto columns = read_csv_columns(text, name, wanted, OtherCsvColumns::rejected);
  PowerLog log;
  log.time = std::move(columns[0]);
  for (std::size_t c = 0; c < power_channels.size(); ++c) {
    log.*power_channels[c].values = std::move(columns[c + 1]);
  }
  return log;
}

}  // namespace tethercalc
