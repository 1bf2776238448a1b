// What a solved tether puts on the drone in the thousands of states of a log.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "tethercalc/model/tether_load.hpp"

namespace tethercalc {

/// The loads of hanging cables, between those at places of a grid that are solved once each, by
/// cubics. Drag over weight and what is paid out over the height decide how a cable hangs; with a
/// drone aside, stretch, or a profile of the wind that has a height of its own, the height as well;
/// with a drag by the Reynolds number that.
/// A search moves these a little from one prediction of a log to the next, so most places are known
/// already. The places do not move: a load is a continuous function of all that is asked.
///
/// Mostly within 1e-5 of the solver, of the greatest force. A cable that its winch is too weak for
/// is taken to hang where it pulls at the winch the least. Not for two threads at once.
class HangingLoads {
 public:
  /// The load with conductors of `radius` > 0 m; +infinity where the cable cannot hang.
  [[nodiscard]] HangingLoad::Parts at(const HangingSituation& situation, double radius);

  /// What more decides how a cable hangs.
  struct ThirdAxis {
    enum Number { none, height, reynolds_number } of = none;
    double places_per_octave = 1;
  };

 private:
  /// Of a cable on a winch, by the length it has: the tension follows with that smoothly where the
  /// length follows with the tension's root.
  [[nodiscard]] HangingLoad::Parts by_length(HangingSituation situation, double radius);

  static constexpr std::size_t part_count = 6;
  using Values = std::array<double, part_count>;  ///< over the cable's own load, or the distance
  using Place = std::array<int, 3>;
  /// A cable of the grid, and the loads about the places that it is the first corner of.
  struct Known {
    bool is_solved = false;
    std::optional<Values> values{};  ///< of the cable, where it hangs
    bool has_corners = false;
    std::vector<Values> corners{};  ///< 4 along each axis, the last axis innermost; none: no cubic
  };
  /// Cables that hang alike at the same place.
  struct Family {
    HangingSituation alike;   ///< what they share
    HangingSituation member;  ///< whichever was asked for first
    double radius = 0;
    ThirdAxis third{};
    std::map<Place, Known> known{};
  };
  [[nodiscard]] Family& family_of(const HangingSituation& situation, double radius);
  [[nodiscard]] static const std::optional<Values>& solved_at(Family& family, const Place& place);
  [[nodiscard]] static const std::vector<Values>& corners_of(Family& family, const Place& first);

  std::vector<Family> families_;  ///< few
};

}  // namespace tethercalc
