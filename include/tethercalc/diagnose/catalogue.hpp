// The catalogue of effects: every cause that a diagnosis can name.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tethercalc {

struct Design;            // model/design.hpp
struct FlightPrediction;  // diagnose/flight_prediction.hpp
struct Observations;      // identify/observations.hpp
struct PowerModel;        // diagnose/power_chain.hpp

/// Where in the chain from the ground to the air an effect acts.
enum class Stage { supply, tether, converter, motors, airframe };

/// What an effect of a flight acts on; the prediction is made in this order.
enum class FlightPhase {
  attitude,  ///< the tilt that the thrust had
  air,       ///< the headwind and the drag law
  force,     ///< the drag, once airspeed and drag law are known
  reading,   ///< the acceleration: what answers all forces, then how the log's instruments tell it
};

/// Values of a parameter that are looked through before anything is fitted.
enum class LookThrough {
  nothing,
  moments,  ///< of the log's clock, from 5 to 95 % of its duration; s
  periods,  ///< from one and a half durations of the log down to the parameter's lower bound; s
  ratios,   ///< from the lower bound, > 0, to the upper one, each a quarter more than the last
};

/// What a flight must have to show a parameter. Across the heading a force or a wind does nothing
/// that the forward acceleration shows.
enum class Shown {
  always,
  to_the_side,             ///< an acceleration to the right that follows the roll
  turning_or_to_the_side,  ///< that, or a heading that turns
};

/// The log that can show an effect.
enum class LogKind { flight, power };

/// A parameter of an effect as the catalogue lists it.
struct EffectParameter {
  std::string name{};  ///< with its unit, as in the result: "pitch_trim_deg"
  std::string unit{};  ///< as printed: "deg"; "1" for a plain number
  double unit_SI = 1;  ///< one such unit in SI
  double neutral = 0;  ///< in `unit`, as are the next three
  double lower = 0;    ///< physical bound; above neutral where the effect begins with a leap
  double upper = 0;    ///< physical bound
  double scale = 1;    ///< a change that matters
  std::string
      spec_field{};  ///< JSON path in the design spec that takes it; empty: ends with the flight
  /// The neutral value, in SI, where a design has one of its own; null: `neutral` for every design.
  double (*in_design)(const Design&) = nullptr;
  double start = 0;  ///< in `unit`, beyond neutral: the first value that a search tries
  /// Parameter of the base model whose product with this one enters the prediction linearly; that
  /// is tested against chance. Empty: this one enters by itself.
  std::string product_with{};
  LookThrough look_through = LookThrough::nothing;  ///< moments have the bounds of the log only
  Shown shown = Shown::always;                      ///< stays neutral in a flight that is not so
};

/// One entry.
struct Effect {
  std::string id{};                           ///< as in results and in --base
  std::string title{};                        ///< what a person calls it
  std::string mechanism{};                    ///< one sentence
  LogKind log = LogKind::flight;              ///< which log can show it
  Stage stage = Stage::airframe;              ///< where it acts
  std::vector<EffectParameter> parameters{};  ///< its size first
  std::size_t sizes = 1;  ///< so many; with them neutral the other parameters change nothing
  /// Channels beyond those every log of its kind has, named as in the log; the bus by its voltage
  /// and current, which its power may stand for.
  std::vector<std::string> needs{};
  std::string to_separate{};  ///< what flight or channel tells it from its like
  std::string change{};       ///< the change of the prediction as a formula
  std::string channel{};      ///< where it shows, an id as in `diagnose/log_model.hpp`

  /// Why a log may not show it beside the base model, where that has one reason; else empty.
  std::string aliased_because{};

  /// Why no flight shows this effect of a power log, whatever its channels; else empty.
  std::string no_flight_shows_because{};

  /// A flight must gain so many times the usual minimum by it: where some of it is always there, as
  /// of an air that is never quite steady, or where many other things look a little like it.
  double least_gain_factor = 1;

  std::string replaces{};  ///< id of a coarser effect that this one describes in more detail

  /// Belongs to one flight, like the wind: of several flights of one drone each has its own.
  bool own_in_each_flight = false;

  /// Fitted in the first look at a flight, before anything is tested: airspeed and drag are wrong
  /// without it.
  bool in_first_look = false;

  FlightPhase flight_phase = FlightPhase::force;  ///< for effects of a flight
  /// How it changes the prediction of a flight; values in SI, in the order of `parameters`. Null
  /// for effects of power logs.
  std::function<void(FlightPrediction&, std::span<const double>)> on_flight{};

  /// Where its first parameter is looked for in a flight, in SI, where the fit would not find there
  /// from the neutral value; null: there.
  double (*starts_at)(const Observations&, double gravity) = nullptr;

  /// How it changes the model of a power log, which must not contain the effect already; values in
  /// SI, in the order of `parameters`. Null for effects of flight logs.
  std::function<void(PowerModel&, std::span<const double>)> on_power{};
  /// The stages of a power log whose comparison it changes: tether, converter or motors; and
  /// airframe, where it changes how far the drone of the same flight leans.
  std::vector<Stage> shows_in{};
  /// Says something of the tether in the air, which the motors carry: no free flight shows it.
  bool of_tether = false;
  /// Changes how a solved tether hangs. On a winch, which lets out what its tension asks for, the
  /// loss in the tether shows that as well.
  bool bends_tether = false;
  /// id of an effect before it in the catalogue that every log on a straight tether shows in the
  /// same way. It is told with that one, never in its place.
  std::string twin_of{};
  /// What a spec would need for any log to show the effect, in words; "" where it has that. Null
  /// where every spec has.
  std::string (*lacking_in)(const Design&) = nullptr;
  /// Its first parameter is a time by which a channel of a flight is late. What is late by less
  /// than the time between samples is told together with its like: the log does not show which.
  bool is_delay = false;
};

/// All effects; the order is that of the documentation.
[[nodiscard]] std::span<const Effect> effect_catalogue();

/// Those that such logs can show.
[[nodiscard]] std::span<const Effect> effect_catalogue(LogKind kind);

/// The entry of `id`, or null.
[[nodiscard]] const Effect* find_effect(std::string_view id);

/// An id as a sentence has it: "tether sag" of "tether_sag", with what follows it, as a flight.
[[nodiscard]] std::string in_words(std::string id);

/// "supply", "tether", "converter", "motors" or "airframe".
[[nodiscard]] std::string_view to_string(Stage stage);

/// "flight" or "power".
[[nodiscard]] std::string_view to_string(LogKind kind);

}  // namespace tethercalc
