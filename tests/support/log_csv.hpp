// Logs in memory as the CSV files that the program reads.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "tethercalc/diagnose/power_log.hpp"
#include "tethercalc/identify/observations.hpp"

namespace tethercalc::test {

/// Columns that are empty are left out.
inline std::string csv_text(const std::vector<std::pair<std::string, std::vector<double>>>& columns,
                            int decimals = 6) {
  std::string text;
  for (const auto& [name, values] : columns) {
    if (!values.empty()) text += (text.empty() ? "" : ",") + name;
  }
  text += "\n";
  for (std::size_t i = 0; i < columns.front().second.size(); ++i) {
    bool first = true;
    for (const auto& [name, values] : columns) {
      if (values.empty()) continue;
      text += fmt::format("{}{:.{}f}", first ? "" : ",", values[i], decimals);
      first = false;
    }
    text += "\n";
  }
  return text;
}

inline std::string flight_csv_text(const FlightLog& log) {
  constexpr double degree = 0.017453292519943295;
  const auto degrees = [](std::vector<double> angles) {
    for (double& angle : angles) angle /= degree;
    return angles;
  };
  return csv_text({{"time_s", log.time},
                   {"roll_deg", degrees(log.roll)},
                   {"pitch_deg", degrees(log.pitch)},
                   {"yaw_deg", degrees(log.yaw)},
                   {"vn_m_s", log.north_velocity},
                   {"ve_m_s", log.east_velocity},
                   {"vd_m_s", log.down_velocity}});
}

inline std::string power_csv_text(const PowerLog& log, int decimals = 6) {
  std::vector<std::pair<std::string, std::vector<double>>> columns{{"time_s", log.time}};
  for (const PowerChannel& channel : power_channels) {
    columns.emplace_back(channel.name, log.*channel.values);
  }
  return csv_text(columns, decimals);
}

}  // namespace tethercalc::test
