#include "diagnose/channels.hpp"

#include <algorithm>
#include <stdexcept>

#include "identify/statistics.hpp"
#include "model/constants.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

std::vector<double> in_degrees(std::vector<double> angle) {
  for (double& value : angle) value /= unit::degree;
  return angle;
}

/// Central differences; one-sided at the ends.
std::vector<double> rate_of(const std::vector<double>& x, const std::vector<double>& time) {
  std::vector<double> rate(x.size(), 0.0);
  for (std::size_t i = 0; i < x.size() && x.size() > 1; ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t after = std::min(i + 1, x.size() - 1);
    rate[i] = (x[after] - x[before]) / (time[after] - time[before]);
  }
  return rate;
}

std::vector<double> braking(const FlightRecord& record) {
  std::vector<double> out = product(record.forward_speed, in_degrees(record.tilt));
  for (std::size_t i = 0; i < out.size(); ++i) {
    // Signed like the motion, so that a force against it lies on a line.
    const double against = record.forward_speed[i] > 0 ? -out[i] : out[i];
    out[i] = out[i] < 0 ? against : nan;
  }
  return out;
}

[[noreturn]] void unknown(const std::string& id) {
  throw std::invalid_argument("there is no channel \"" + id + "\"");
}

}  // namespace

Channel flight_channel(const std::string& id, const FlightRecord& record) {
  if (id == "forward_speed") return {"forward speed", "m/s", record.forward_speed};
  if (id == "tilt") return {"tilt, leaning forward", "deg", in_degrees(record.tilt)};
  if (id == "tilt_rate") {
    return {"rate of the tilt", "deg/s", in_degrees(rate_of(record.tilt, record.time))};
  }
  if (id == "yaw") return {"yaw", "deg", in_degrees(record.yaw)};
  if (id == "time") return {"time of the log", "s", record.time};
  if (id == "braking") {
    return {"forward speed times tilt while they oppose", "m/s·deg", braking(record)};
  }
  if (id == "sinking") {
    return {"forward speed times down speed", "m²/s²",
            product(record.forward_speed, record.down_speed)};
  }
  unknown(id);
}

Channel power_channel(const std::string& id, const PowerLog& log) {
  if (id == "supply_current") return {"supply current", "A", log.supply_current};
  if (id == "current_height") {
    return {"supply current times height", "A·m", product(log.supply_current, log.height)};
  }
  if (id == "bus_power") {
    return {"power at the bus", "W", product(log.bus_voltage, log.bus_current)};
  }
  if (id == "height") return {"height", "m", log.height};
  if (id == "airspeed") return {"airspeed", "m/s", log.airspeed};
  if (id == "time") return {"time of the log", "s", log.time};
  unknown(id);
}

}  // namespace tethercalc
