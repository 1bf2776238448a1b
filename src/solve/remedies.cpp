#include "tethercalc/solve/remedies.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tethercalc/solve/optimize.hpp"

namespace tethercalc {
namespace {

double& quantity_of(Design& design, Quantity quantity) {
  double* const all[] = {&design.supply.voltage, &design.drone.mass, &design.tether.length,
                         &design.flight.airspeed};  // in the order of Quantity
  return *all[static_cast<std::size_t>(quantity)];
}

double least_of(Quantity quantity) {
  if (quantity == Quantity::drone_mass) return least_drone_mass;
  return quantity == Quantity::tether_length ? least_tether_length : 0;
}

bool feasible_at(const Design& design, Quantity quantity, double value) {
  return is_feasible(remedied(design, {quantity, value}));
}

/// `value` to `digits` significant digits, up or down.
double rounded(double value, int digits, bool up) {
  const double decimals = digits - 1 - std::floor(std::log10(value));
  // Divided by a power of ten rather than multiplied by its reciprocal, the result is the decimal
  // number's nearest double wherever that power is exact.
  const double power = std::pow(10.0, std::abs(decimals));
  const double scaled = decimals < 0 ? value / power : value * power;
  const double whole = up ? std::ceil(scaled) : std::floor(scaled);
  return decimals < 0 ? whole * power : whole / power;
}

/// The feasible `value`, moved away from the present one to as few digits as it stays feasible
/// with.
double rounded_feasible(const Design& design, Quantity quantity, double value, double bound) {
  const bool up = bound > value;
  for (int digits = 3; digits < 15; ++digits) {
    const double candidate = rounded(value, digits, up);
    const bool within = up ? candidate <= bound : candidate >= bound;
    if (within && feasible_at(design, quantity, candidate)) return candidate;
  }
  return value;
}

/// The feasible value closest to `present` on its way to `bound`.
std::optional<double> threshold(const Design& design, Quantity quantity, double present,
                                double bound) {
  const double ratio = bound / present;
  // Hanging cables are solved anew for each step.
  const bool solved = design.tether.model == TetherModel::solved;
  const double stride = std::log(solved ? 1.1 : 1.02);
  const double close = solved ? 1e-4 : 1e-6;
  const int steps = static_cast<int>(std::ceil(std::abs(std::log(ratio)) / stride));
  double infeasible = present;
  for (int step = 1; step <= steps; ++step) {
    double value = step == steps ? bound : present * std::pow(ratio, double(step) / steps);
    if (!feasible_at(design, quantity, value)) {
      infeasible = value;
      continue;
    }
    while (std::abs(value - infeasible) > close * value) {
      const double middle = 0.5 * (value + infeasible);
      (feasible_at(design, quantity, middle) ? value : infeasible) = middle;
    }
    return value;
  }
  return std::nullopt;
}

}  // namespace

Design remedied(Design design, const Remedy& remedy) {
  quantity_of(design, remedy.quantity) = remedy.value;
  if (remedy.quantity == Quantity::drone_mass) renew_drag_estimate(design.drone);
  return design;
}

std::vector<Remedy> remedies(const Design& design) {
  std::vector<Remedy> found;
  if (is_feasible(design)) return found;
  for (const Quantity quantity : {Quantity::supply_voltage, Quantity::drone_mass,
                                  Quantity::tether_length, Quantity::airspeed}) {
    Design copy = design;
    const double present = quantity_of(copy, quantity);
    const bool raised = quantity == Quantity::supply_voltage;
    const double bound = raised ? highest_remedy_voltage
                                : std::max(present * smallest_remedy_fraction, least_of(quantity));
    const bool room = raised ? bound > present : bound < present;
    if (!room) continue;
    if (const auto value = threshold(design, quantity, present, bound)) {
      found.push_back({quantity, rounded_feasible(design, quantity, *value, bound)});
    }
  }
  return found;
}

}  // namespace tethercalc
