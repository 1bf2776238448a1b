#include "io/logged_battery.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace tethercalc {
namespace {

/// Where a log tells voltage and current.
struct BatteryFields {
  const char* message;
  const char* voltage;
  const char* current;
  int number;  ///< of messages without instances
};
constexpr std::array<BatteryFields, 5> battery_fields = {
    {{"BAT", "Volt", "Curr", 0},
     {"BAT2", "Volt", "Curr", 1},
     {"CURR", "Volt", "Curr", 0},
     {"CURR2", "Volt", "Curr", 1},
     {"battery_status", "voltage_v", "current_a", 0}}};

/// Integers hold hundredths (ArduPilot until 2015).
double unit_of(const LogMessageType& type, const char* field) {
  const LogField* const found = type.find_number(field);
  return found != nullptr && (found->kind == 'h' || found->kind == 'H') ? 0.01 : 1;
}

LoggedBattery battery_in(const AutopilotLog& log, const BatteryFields& from,
                         std::optional<int> instance) {
  const LogMessageType& type = *log.contents().find(from.message);
  const std::vector<std::string> fields = {from.voltage, from.current};
  const LogSeries series = log.series(from.message, fields, instance);
  LoggedBattery battery{from.message, instance, instance.value_or(from.number), {}, {}, {}};
  for (std::size_t i = 0; i < series.time.size(); ++i) {
    const double voltage = series.columns[0][i] * unit_of(type, from.voltage);
    const double current = series.columns[1][i] * unit_of(type, from.current);
    constexpr double highest = 1000;  // V and A that a drone can have
    if (!(voltage > 0 && voltage < highest)) continue;
    const bool is_known = current >= 0 && current < highest;
    battery.time.push_back(series.time[i]);
    battery.voltage.push_back(voltage);
    battery.current.push_back(is_known ? current : std::numeric_limits<double>::quiet_NaN());
  }
  return battery;
}

double mean_of_known(const std::vector<double>& values) {
  double sum = 0;
  std::size_t count = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    sum += value;
    ++count;
  }
  return sum / static_cast<double>(count);
}

}  // namespace

std::string LoggedBattery::name() const {
  return instance ? fmt::format("{} {}", message, *instance) : message;
}

bool LoggedBattery::measures_current() const {
  return std::ranges::any_of(current, [](double x) { return x > 0; });
}

double LoggedBattery::mean_voltage() const { return mean_of_known(voltage); }

double LoggedBattery::mean_current() const { return mean_of_known(current); }

std::vector<LoggedBattery> logged_batteries(const AutopilotLog& log) {
  std::vector<LoggedBattery> batteries;
  const auto take = [&](const BatteryFields& from, std::optional<int> instance) {
    LoggedBattery found = battery_in(log, from, instance);
    if (!found.time.empty()) batteries.push_back(std::move(found));
  };
  for (const BatteryFields& from : battery_fields) {
    if (log.contents().count(from.message) == 0) continue;
    const std::vector<int> instances = log.instances(from.message);
    if (instances.empty()) take(from, std::nullopt);
    for (const int instance : instances) take(from, instance);
  }
  return batteries;
}

}  // namespace tethercalc
