// The loads of cables that differ by nothing but the wind's drag over their weight.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>

#include "model/load_series.hpp"
#include "tethercalc/model/tether_load.hpp"

namespace tethercalc {

/// A load over the cable's own (`own_load`): against the wind, down, tension at the drone, tension
/// at the ground, across the wind; and m of cable in the air.
using LoadShares = std::array<double, 6>;

/// Drag over weight in normal form from which octaves are counted: where forces are least smooth. A
/// cable above its station ceases to be a fold there; to one aside in an even wind that blows over
/// the station weight and drag across the chord, offset/chord and ratio·(height/chord)², balance.
/// Else 1.
[[nodiscard]] double first_ratio(const HangingSituation& normal);

/// Cable beyond the height, over that; 0 for a drone aside or in motion.
[[nodiscard]] double slack_above_station(const HangingSituation& situation);

/// Of a solver whose loads are remembered.
constexpr int most_steps_for_load = 8000;
/// Of a logarithm: half of the solver's digits for a slope, and no more error than its square.
constexpr double slope_step = 1e-4;

/// N, and N/m of the radius.
struct OwnLoad {
  double value = 0;
  double slope = 0;
};

/// N/m of the cable with conductors of `radius`, and its derivative by that.
[[nodiscard]] double weight_at(const HangingSituation& situation, double radius);
[[nodiscard]] double weight_slope_at(const HangingSituation& situation, double radius);

/// hypot(weight, drag)·height + winch tension.
[[nodiscard]] OwnLoad own_load(const HangingSituation& situation, double radius);

/// Solves the cable with conductors of `radius`, from the solver's last solution.
CableOutcome solve_shares(const HangingSituation& situation, CableSolver& solver, double radius,
                          LoadShares& shares);

/// Cables of one length over their height, of one place of the drone and one profile of the wind
/// over it, that do not stretch and have one drag coefficient. Forces over the cable's own load
/// then depend on drag over weight alone, and are solved once for all sizes of conductor, speeds of
/// the wind, densities and, but for a profile, heights.
///
/// Over the logarithm of drag over weight they are polynomials of degree 8 through as many solved
/// cables (Chebyshev's points) on a quarter of an octave (a memory may have wider pieces), or on
/// halves of halves of it until what they miss is about 1e-9 of the tension. Where wind and weight
/// balance along the chord forces turn by x·ln x: in the last 1/1024 of an octave about that the
/// cable is solved where it is asked for. A piece is always the same, whatever was asked for
/// before. Remembers what it solved; not for two threads at once.
class SimilarCables {
 public:
  /// Those that hang like `situation`; null where more than drag over weight tells them apart. One
  /// for all that ask in a thread.
  [[nodiscard]] static std::shared_ptr<const SimilarCables> of(const HangingSituation& situation);

  /// `normal` as `normal_form` has it. What its memory knows is taken from there.
  explicit SimilarCables(const HangingSituation& normal);

  /// What a load is over the cable's own, and its derivative by the logarithm of drag over weight.
  struct At {
    LoadShares value{};
    LoadShares slope{};
  };
  /// Nothing where no equilibrium is found.
  [[nodiscard]] std::optional<At> at(double drag_over_weight) const;

 private:
  /// Forces, without the one across, of which there is none, and the length.
  static constexpr std::size_t forces = 4;
  using Series = LoadSeries<forces>;

  /// A part of an octave of drag over weight.
  struct Piece {
    enum class Kind { unknown, smooth, halved, solved_where_asked } kind = Kind::unknown;
    LoadSeries<2 * forces> value_and_slope{};  ///< by the logarithm; one recurrence has both
    std::unique_ptr<std::array<Piece, 2>> halves{};
  };
  void make(Piece& piece, double from, double width) const;
  [[nodiscard]] bool fit(Series& value, double from, double width) const;
  [[nodiscard]] At on(const Piece& piece, double share) const;
  [[nodiscard]] std::optional<At> solved_at(double drag_over_weight) const;

  HangingSituation normal_;
  double first_;                         ///< drag over weight where octaves begin
  double widest_;                        ///< octaves of a piece
  bool folds_;                           ///< below that the cable is a fold
  mutable std::map<int, Piece> pieces_;  ///< the widest, by their number from there
  mutable std::optional<At> still_;      ///< without wind
};

/// `situation` with a weight of 1 N/m, a height of 1 m and the drag over the weight as the radius;
/// nothing where more than that decides how its cable hangs.
[[nodiscard]] std::optional<HangingSituation> normal_form(const HangingSituation& situation);

/// The same also where the conductor's radius decides one thing more: of a winch its tension over
/// weight times height, of drag by the Reynolds number that number in the wind at its reference
/// height. Each is given as 1.
[[nodiscard]] std::optional<HangingSituation> normal_but_for_radius(
    const HangingSituation& situation);

/// Drag over weight with conductors of `radius`, and its derivative by that.
struct DragOverWeight {
  double value = 0;
  double slope = 0;  ///< 1/m
};
[[nodiscard]] DragOverWeight drag_over_weight(const HangingSituation& situation, double radius);

}  // namespace tethercalc
