#include "io/logged_wind.hpp"

#include <array>
#include <cmath>

namespace tethercalc {

std::optional<LoggedWind> logged_wind(const AutopilotLog& log) {
  struct WindFields {
    const char* message;
    std::vector<std::string> north_and_east;
  };
  const std::array<WindFields, 5> all = {
      {{"XKF2", {"VWN", "VWE"}},
       {"NKF2", {"VWN", "VWE"}},
       {"EKF2", {"VWN", "VWE"}},
       {"wind", {"windspeed_north", "windspeed_east"}},
       {"wind_estimate", {"windspeed_north", "windspeed_east"}}}};
  for (const WindFields& from : all) {
    const LogSeries series = log.series(from.message, from.north_and_east, 0);
    LoggedWind wind{from.message, {}, {}, {}};
    bool is_guessed = false;
    for (std::size_t i = 0; i < series.time.size(); ++i) {
      const double north = series.columns[0][i];
      const double east = series.columns[1][i];
      constexpr double fastest = 100;  // m/s; more is damage
      if (!(std::hypot(north, east) < fastest)) continue;
      wind.time.push_back(series.time[i]);
      wind.north.push_back(north);
      wind.east.push_back(east);
      is_guessed = is_guessed || north != 0 || east != 0;
    }
    if (is_guessed) return wind;
  }
  return std::nullopt;
}

}  // namespace tethercalc
