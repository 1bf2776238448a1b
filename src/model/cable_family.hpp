// Loads of cables that differ by the wind's drag over their weight and by one number more.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "model/cable_memory.hpp"
#include "model/load_series.hpp"
#include "tethercalc/model/design.hpp"

namespace tethercalc {

/// The number that tells cables apart beside drag over weight.
enum class CableNumber {
  slack,      ///< length over the distance to the drone, less 1
  aside,      ///< how far the drone stands aside, over its height
  own_speed,  ///< share of the wind that no profile shapes, `MovingAir::even_share`
  /// What gives the wind's profile its length over the height: the roughness or, under a power
  /// law, the station's height, each in proportion to the other. `MovingAir::even_share` follows
  /// for a wind that is the same at a height which stays, beside one airspeed of the drone's own.
  profile_under_one_wind,
  profile_under_drone,  ///< the same where that share stays, for a wind that is given at the drone
  winch_tension,        ///< over weight times height
  /// The same over the least that holds such a cable in an even wind. In the root of its logarithm
  /// forces are smooth down to there, where by the tension itself they turn without end.
  winch_over_least,
  /// Reynolds number of one conductor over the root of drag over weight, both of all the wind and
  /// this without the cylinder's coefficient: the wind's speed has no part in it.
  reynolds,
};

/// Of cables in normal form on a winch in an even wind: the least tension that holds them up, by
/// octaves of drag over weight from `first_ratio`. Not for two threads at once.
class LeastWinchTension {
 public:
  /// `one` is any of these cables.
  explicit LeastWinchTension(const HangingSituation& one) : one_(one) {}

  /// Natural logarithms: of the tension over weight times height, and its slope by that of the
  /// ratio.
  struct At {
    double value = 0;
    double slope = 0;
  };
  /// To about 1e-9. Nothing where there is none, or it turns sharply: about where a straight cable
  /// leads to the drone, which any tension holds.
  [[nodiscard]] std::optional<At> at(double octaves) const;

 private:
  struct Piece {
    enum class Kind { unknown, smooth, halved, given_up } kind = Kind::unknown;
    LoadSeries<2> value_and_slope{};
    std::unique_ptr<std::array<Piece, 2>> halves{};
  };
  void make(Piece& piece, double from, double width) const;
  /// The tension itself.
  [[nodiscard]] std::optional<double> solved_at(double octaves) const;

  HangingSituation one_;
  mutable std::map<int, Piece> pieces_;  ///< by octave
};

/// In normal form, cables of every drag over weight and every value of the number.
///
/// Over the logarithm of drag over weight, as in `SimilarCables`, and the number's scale forces are
/// polynomials of degree 8 in both through 81 solved cables, on squares of a quarter of an octave
/// to two, as the number has them, or on halves of halves of those until what they miss is about
/// 1e-9 of the tension. Where the number varies with the radius that is 1e-7: a cubic between radii
/// then has the load. Of drag by the Reynolds number the ratio is that of the drag across all of
/// the wind, its coefficient included. A square is always the same, whatever was asked for before.
/// Remembers what it solved; not for two threads at once.
class CableFamily {
 public:
  /// `one` is any cable of it.
  CableFamily(const HangingSituation& one, CableNumber number)
      : one_(one), number_(number), least_tension_(one) {}

  /// As `CableMemory` has them, where the number has its `place`: its logarithm to base 2, but of
  /// the share, which may be 0, four times that.
  [[nodiscard]] CableMemory::Piece along_ratio(double from, double width, double place,
                                               LoadSeries<4>& series) const;

  /// Shares of a load, and their slopes by the natural logarithms of ratio and number.
  struct At {
    bool hangs = true;  ///< else no such cable does
    LoadShares value{};
    LoadShares by_ratio{};
    LoadShares by_number{};
  };
  /// Nothing where forces are too sharp, or no cable hangs, about there. Of `winch_over_least` the
  /// number is the winch's tension over weight times height.
  [[nodiscard]] std::optional<At> at(double drag_over_weight, double number) const;

 private:
  static constexpr std::size_t parts = std::tuple_size_v<LoadShares>;
  /// A series of the number for each term of a series of the ratio.
  static constexpr std::size_t terms = parts * (load_degree + 1);
  /// The series of the ratio at one place of the number, and their slopes by its logarithm.
  struct Along {
    LoadSeries<parts> value{};
    LoadSeries<parts> by_number{};
  };
  struct Square {
    enum class Kind { unknown, smooth, halved_by_ratio, halved_by_number, given_up };
    Kind kind = Kind::unknown;
    std::unique_ptr<LoadSeries<terms>> series{};
    std::unordered_map<double, Along> along{};  ///< by the place: rows of a sweep have the same
    std::unique_ptr<std::array<Square, 2>> halves{};
  };
  /// Where a square begins, and how wide it is.
  struct Bounds {
    double ratio = 0;
    double ratio_width = 0;
    double number = 0;
    double number_width = 0;
  };
  /// The radius is the ratio, at so many octaves; nothing where no tension is the least.
  [[nodiscard]] std::optional<HangingSituation> cable_at(double place, double octaves) const;
  [[nodiscard]] std::optional<At> at_place(double octaves, double place) const;
  [[nodiscard]] std::optional<At> above_least(double octaves, double tension) const;
  void make(Square& square, const Bounds& bounds) const;
  /// What the cables of a square are, as far as they were solved.
  enum class Found { smooth, bends_by_ratio, bends_by_number, not_all_hang };
  /// The series of those that are smooth.
  [[nodiscard]] Found solve(const Bounds& bounds, LoadSeries<terms>& series) const;
  /// The square about a point that is not halved, or by number alone down to this width by ratio.
  [[nodiscard]] std::pair<Square*, Bounds> square_about(double octaves, double place,
                                                        double narrowest = 0) const;

  /// Of a smooth square.
  [[nodiscard]] static const Along& along_at(Square& square, const Bounds& bounds, double place);

  HangingSituation one_;
  CableNumber number_;
  LeastWinchTension least_tension_;                        ///< of `winch_over_least`
  mutable std::map<std::pair<int, int>, Square> squares_;  ///< the widest, by their numbers
};

/// The families of one number, for designs that differ by it. Not for two threads at once.
class CableFamilies : public CableMemory {
 public:
  explicit CableFamilies(CableNumber number) : number_(number) {}
  [[nodiscard]] double widest() const override;
  [[nodiscard]] Piece along_ratio(const HangingSituation& normal, double from, double width,
                                  LoadSeries<4>& series) const override;
  [[nodiscard]] std::optional<AtRadius> at_radius(const HangingSituation& situation,
                                                  double radius) const override;

 private:
  /// A family, and of cables on a winch in an even wind that near their least tension.
  struct Family {
    CableFamily all;
    std::optional<CableFamily> near_least{};
  };
  /// That of the cable; null where it has no such number.
  [[nodiscard]] const Family* family_of(const HangingSituation& normal) const;
  /// That of a cable whose number varies with the radius.
  [[nodiscard]] const Family* family_by_radius(const HangingSituation& situation) const;

  CableNumber number_;
  mutable std::map<HangingSituation, Family> families_;
  /// Of the last two situations, which a row asks for with many radii.
  struct Asked {
    HangingSituation situation;
    const Family* family = nullptr;
  };
  mutable std::array<Asked, 2> asked_;
};

/// The only number by which the solved tethers of these designs differ in hover and in forward
/// flight, beside drag over weight; nothing where none or more do, or few of the cables differ.
[[nodiscard]] std::optional<CableNumber> told_apart_by(std::span<const Design> designs);

}  // namespace tethercalc
