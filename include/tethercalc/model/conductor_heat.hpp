// The temperature at which a conductor gives off as much heat as its current and the sun make in
// it.
#pragma once

#include <cmath>
#include <optional>

#include "tethercalc/model/drum_package.hpp"
#include "tethercalc/model/tether.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {

/// Air near a warm surface.
struct AirProperties {
  double conductivity = 0;         ///< W/(m·K)
  double kinematic_viscosity = 0;  ///< m²/s
  double prandtl = 0;              ///< Prandtl number
};

/// Air at `film_temperature_C` (−50 to 250 °C, mean of surface and surroundings), whose density at
/// 0 °C is `density_at_0C` in kg/m³; conductivity and viscosity as in CIGRE TB 601 (2014), heat
/// capacity 1005 J/(kg·K).
[[nodiscard]] AirProperties air_properties(double film_temperature_C, double density_at_0C);

/// Nusselt number of a cylinder across a flow (Churchill and Bernstein 1977, J. Heat Transfer 99,
/// 300–306); Re·Pr > 0.2.
[[nodiscard]] double churchill_bernstein(double reynolds, double prandtl);

/// Nusselt number of a horizontal cylinder in still air (Churchill and Chu 1975, Int. J. Heat Mass
/// Transfer 18, 1049–1053); Rayleigh number 1e-5 to 1e12.
[[nodiscard]] double churchill_chu(double rayleigh, double prandtl);

/// Share of a horizontal smooth conductor's natural convection left at `inclination` (rad, 0 to
/// π/3), CIGRE TB 601.
[[nodiscard]] double cigre601_inclination_factor(double inclination);

/// Share of the forced convection left where the wind meets a conductor at `angle` (rad, 0 to π/2)
/// to its axis, over that across it, CIGRE TB 601: 0.42 + 0.68·sin^1.08 up to 24°, 0.42 +
/// 0.58·sin^0.9 above.
[[nodiscard]] double cigre601_attack_factor(double angle);

/// Nusselt number, of the diameter, of a slender vertical cylinder in still air (Le Fevre and Ede
/// 1956, Proc. 9th Int. Congress of Applied Mechanics 4, 175–183; in the review by Popiel 2008,
/// Heat Transfer Engineering 29, 521–536, doi:10.1080/01457630801891557); the Rayleigh number is
/// that of the diameter, `slenderness` the diameter over the height. For a wire the second term,
/// 0.52 in air, is nearly all: the warm air that rises along it grows far thicker than the wire.
[[nodiscard]] double slender_vertical_cylinder(double rayleigh, double prandtl, double slenderness);

/// Heat in W/m that a surface of `perimeter` m radiates, `emissivity` in [0, 1], to surroundings at
/// the temperature of the air.
[[nodiscard]] double radiated_heat(double perimeter, double emissivity, double surface_C,
                                   double ambient_C);

/// What a conductor of the tether is surrounded by.
struct Surroundings {
  double temperature_C = 20;          ///< of the air
  double air_density = 1.293;         ///< kg/m³ at that temperature
  double wind = 0;                    ///< m/s across the conductor, ≥ 0
  double sun = 0;                     ///< W/m² across it
  double gravity = standard_gravity;  ///< m/s²
  /// rad over the ground, in [0, π/2], of the conductor. Set, the wind along the ground meets it at
  /// this angle, and in still air it has the greater of the convection of a horizontal cylinder in
  /// the part of gravity across it and of a vertical one in the part along it. Unset, the wind
  /// blows across, and in still air it has that of a horizontal cylinder times the least factor of
  /// CIGRE TB 601.
  std::optional<double> inclination{};
  double length = 30;  ///< m, > 0, of the conductor so inclined
  double cooling = 1;  ///< in (0, 1]: share of the heat that a wound conductor gives off
};

/// Temperatures above this are not looked at: no insulation stands them.
inline constexpr double highest_conductor_temperature_C = 400;

