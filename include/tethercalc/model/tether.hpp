// The tether: two equal insulated conductors from the ground supply to the drone.
#pragma once

#include <optional>

namespace tethercalc {

class CableMemory;

/// A conductor material.
struct Conductor {
  double resistivity_20C = 0;          ///< Ω·m at 20 °C
  double temperature_coefficient = 0;  ///< 1/K, relative to 20 °C
  double density = 0;                  ///< kg/m³
  double tensile_strength = 0;         ///< Pa; 0: unknown, and nothing is hung on it

  bool operator==(const Conductor&) const = default;  ///< member by member
};

/// Sheath of each conductor, with the same wall all round.
struct Insulation {
  double density = 0;    ///< kg/m³
  double thickness = 0;  ///< m, wall thickness s; the least one where the voltage asks for more

  double thermal_conductivity = 0;              ///< W/(m·K); 0: unknown
  std::optional<double> rated_temperature_C{};  ///< °C, highest continuous conductor temperature
  double breakdown_strength = 0;                ///< V/m, short-time; 0: unknown

  /// How many times the supply voltage a wall must stand by its breakdown strength; 0: the wall is
  /// as thick as `thickness` says, whatever the voltage.
  double dielectric_safety_factor = 0;

  bool operator==(const Insulation&) const = default;  ///< member by member
};

/// Wall in m that stands `voltage` (V, ≥ 0): max(thickness, factor·voltage/breakdown strength).
/// The whole voltage across one wall in an even field; concentration of the field at a thin
/// conductor, ageing and damage are for the safety factor. `thickness` where either the factor or
/// the breakdown strength is 0.
[[nodiscard]] double insulation_wall(const Insulation& insulation, double voltage);

/// V at which the wall for a supply of `voltage` V (≥ 0) breaks down in a short test, in an even
/// field: breakdown strength times `insulation_wall`. 0 where the strength is not known.
[[nodiscard]] double breakdown_voltage(const Insulation& insulation, double voltage);

/// How the part of the tether on the drum is cooled: by a factor that its user knows, else by the
/// package that it is wound to (drum_package.hpp), else by its number of layers. None of them:
/// nothing is known.
struct Drum {
  int layers = 0;                    ///< 1 to 4; 0: not stated
  std::optional<double> derating{};  ///< in (0, 1], current wound up over current laid out
  double core_diameter = 0;          ///< m, that the tether is wound on; 0: not stated
  double width = 0;                  ///< m between the flanges; 0: not stated
  /// W/(m·K) across the wound wires; nothing: that of the wires and the air between them.
  std::optional<double> package_conductivity{};

  bool operator==(const Drum&) const = default;  ///< member by member
};

/// Current that a cable may carry wound on a drum, over what it may laid out, at the same conductor
/// temperature: the user's own factor, else that of the layers on a ventilated cylindrical drum,
/// 0.85, 0.65, 0.45 and 0.35 for 1 to 4 (IEC 60204-1, "derating factors for cables wound on
/// drums", as commonly quoted). Nothing where neither is stated.
[[nodiscard]] std::optional<double> drum_derating(const Drum& drum);

/// Fibres that carry the pull, beside the conductors.
enum class StrengthMaterial { none, aramid, uhmwpe };

/// A strength member: a bundle of parallel fibres.
struct StrengthMember {
  StrengthMaterial material = StrengthMaterial::none;  ///< none: no member, whatever its size
  double cross_section = 0;                            ///< m² of fibre

  bool operator==(const StrengthMember&) const = default;  ///< member by member
};

/// Mass per length, thickness and strength of a strength member.
struct StrengthMemberData {
  double mass_per_metre = 0;  ///< kg/m
  double diameter = 0;        ///< m, of the bundle
  double strength = 0;        ///< N, breaking load
};

/// Aramid: 1450 kg/m³ and 2740 MPa (Kevlar 49 yarn, lower end, DuPont data manual). UHMWPE: 990
/// kg/m³ and 3090 MPa (Dyneema, the published tether model of Bauer et al. 2018). Fibres fill 72 %
/// of the bundle (a 4 mm SK90 rope has 711.5 kg/m³). All 0 for no member.
[[nodiscard]] StrengthMemberData strength_member_data(const StrengthMember& member);

/// The cable's own I²R heat as a flight has shown it, where it was measured: the conductor's
/// temperature is that of the air plus a rise that follows, with one time constant, the balance of
/// heat made and carried off. Still-air cooling plus a part that grows with the square root of the
/// airspeed is King's law for a wire across the wind (King 1914, Phil. Trans. A 214:373). On the
/// drum the same rise is taken.
struct MeasuredHeating {
  /// K per W/m of loop, in still air, settled; 0: nothing was measured.
  double rise_per_loss = 0;
  double time_constant = 200;  ///< s, > 0; steady flight does not depend on it
  double wind_cooling = 0;     ///< (s/m)^½, ≥ 0

