// Notation as in the header; s wall of the insulation, h cable in the air.

#include "tethercalc/model/tether_load.hpp"

#include <numbers>

namespace tethercalc {
namespace {

using std::numbers::pi;

/// Larger root of a·x² + b·x + c with a ≥ 0, b ≥ 0, c < 0, without cancellation.
double positive_root(double a, double b, double c) {
  return -2 * c / (b + std::sqrt(b * b - 4 * a * c));
}

}  // namespace

StraightTether::StraightTether(const Tether& tether, double wall, const FlightState& state,
                               double air_density, double gravity)
    : tether_(&tether),
      wall_(wall),
      deployed_(state.deployed),
      on_drum_(state.on_drum),
      half_density_(0.5 * air_density),
      gravity_(gravity) {
  const StrengthMemberData member = strength_member_data(tether.strength_member);
  const double insulation = 2 * deployed_ * tether.insulation.density * pi * wall;
  mass_0_ = insulation * wall + deployed_ * (member.mass_per_metre + tether.cover_mass);
  mass_1_ = 2 * insulation;
  mass_2_ = 2 * deployed_ * tether.conductor.density * pi;
  const double coldest_C =
      is_heated(tether) ? state.ambient_temperature_C : tether.conductor_temperature_C;
  resistance_area_ = 2 * (deployed_ + on_drum_) * effective_resistivity(tether, coldest_C) / pi;
  width_ = wall + 0.25 * (member.diameter + tether.cover_width);
  set_airspeed(state.airspeed);
}

void StraightTether::set_airspeed(double airspeed) {
  drag_1_ = half_density_ * airspeed * airspeed * tether_->drag_coefficient *
            tether_->projection_factor * 4 * deployed_;
  drag_0_ = drag_1_ * width_;
}

double StraightTether::mass_of(double length, double radius) const {
  const double area = conductor_area(radius);
  const double insulation_area = pi * wall_ * (2 * radius + wall_);  // π((r+s)² − r²)
  return length *
         (2 * (tether_->conductor.density * area + tether_->insulation.density * insulation_area) +
          strength_member_data(tether_->strength_member).mass_per_metre + tether_->cover_mass);
}

double StraightTether::radius_of_mass(double mass) const {
  const double rest = mass_0_ - mass;
  return rest < 0 ? positive_root(mass_2_, mass_1_, rest) : -1;
}

double StraightTether::resistance(double radius, double in_air_C, double on_drum_C) const {
  return contact_resistance() + 2 *
                                    (deployed_ * effective_resistivity(*tether_, in_air_C) +
                                     on_drum_ * effective_resistivity(*tether_, on_drum_C)) /
                                    conductor_area(radius);
}

}  // namespace tethercalc
