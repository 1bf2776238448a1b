// Somebody who remembers solved cables of many designs.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>

#include "model/load_series.hpp"
#include "model/similar_cables.hpp"

namespace tethercalc {

/// Solved cables among which others are looked up.
struct KnownCables {
  std::size_t most = 0;  ///< of each kind; then all are forgotten
  std::map<HangingSituation, std::shared_ptr<const SimilarCables>> similar{};
  std::map<HangingSituation, std::shared_ptr<const HangingLoad>> loads{};
};

/// Those of the situation's memory, or of the thread.
[[nodiscard]] KnownCables& known_cables(const HangingSituation& situation);

/// Asked for loads of cables. A class of its own kind implements it, so that a program that
/// computes no sweeps does not hold what only those pay for.
class CableMemory {
 public:
  virtual ~CableMemory() = default;

  /// Of cables with this memory; they end with it.
  [[nodiscard]] KnownCables& known() const { return known_; }

  /// Octaves of drag over weight that a piece spans at most; others are halves of halves of that.
  [[nodiscard]] virtual double widest() const = 0;
  /// Whether forces over a piece of drag over weight are a series.
  enum class Piece { smooth, halved, too_sharp, not_known };
  /// Those of `normal` over the octaves from `from` to `from` + `width`, counted from
  /// `first_ratio`: against the wind, down, tension at the drone and at the ground.
  [[nodiscard]] virtual Piece along_ratio(const HangingSituation& normal, double from, double width,
                                          LoadSeries<4>& series) const = 0;

  /// Shares of a load, with the length in m, and their slopes by the logarithm of the radius.
  struct AtRadius {
    bool hangs = true;  ///< else no cable with this radius does
    LoadShares value{};
    LoadShares slope{};
  };
  /// Those of a cable of which the radius decides more than drag over weight
  /// (`normal_but_for_radius`); nothing where they are not known.
  [[nodiscard]] virtual std::optional<AtRadius> at_radius(const HangingSituation& situation,
                                                          double radius) const = 0;

 private:
  mutable KnownCables known_{64, {}, {}};  // a row has a few
};

}  // namespace tethercalc
