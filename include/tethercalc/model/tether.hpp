// The tether: two equal insulated conductors from the ground supply to the drone.
#pragma once

#include <optional>

namespace tethercalc {

/// A conductor material.
struct Conductor {
  double resistivity_20C = 0;          ///< Ω·m at 20 °C
  double temperature_coefficient = 0;  ///< 1/K, relative to 20 °C
  double density = 0;                  ///< kg/m³
};

/// Sheath of each conductor, with the same wall all round.
struct Insulation {
  double density = 0;    ///< kg/m³
  double thickness = 0;  ///< m, wall thickness s
};

/// The cable as bought and laid, but for its cross-section where that is still to be found.
struct Tether {
  double length = 0;          ///< m in the air, h; also the flight height
  double spooled_length = 0;  ///< m still on the drum: adds resistance, not airborne mass or drag
  Conductor conductor;        ///< material of both conductors
  double conductor_temperature_C = 20;  ///< °C, mean along the tether, in operation
  Insulation insulation;                ///< of each conductor
  double contact_resistance = 0;        ///< Ω, plugs and slip rings of the whole loop
  double drag_coefficient = 1.0;        ///< C of a cylinder across the wind
  double projection_factor = 0.75;      ///< k, mean projected width of the turning pair over 4(r+s)
  std::optional<double> cross_section;  ///< m² of one conductor, where the cable is already chosen
};

/// Resistivity in Ω·m at the tether's conductor temperature: ρ = ρ20·(1 + α(T − 20 °C))
/// (IEC 60287-1-1, 2.1.1).
[[nodiscard]] double resistivity(const Tether& tether);

/// Radius in m of a round conductor of `area` m².
[[nodiscard]] double conductor_radius(double area);

/// Resistance in Ω of the loop for conductors of `area` m² (> 0), there and back, over the airborne
/// and the spooled length, contacts included: R = 2(h + h_spool)ρ/A + R_contact.
[[nodiscard]] double loop_resistance(const Tether& tether, double area);

/// Mass in kg of the airborne tether for conductors of `area` m² (≥ 0):
/// m_t = 2h(ρ_c·A + ρ_i·π((r + s)² − r²)) (paper section III-A).
[[nodiscard]] double airborne_mass(const Tether& tether, double area);

/// Drag area in m² of the airborne tether, coefficient included, so that its drag is
/// ½·ρ_air·drag_area·v²: C·k·4h(r + s) (paper section V-B: two independent cylinders, all of it
/// taken by the drone).
[[nodiscard]] double tether_drag_area(const Tether& tether, double area);

}  // namespace tethercalc
