#include "tethercalc/model/airframe.hpp"

#include <algorithm>

#include "model/constants.hpp"

namespace tethercalc {

AirframeDrag drag_of_mass(double mass) {
  constexpr double published_mass = 1.549;
  const double size = std::cbrt(mass / published_mass);
  AirframeDrag drag{0.01451 * size * size, 0.01361 * size * size, 19.27 * size, 0};
  drag.is_estimate = true;
  return drag;
}

double airframe_drag_force(const AirframeDrag& drag, double air_density, double airspeed,
                           double tan_pitch) {
  return std::copysign(area_force_factor(drag, air_density, airspeed), airspeed) *
         effective_area(drag, tan_pitch);
}

namespace {

/// `t`, or +infinity where it is beyond the limit by more than rounding.
double limited(double t, double limit) {
  constexpr double rounding = 1e-12;
  return t <= limit * (1 + rounding) ? t : infinity;
}

/// Of a cable that pulls harder into the wind than the airframe drags with it, which leaves a small
/// tilt to step towards.
double pulled_tan_pitch(const ForceBalance& balance) {
  const AirframeDrag drag{.front_area = balance.front_area, .top_area = balance.top_area};
  double tangent = 0;
  for (int i = 0; i < 50; ++i) {
    const double push = balance.area_force_factor * effective_area(drag, tangent);
    tangent = (push + balance.tether_drag) / balance.weight;
  }
  return tangent;
}

}  // namespace

double equilibrium_tan_pitch(const ForceBalance& balance, double tan_limit, double guess) {
  if (balance.tether_drag < 0) return pulled_tan_pitch(balance);
  const double front = balance.area_force_factor * balance.front_area;
  const double top = balance.area_force_factor * balance.top_area;
  if (front + balance.tether_drag == 0) {
    // Level flight is a root too, but the one that vanishing front area leads to is the other.
    const double ratio = top / balance.weight;
    return limited(ratio > 1 ? std::sqrt((ratio - 1) * (ratio + 1)) : 0, tan_limit);
  }

  // g(t) ≤ A_f + A_t everywhere, so the root lies below `high`.
  const double level_drag = front + balance.tether_drag;
  const double per_weight = 1 / balance.weight;
  double low = 0;
  double high = (level_drag + top) * per_weight;
  double t = guess > low && guess < high ? guess : level_drag * per_weight;
  // Newton squares the error in every step, so a step below 1e-7·t leaves an error below 1e-14·t.
  constexpr double last_step = 1e-7;
  // Bisection alone would need 60 steps; Newton takes three or four.
  for (int step = 0; step < 100; ++step) {
    // Balance and its slope, both times secant³, which spares divisions.
    const double secant_squared = 1 + t * t;
    const double secant = std::sqrt(secant_squared);
    const double excess =
        secant_squared * ((balance.weight * t - balance.tether_drag) * secant - (front + top * t));
    const double slope = balance.weight * secant_squared * secant - (top - front * t);
    (excess > 0 ? high : low) = t;
    const double newton = t - excess / slope;
    if (std::abs(newton - t) <= last_step * t) {
      t = newton;
      break;
    }
    t = newton > low && newton < high ? newton : 0.5 * (low + high);
  }
  return limited(t, tan_limit);
}

double weight_held(const ForceBalance& balance, double thrust) {
  // T·sinθ = q·(A_f·cosθ + A_t·sinθ) + F_t: a line that cuts the circle of (sinθ, cosθ).
  const double up = thrust - balance.area_force_factor * balance.top_area;
  const double front = balance.area_force_factor * balance.front_area;
  const double square = up * up + front * front;
  const double rest = square - balance.tether_drag * balance.tether_drag;
  if (!(rest > 0)) return 0;
  const double cosine = (up * std::sqrt(rest) - front * balance.tether_drag) / square;
  return std::max(0.0, thrust * cosine);
}

}  // namespace tethercalc
