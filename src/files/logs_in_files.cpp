#include "files/logs_in_files.hpp"

#include "tethercalc/files/read_files.hpp"

namespace tethercalc {

LogReaders logs_in_files() {
  return {[](const std::string& name, const FlightLogOptions& how) {
            return read_flight_log(name, how);
          },
          [](const std::string& name, const PowerLogOptions& how) {
            return read_power_log(name, how);
          }};
}

}  // namespace tethercalc