/// A conductor of the tether with its insulation, in one place.
///
/// Heat flows through the insulation, T_c − T_s = q·ln((r + s)/r)/(2πλ), and off its surface by
/// convection, forced or natural, whichever is more (as in CIGRE TB 601), and by radiation with an
/// emissivity of 0.9. The tether hangs: unless an inclination is stated, natural convection is that
/// of a horizontal cylinder times the least that CIGRE TB 601 leaves of it, at 60°. The two
/// conductors touch: of the surface of two cylinders only that of their convex hull, (π + 2)/(2π),
/// takes part. The sun, of which a dark sheath takes 0.9, shines on both broadside. Where the
/// insulation's conductivity is unknown it is taken as 0.17 W/(m·K), the least of common materials
/// (PVC).
class ConductorHeat {
 public:
  /// `wall` in m, `radius` in m of the metal.
  ConductorHeat(const Tether& tether, double radius, double wall, const Surroundings& around);

  /// The same conductor in another place.
  [[nodiscard]] ConductorHeat in(const Surroundings& around) const;

  /// The same conductor in a wound package: its hottest turn, with its share of the package's
  /// surface, which is cooled like a horizontal cylinder of the package's diameter, faces included.
  [[nodiscard]] ConductorHeat wound(const Surroundings& around, const DrumPackage& package) const;

  /// Conductor temperature in °C at `current` A (≥ 0); nothing where no state below
  /// `highest_conductor_temperature_C` is steady. Exact to 1e-9 K.
  [[nodiscard]] std::optional<double> temperature(double current) const;

  /// A guess at the steady state at one current, and where the tangents there lead.
  struct Balance {
    double surface_C = 0;           ///< °C, guessed
    double inside_C = 0;            ///< °C of the conductor below that surface
    double surface_change = 0;      ///< K from the guess to where heat made and given off meet
    double inside_per_surface = 1;  ///< K of the conductor per K of the surface
    double by_current = 0;          ///< K/A of the steady surface
    double inside_by_radius = 0;    ///< K/m of the steady conductor, at the same current
    bool returns = false;           ///< a warmer conductor loses more heat than it makes

    /// °C of the conductor in the steady state.
    [[nodiscard]] double steady_inside() const {
      return inside_C + inside_per_surface * surface_change;
    }
    /// How far the tangents lead, over the rise, or over 1e-4 K where that is less. Their error
    /// goes with the square.
    [[nodiscard]] double relative_change(double ambient_C) const {
      return std::abs(surface_change) / (std::abs(surface_C - ambient_C) + 1e-4);
    }
  };

  /// About a surface of `surface_C` with `current` A (> 0).
  [[nodiscard]] Balance balance(double surface_C, double current) const;

  /// About the steady surface at `current` A (≥ 0), °C: where a search for it begins.
  [[nodiscard]] double first_surface(double current) const;

  /// The balance that leads to the steady state at `current` A (≥ 0); nothing where there is none,
  /// as above.
  [[nodiscard]] std::optional<Balance> steady_surface(double current) const;

  /// Heat in W/m that a surface of `surface_C` gives off, less what it takes from the sun.
  [[nodiscard]] double given_off(double surface_C) const { return flow(surface_C).heat; }

 private:
  /// Resistance in Ω/m of one conductor.
  [[nodiscard]] double resistance(double temperature_C) const {
    return resistance_at_zero_ + resistance_per_kelvin_ * temperature_C;
  }
  [[nodiscard]] std::optional<Balance> search_surface(double current) const;
  /// Heat given off in W/m, and its derivatives by the surface's temperature and the metal's
  /// radius.
  struct Flow {
    double heat = 0;
    double by_temperature = 0;
    double by_radius = 0;
  };
  [[nodiscard]] Flow flow(double surface_C) const;

  Surroundings around_;
  double radius_;
  double resistance_at_zero_;        ///< Ω/m of one conductor, at 0 °C
  double resistance_per_kelvin_;     ///< Ω/(m·K)
  double diameter_;                  ///< m, over the insulation, or of the package
  double diameter_slope_ = 2;        ///< m of it per m of the metal's radius
  double surface_share_;             ///< surface that is cooled, over that of the diameter
  double surface_share_slope_ = 0;   ///< per m of the metal's radius
  double wind_share_ = 1;            ///< of the convection of wind across
  double still_air_share_;           ///< of a horizontal cylinder's natural convection
  double thermal_resistance_;        ///< K·m/W of the insulation
  double thermal_resistance_slope_;  ///< K/W, by the radius
  double density_0C_;
};

}  // namespace tethercalc
