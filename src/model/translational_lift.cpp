#include "tethercalc/model/translational_lift.hpp"

#include <cmath>

namespace tethercalc {

double induced_velocity_ratio(double speed_ratio) {
  const double half_square = 0.5 * speed_ratio * speed_ratio;
  // √(1 + x²) − x = 1/(√(1 + x²) + x) keeps its digits at high speed.
  return 1 / std::sqrt(std::hypot(1, half_square) + half_square);
}

double translational_lift_factor(const TranslationalLift& lift, double airspeed) {
  if (lift.induced_share == 0) return 1;
  return 1 - lift.induced_share * (1 - induced_velocity_ratio(airspeed / lift.hover_induced_speed));
}

}  // namespace tethercalc