  bool operator==(const MeasuredHeating&) const = default;  ///< member by member
};

/// How the tether hangs between station and drone.
enum class TetherModel {
  straight,  ///< straight down, as long as the drone is high, its whole drag on the drone
  solved,    ///< as weight and wind have it (`HangingLoad`)
};

/// The cable as bought and laid, but for its cross-section where that is still to be found.
struct Tether {
  double length = 0;          ///< m in the air, h; also the flight height
  double spooled_length = 0;  ///< m still on the drum: adds resistance, not airborne mass or drag
  Conductor conductor;        ///< material of both conductors
  double conductor_temperature_C = 20;  ///< °C, mean along the tether, in operation; where heat is
                                        ///< asked for: without current
  Insulation insulation;                ///< of each conductor
  double contact_resistance = 0;        ///< Ω, plugs and slip rings of the whole loop
  double stranding_factor = 1;          ///< ≥ 1, resistance over that of solid wire of that area
  double cover_mass = 0;                ///< kg/m of jacket, fillers and fibres that carry nothing
  double cover_width = 0;               ///< m, that these add to the width of both conductors
  double drag_coefficient = 1.0;        ///< C of a cylinder across the wind
  bool drag_by_reynolds_number = false;  ///< C is times `cylinder_drag` of one insulated conductor
  double vibration_amplitude = 0;  ///< ≥ 0, of a cable that beats in its own wake, over its width
  double projection_factor = 0.75;      ///< k, mean projected width of the turning pair over 4(r+s)
  std::optional<double> cross_section;  ///< m² of one conductor, where the cable is already chosen

  /// °C of the air. Set, the conductor's temperature is that of a steady heat balance, and
  /// `conductor_temperature_C` is not used; unset, it is what that says.
  std::optional<double> ambient_temperature_C{};
  MeasuredHeating heating{};  ///< takes the place of the balance where it was measured
  /// rad over the ground, in [0, π/2], of the tether in the air, for its heat; π/2 hangs straight
  /// down. Nothing: as Surroundings has it without.
  std::optional<double> inclination{};
  double sun = 0;                    ///< W/m² of sunlight across the tether in the air
  Drum drum;                         ///< of the length on it
  StrengthMember strength_member{};  ///< beside the conductors
  double winch_pull = 0;             ///< N, with which the ground end is pulled down

  TetherModel model = TetherModel::straight;  ///< how it hangs
  /// Of a solved one without a winch's pull: length paid out beyond the distance to the drone, over
  /// that distance, > 0.
  double slack = 0.01;
  std::optional<double>
      axial_stiffness{};  ///< N, EA, of a solved one; nothing: it does not stretch
  /// Where a sweep remembers the solved cables of its other rows, for one thread and not owned;
  /// null elsewhere. It saves time, and changes a load by about 1e-9 of the tension, on a winch
  /// 1e-5.
  const CableMemory* memory = nullptr;

  bool operator==(const Tether&) const = default;  ///< member by member
};

/// Whether the current warms the tether: an ambient temperature or a measured heating is set.
[[nodiscard]] bool is_heated(const Tether& tether);

/// Whether the tether is solved and a winch's pull decides how much of it is out, not its slack.
[[nodiscard]] bool hangs_on_winch(const Tether& tether);

/// The tether with its conductors as warm as the air, whatever current they carry.
[[nodiscard]] Tether without_heat(Tether tether);

/// Measured rise over the air in K that settles at `current` A in conductors of `area` m²:
/// rise_per_loss·loss/(1 + wind_cooling·√|v|), the loss in W per metre of loop with its conductors
/// at 20 °C, v = `airspeed` in m/s.
[[nodiscard]] double settled_rise(const Tether& tether, double area, double current,
                                  double airspeed);

/// Resistivity in Ω·m at `temperature` in °C: ρ = ρ20·(1 + α(T − 20 °C)) (IEC 60287-1-1, 2.1.1).
[[nodiscard]] double resistivity(const Conductor& conductor, double temperature_C);

/// Ω·m of the tether's conductors over the area of their metal: that of the material times
/// `stranding_factor`, since strands lie askew and are thinner than their sum is measured.
[[nodiscard]] double effective_resistivity(const Tether& tether, double temperature_C);

/// Drag coefficient of the cable across the wind: `drag_coefficient` times 1 + 2.1·A/D, by which a
/// cylinder that vibrates with the amplitude A across the wind shows it more than its width D
/// (Blevins, "Flow-Induced Vibration", 2nd ed. 1990, section 3.3; A/D up to about 1).
[[nodiscard]] double vibrating_drag_coefficient(const Tether& tether);

/// Radius in m of a round conductor of `area` m².
[[nodiscard]] double conductor_radius(double area);

/// Width in m of one conductor of `radius` m with a wall of `wall` m.
[[nodiscard]] constexpr double insulated_width(double radius, double wall) {
  return 2 * (radius + wall);
}

/// Area in m² of a round conductor of `radius` m.
[[nodiscard]] double conductor_area(double radius);

/// Breaking load in N: that of the strength member where there is one, which is stiffer than metal
/// and takes the load, else that of both conductors of `area` m²; 0 where their strength is
/// unknown.
[[nodiscard]] double breaking_load(const Tether& tether, double area);

}  // namespace tethercalc
