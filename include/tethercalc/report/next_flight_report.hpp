// A further flight told to a person and to a program.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tethercalc/diagnose/next_flight.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc {

/// The place over ground and the heights that its waypoints take up, m from home.
struct FlightArea {
  double south = 0;    ///< not above 0, as is `west`
  double north = 0;    ///< not below 0, as is `east`
  double west = 0;     ///< likewise
  double east = 0;     ///< likewise
  double lowest = 0;   ///< over home
  double highest = 0;  ///< over home
};
/// What the flight takes up.
[[nodiscard]] FlightArea area_of(const NextFlight& flight);

/// minutes, area, manoeuvres, decides, undecided and more; `file` is where its mission was written,
/// empty where there is none.
[[nodiscard]] nlohmann::ordered_json next_flight_json(const NextFlight& flight,
                                                      const std::string& file);

/// What it decides, how long it takes, what is flown and where, and what it leaves open.
[[nodiscard]] std::string next_flight_text(const NextFlight& flight, const std::string& file,
                                           const TextStyle& style = {});

}  // namespace tethercalc
