// How warm a tether's own current makes it in a flight, and what that does to its resistance.
#pragma once

#include <algorithm>
#include <optional>

#include "tethercalc/model/conductor_heat.hpp"
#include "tethercalc/model/steady_flight.hpp"

namespace tethercalc {

/// Temperatures of the conductors, °C.
struct TetherTemperatures {
  double in_air = 20;  ///< of the part in the air
  /// Of the wound part, where there is one whose cooling is known; its resistance is otherwise
  /// taken at the temperature of the part in the air.
  std::optional<double> on_drum{};
};

/// The steady state of a tether under its own current, with a load of constant power at its end.
struct TetherHeatState {
  bool steady = false;                ///< false: no steady state, or the power cannot be delivered
  double radius = 0;                  ///< m, of the conductors
  double current = 0;                 ///< A
  double resistance = 0;              ///< Ω, loop
  TetherTemperatures temperatures{};  ///< of the conductors

  /// Ω/m, of the resistance by the conductors' radius at the same current.
  double resistance_slope = 0;
  double surface_in_air_C = 0;   ///< °C of the insulation in the air
  double surface_on_drum_C = 0;  ///< °C of that on the drum

  /// °C, of the warmer part.
  [[nodiscard]] double hottest() const {
    return std::max(temperatures.in_air, temperatures.on_drum.value_or(temperatures.in_air));
  }
};

/// The heat of a tether with one conductor in one flight: by the balance of conductor_heat.hpp in
/// the flight's air, wind and sun, or by the heating that was measured where the design has one.
/// The wound part lies in the shade, in still air. By its package it is as warm as the hottest turn
/// (drum_package.hpp), which also its resistance is taken for; by a derating it gives off the
/// square of that of what it would laid out. For a design that `is_heated`; the flight must outlive
/// this.
class TetherHeat {
 public:
  /// `radius` in m of the conductors. All but the sun, and a winch that leaves more on the drum,
  /// makes a thicker cable cooler at the same current; for bounds the sun shines on one of
  /// `sunlit_radius`, and no more is on the drum than with that one.
  TetherHeat(const SteadyFlight& flight, double radius, double sunlit_radius);

  /// On the cable itself.
  TetherHeat(const SteadyFlight& flight, double radius) : TetherHeat(flight, radius, radius) {}

  /// Steady temperatures at `current` A (≥ 0); nothing where there are none below
  /// `highest_conductor_temperature_C`.
  [[nodiscard]] std::optional<TetherTemperatures> temperatures(double current) const;

  /// Resistance of the loop in Ω at these temperatures.
  [[nodiscard]] double resistance(const TetherTemperatures& temperatures) const;

  /// The coolest state in which power, current and temperature agree, which is the one that a cold
  /// tether warms up to. `load_power` in W at the drone. Sooner where `near` is the steady state of
  /// about this cable and load.
  ///
  /// Newton's method on current and temperatures at once, which is believed where it ends in a
  /// state that a little more current does not leave; elsewhere step by step. The current that a
  /// resistance asks for rises with it, and the resistance with the current, so that the states
  /// visited from a cold start on rise towards the coolest; the map is convex but for the air's
  /// properties, so that Newton's steps from there hardly overshoot it, and one that points away
  /// from it proves that there is none: the tether runs away.
  /// Resistance and current are exact to about the square of `last_step`, that of the last step
  /// relative to rise and current.
  [[nodiscard]] TetherHeatState carrying(double load_power, const TetherHeatState& near = {},
                                         double last_step = finest_step) const;

  static constexpr double finest_step = 1e-6;  ///< near runaway errors grow

 private:
  /// What a current makes of the loop: the temperatures, its resistance in Ω with the derivatives
  /// by the current and, at the same current, by the radius.
  struct Loop {
    TetherTemperatures temperatures;
    double resistance = 0;
    double by_current = 0;
    double by_radius = 0;
  };
  /// The conductor of a part of the tether: balanced, or as its heating was measured.
  [[nodiscard]] ConductorHeat::Balance measured(double current) const;
  [[nodiscard]] Loop loop(const ConductorHeat::Balance& in_air,
                          const ConductorHeat::Balance& on_drum) const;
  [[nodiscard]] std::optional<Loop> warmed(double current) const;
  /// About what the state of a cable like this one, with a load like this one, is here.
  [[nodiscard]] TetherHeatState moved_here(const TetherHeatState& near, double load_power) const;
  [[nodiscard]] TetherHeatState jointly(double load_power, const TetherHeatState& start,
                                        double last_step) const;
  [[nodiscard]] TetherHeatState step_by_step(double load_power, double current) const;
  /// Infinite where the power cannot be delivered.
  [[nodiscard]] double demanded_current(double load_power, double resistance) const;

  const SteadyFlight& flight_;
  double radius_;
  bool measured_;
  bool wound_;  ///< there is cable on a drum whose cooling is known
  ConductorHeat in_air_;
  ConductorHeat on_drum_;
  double at_zero_;             ///< Ω of the loop, both parts at 0 °C
  double per_kelvin_in_air_;   ///< Ω/K
  double per_kelvin_on_drum_;  ///< Ω/K
};

}  // namespace tethercalc
