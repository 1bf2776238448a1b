// Why hovering costs more than flying slowly: the induced power falls with airspeed.
#pragma once

namespace tethercalc {

/// Part of the motor power that falls with airspeed. Neutral: `induced_share` 0, the published
/// model, in which a thrust costs the same power at every airspeed.
struct TranslationalLift {
  double induced_share = 0;        ///< in [0, 1): part of the hover power that is induced
  double hover_induced_speed = 6;  ///< m/s, > 0: speed of the air through the rotor disc in hover,
                                   ///< √(T/(2ρA_disc)) of the ideal rotor
};

/// Induced velocity in level flight over that in hover, in (0, 1], for `speed_ratio` = airspeed
/// over hover induced velocity (of either sign): the root of ν·√(μ² + ν²) = 1, i.e. ν² = √(1 +
/// μ⁴/4) − μ²/2 (Glauert's momentum theory; Leishman, Principles of Helicopter Aerodynamics, 2nd
/// ed., section 2.14, with the disc level).
[[nodiscard]] double induced_velocity_ratio(double speed_ratio);

/// Motor power at `airspeed` (m/s) over the power the static motor curve gives for the same thrust:
/// 1 − s·(1 − ν(v/v_h)). 1 at rest.
[[nodiscard]] double translational_lift_factor(const TranslationalLift& lift, double airspeed);

}  // namespace tethercalc
