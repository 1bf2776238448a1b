#include "model/cable_family.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "model/planar_cable.hpp"
#include "model/wind_profile.hpp"

namespace tethercalc {
namespace {

/// Of squares in which not all cables hang: narrower ones along that border would be many. Where
/// that is known, cables about it are told apart by it instead.
constexpr double narrowest_square = 1.0 / 32;
constexpr double narrowest_above_least = 1.0 / 4;
/// Of the root of a tension's logarithm over the least: over half of it forces bend as over an
/// octave. Cables are solved from there on; those yet nearer are what the series come to before it.
constexpr double root_scale = 2;
constexpr double first_place_above_least = 0.05;
/// Of the share of the wind that no profile shapes: over a quarter of it forces bend as over an
/// octave.
constexpr double share_scale = 4;

/// Whether the least tension that holds such cables is known, in an even wind.
bool knows_least_tension(const HangingSituation& one, CableNumber number) {
  return number == CableNumber::winch_tension && one.air.profile == WindProfile::uniform;
}

bool varies_with_radius(CableNumber number) {
  return number == CableNumber::winch_tension || number == CableNumber::reynolds;
}

/// How wide squares are at most, in octaves, and what last terms may be of the tension.
struct Fineness {
  double ratio = widest_piece;
  double number = widest_piece;
  double little = little_of_tension;
};

/// Between radii a load is a cubic, which misses by 1e-5. By the Reynolds number and a profile's
/// length forces bend little, and in light winds little by drag over weight, too: that pays where
/// the general method solves each cable.
Fineness fineness_of(CableNumber number) {
  constexpr double little_by_radius = 1e-7;
  switch (number) {
    case CableNumber::winch_tension:
    case CableNumber::winch_over_least:
      return {.ratio = 1, .little = little_by_radius};
    case CableNumber::reynolds:
      return {.ratio = 2, .number = 1, .little = little_by_radius};
    case CableNumber::own_speed:
      return {.ratio = 2, .number = 1};
    case CableNumber::profile_under_one_wind:
    case CableNumber::profile_under_drone:
      return {.ratio = 2, .number = 2};
    case CableNumber::slack:
    case CableNumber::aside:
      break;
  }
  return {};
}

double slack_of(const HangingSituation& normal) {
  return normal.paid_out.length.value_or(0) / std::hypot(1, normal.offset) - 1;
}

/// The same to its last digit for all cables that differ by rounding.
double rounded(double x) {
  constexpr double digits = 1e12;
  return std::round(x * digits) / digits;
}

/// What gives a profile its length: the roughness or, under a power law, the station's height.
double profile_length(const MovingAir& air) {
  switch (air.profile) {
    case WindProfile::uniform:
      break;
    case WindProfile::power_law:
      return air.station_height;
    case WindProfile::logarithmic:
      return air.roughness_length;
  }
  return 0;
}

/// The wind at the reference height over that at one which is so many of the profile's lengths, but
/// for a factor.
double growth_to_reference(const MovingAir& air) {
  const double lengths = air.reference_height / profile_length(air);
  return air.profile == WindProfile::power_law ? std::pow(lengths, air.exponent)
                                               : std::log(lengths);
}

/// The same profile under a drone so much lower or higher that its length over the height is
/// `length`; the wind at the drone is as much, or follows the profile beside the drone's own
/// airspeed.
MovingAir under_other_height(const MovingAir& air, double length, bool one_wind) {
  MovingAir other = air;
  other.station_height = rounded(air.station_height / profile_length(air)) * length;
  other.reference_height = other.station_height + 1;
  if (air.profile == WindProfile::logarithmic) other.roughness_length = length;
  if (one_wind && air.even_share > 0) {
    const double wind_over_own =
        (1 / air.even_share - 1) * growth_to_reference(other) / growth_to_reference(air);
    other.even_share = rounded(1 / (1 + wind_over_own));
  }
  return other;
}

double number_in(const HangingSituation& normal, CableNumber number) {
  switch (number) {
    case CableNumber::slack:
      return slack_of(normal);
    case CableNumber::aside:
      return normal.offset;
    case CableNumber::own_speed:
      return normal.air.even_share;
    case CableNumber::profile_under_one_wind:
    case CableNumber::profile_under_drone:
      return profile_length(normal.air);
    case CableNumber::winch_tension:
    case CableNumber::winch_over_least:
      return normal.paid_out.winch_tension.value_or(0);
    case CableNumber::reynolds:
      return normal.cylinder ? (*normal.cylinder)[0] : 0;
  }
  return 0;
}

HangingSituation with_number(HangingSituation normal, CableNumber number, double value) {
  const double slack = number == CableNumber::slack ? value : rounded(slack_of(normal));
  switch (number) {
    case CableNumber::slack:
      break;
    case CableNumber::aside:
      normal.offset = value;
      break;
    case CableNumber::own_speed:
      // A drone that hovers has none in any wind.
      if (normal.air.even_share > 0) normal.air.even_share = value;
      break;
    case CableNumber::profile_under_one_wind:
    case CableNumber::profile_under_drone:
      normal.air =
          under_other_height(normal.air, value, number == CableNumber::profile_under_one_wind);
      break;
    case CableNumber::winch_tension:
    case CableNumber::winch_over_least:
      normal.paid_out.winch_tension = value;
      break;
    case CableNumber::reynolds:
      normal.cylinder = {value, 0};
      break;
  }
  if (normal.paid_out.length) normal.paid_out.length = (1 + slack) * std::hypot(1, normal.offset);
  return normal;
}

/// One cable for all that differ by the number: of a profile's lengths few are as much as a drone's
/// height, up to which there would be no wind.
HangingSituation without_number(const HangingSituation& normal, CableNumber number) {
  constexpr double usual_length = 1e-3;
  const bool of_profile =
      number == CableNumber::profile_under_one_wind || number == CableNumber::profile_under_drone;
  return with_number(normal, number, of_profile ? usual_length : 1);
}

/// The cable with the Reynolds number of the wind whose drag is `ratio` times the weight: without a
/// cylinder's coefficient it is `bare` times that. The radius of the normal form is `ratio` as
/// well; a hair more than that, it is no fold where those end, whatever is rounded.
HangingSituation in_wind_of(HangingSituation cable, double ratio) {
  if (!cable.cylinder) return cable;
  constexpr double hair_more = 1 + 1e-12;
  constexpr int enough = 20;  // of Newton's steps, which need about five
  const double over_root = (*cable.cylinder)[0];
  double bare = ratio;
  for (int i = 0; i < enough; ++i) {
    const double reynolds = over_root * std::sqrt(bare);
    const CylinderDrag drag = cylinder_drag(reynolds);
    const double growth = 1 + 0.5 * reynolds * drag.slope / drag.coefficient;
    bare *= std::exp(-std::log(bare * drag.coefficient / ratio) / growth);
  }
  cable.cylinder = {over_root * std::sqrt(bare), 0};
  cable.drag_coefficient = hair_more * bare / ratio;
  return cable;
}

double ratio_at(const HangingSituation& cable, double octaves) {
  return first_ratio(cable) * std::exp2(octaves);
}

bool has_number(const HangingSituation& normal, CableNumber number) {
  constexpr double most_share = 2;  // which stands for more
  const MovingAir& air = normal.air;
  switch (number) {
    case CableNumber::own_speed:
      return air.profile != WindProfile::uniform;
    case CableNumber::profile_under_one_wind:
    case CableNumber::profile_under_drone:
      return profile_length(air) > 0 && !is_still(air) && air.even_share < most_share;
    case CableNumber::slack:
    case CableNumber::aside:
    case CableNumber::winch_tension:
    case CableNumber::winch_over_least:
    case CableNumber::reynolds:
      break;
  }
  return number_in(normal, number) > 0;
}

double place_of(const HangingSituation& normal, CableNumber number) {
  const double value = number_in(normal, number);
  return number == CableNumber::own_speed ? share_scale * value : std::log2(value);
}

/// Of a square's terms, each with a series of the ratio, that series where the terms have such
/// weights, without its parts beyond.
template <std::size_t Parts, std::size_t Terms>
LoadSeries<Parts> weighed(const LoadSeries<Terms>& square,
                          const std::array<double, load_degree + 1>& weights) {
  constexpr std::size_t all = Terms / (load_degree + 1);
  LoadSeries<Parts> series{};
  for (std::size_t j = 0; j <= load_degree; ++j) {
    for (std::size_t k = 0; k <= load_degree; ++k) {
      for (std::size_t i = 0; i < Parts; ++i) series[k][i] += weights[j] * square[j][k * all + i];
    }
  }
  return series;
}

}  // namespace

std::optional<double> LeastWinchTension::solved_at(double octaves) const {
  return least_winch_tension({.weight = 1,
                              .drag = one_.air.wind.x * first_ratio(one_) * std::exp2(octaves),
                              .aside = one_.offset,
                              .height = 1});
}

void LeastWinchTension::make(Piece& piece, double from, double width) const {
  LoadSeries<1> logarithm{};
  bool is_known = true;
  for (std::size_t j = 0; j <= load_degree && is_known; ++j) {
    const auto least = solved_at(load_place(from, width, j));
    is_known = least.has_value();
    if (is_known) logarithm[j][0] = std::log(*least);
  }
  logarithm = series_through(logarithm);
  if (is_known && is_converged(logarithm, 1)) {
    const LoadSeries<1> slope = slope_of(logarithm, width);
    for (std::size_t k = 0; k <= load_degree; ++k) {
      piece.value_and_slope[k] = {logarithm[k][0], slope[k][0]};
    }
    piece.kind = Piece::Kind::smooth;
  } else if (width > narrowest_piece) {
    piece.halves = std::make_unique<std::array<Piece, 2>>();
    piece.kind = Piece::Kind::halved;
  } else {
    piece.kind = Piece::Kind::given_up;
  }
}

std::optional<LeastWinchTension::At> LeastWinchTension::at(double octaves) const {
  const auto [piece, from, width] =
      piece_about(pieces_, octaves, 1, [this](Piece& p, double f, double w) { make(p, f, w); });
  if (piece->kind == Piece::Kind::given_up) return std::nullopt;
  const auto [value, slope] = value_at(piece->value_and_slope, 2 * (octaves - from) / width - 1);
  return At{value, slope};
}

std::optional<HangingSituation> CableFamily::cable_at(double place, double octaves) const {
  double number = std::exp2(place);
  if (number_ == CableNumber::own_speed) {
    number = place / share_scale;
  } else if (number_ == CableNumber::winch_over_least) {
    const auto least = least_tension_.at(octaves);
    if (!least) return std::nullopt;
    const double root = (place + first_place_above_least) / root_scale;
    number = std::exp(least->value + root * root);
  }
  const HangingSituation cable = with_number(one_, number_, number);
  return in_wind_of(cable, ratio_at(cable, octaves));
}

CableFamily::Found CableFamily::solve(const Bounds& bounds, LoadSeries<terms>& series) const {
  const double little = fineness_of(number_).little;
  double tension = 0;
  bool by_ratio = true;
  LoadSeries<terms> solved{};  // by place of the number, each a series of the ratio
  // By the first place of the number each cable is solved from the one beside it, and from there on
  // along the number, by which they differ least.
  std::vector<CableSolver> solvers(load_degree + 1, CableSolver(most_steps_for_load));
  for (std::size_t i = 0; i <= load_degree; ++i) {
    const auto cable = [&](std::size_t of_number, std::size_t of_ratio) {
      return cable_at(load_place(bounds.number, bounds.number_width, of_number),
                      load_place(bounds.ratio, bounds.ratio_width, of_ratio));
    };
    if (i > 0 && cable(i, 0) == cable(i - 1, 0)) {
      solved[i] = solved[i - 1];
      continue;
    }
    LoadSeries<parts> along{};
    for (std::size_t j = 0; j <= load_degree; ++j) {
      if (i == 0 && j > 0) solvers[j] = solvers[j - 1];
      LoadShares& shares = along[j];
      const auto one = cable(i, j);
      if (!one) return Found::not_all_hang;
      const double ratio = ratio_at(*one, load_place(bounds.ratio, bounds.ratio_width, j));
      if (solve_shares(*one, solvers[j], ratio, shares) != CableOutcome::hangs) {
        return Found::not_all_hang;
      }
      tension = std::max(tension, shares[2]);
    }
    along = series_through(along);
    // In narrow ones it matters more whether all hang: they are given up sooner where not.
    const bool is_wide = bounds.ratio_width > narrowest_square;
    by_ratio = by_ratio && is_converged(along, tension, little);
    if (is_wide && !by_ratio) return Found::bends_by_ratio;
    for (std::size_t k = 0; k <= load_degree; ++k) {
      std::copy_n(along[k].begin(), parts,
                  solved[i].begin() + static_cast<std::ptrdiff_t>(k * parts));
    }
  }
  series = series_through(solved);
  if (!by_ratio) return Found::bends_by_ratio;
  return is_converged(series, tension, little) ? Found::smooth : Found::bends_by_number;
}

void CableFamily::make(Square& square, const Bounds& bounds) const {
  using Kind = Square::Kind;
  LoadSeries<terms> series{};
  const Found found = solve(bounds, series);
  if (found == Found::smooth) {
    square.series = std::make_unique<LoadSeries<terms>>(series);
    square.kind = Kind::smooth;
    return;
  }
  const bool hangs = found != Found::not_all_hang;
  // About the origin of the ratio cables may hang at no solved place, however like they are.
  const bool at_origin = bounds.ratio == 0 || bounds.ratio + bounds.ratio_width == 0;
  const bool ratio_wider = bounds.ratio_width >= bounds.number_width;
  const bool ratio_first = hangs ? found == Found::bends_by_ratio : at_origin || ratio_wider;
  const double narrowest =
      knows_least_tension(one_, number_) ? narrowest_above_least : narrowest_square;
  const bool ratio_halves = bounds.ratio_width > (hangs || at_origin ? narrowest_piece : narrowest);
  const bool number_halves = bounds.number_width > narrowest;
  if (ratio_first ? !ratio_halves : !number_halves) {
    square.kind = Kind::given_up;
    return;
  }
  square.kind = ratio_first ? Kind::halved_by_ratio : Kind::halved_by_number;
  square.halves = std::make_unique<std::array<Square, 2>>();
}

std::pair<CableFamily::Square*, CableFamily::Bounds> CableFamily::square_about(
    double octaves, double place, double narrowest) const {
  using Kind = Square::Kind;
  const auto number_of = [](double x, double width) {
    return static_cast<int>(std::floor(x / width));
  };
  const auto [by_ratio, by_number, little] = fineness_of(number_);
  const bool before_first = number_ == CableNumber::winch_over_least && place < 0;
  const std::pair which{number_of(octaves, by_ratio),
                        before_first ? 0 : number_of(place, by_number)};
  Square* square = &squares_[which];
  Bounds bounds{by_ratio * which.first, by_ratio, by_number * which.second, by_number};
  for (;;) {
    if (square->kind == Kind::unknown) make(*square, bounds);
    const bool halved = square->kind == Kind::halved_by_ratio;
    if (!square->halves || (halved && bounds.ratio_width <= narrowest)) return {square, bounds};
    double& from = halved ? bounds.ratio : bounds.number;
    double& width = halved ? bounds.ratio_width : bounds.number_width;
    width /= 2;
    const bool upper = (halved ? octaves : place) >= from + width;
    if (upper) from += width;
    square = &(*square->halves)[upper ? 1 : 0];
  }
}

CableMemory::Piece CableFamily::along_ratio(double from, double width, double place,
                                            LoadSeries<4>& series) const {
  if (!(std::abs(place) < most_octaves)) return CableMemory::Piece::not_known;
  const auto& [square, bounds] = square_about(from + width / 2, place, width);
  if (square->kind == Square::Kind::halved_by_ratio) return CableMemory::Piece::halved;
  if (square->kind == Square::Kind::given_up && width <= narrowest_piece) {
    return CableMemory::Piece::too_sharp;
  }
  if (square->kind != Square::Kind::smooth || bounds.ratio_width != width) {
    return CableMemory::Piece::not_known;
  }
  const AtPlace by_number = polynomials_at(bounds.number, bounds.number_width, place);
  series = weighed<4>(*square->series, by_number.value);
  return CableMemory::Piece::smooth;
}

const CableFamily::Along& CableFamily::along_at(Square& square, const Bounds& bounds,
                                                double place) {
  constexpr std::size_t most_kept = 64;
  if (square.along.size() >= most_kept && !square.along.contains(place)) square.along.clear();
  const auto [known, is_new] = square.along.try_emplace(place);
  Along& along = known->second;
  if (!is_new) return along;
  const AtPlace by_number = polynomials_at(bounds.number, bounds.number_width, place);
  along.value = weighed<parts>(*square.series, by_number.value);
  along.by_number = weighed<parts>(*square.series, by_number.slope);
  return along;
}

std::optional<CableFamily::At> CableFamily::at(double ratio, double number) const {
  const double octaves = std::log2(ratio / first_ratio(one_));
  if (!(std::abs(octaves) < most_octaves)) return std::nullopt;
  const bool folded = octaves < 0 && slack_above_station(one_) > 0;
  if (folded) return std::nullopt;  // sooner solved than looked up
  return number_ == CableNumber::winch_over_least ? above_least(octaves, number)
                                                  : at_place(octaves, std::log2(number));
}

std::optional<CableFamily::At> CableFamily::above_least(double octaves, double tension) const {
  const auto least = least_tension_.at(octaves);
  if (!least) return std::nullopt;
  const double beyond = std::log(tension) - least->value;
  if (beyond < 0) return At{.hangs = false};
  const double root = std::sqrt(beyond);
  auto at = at_place(octaves, root_scale * root - first_place_above_least);
  if (!at) return std::nullopt;
  constexpr double least_root = 1e-8;  // where slopes are without end
  const double place_by_tension = root_scale * std::numbers::ln2 / (2 * std::max(root, least_root));
  for (std::size_t i = 0; i < parts; ++i) {
    at->by_number[i] *= place_by_tension;
    at->by_ratio[i] -= least->slope * at->by_number[i];
  }
  return at;
}

std::optional<CableFamily::At> CableFamily::at_place(double octaves, double place) const {
  if (!(std::abs(place) < most_octaves)) return std::nullopt;
  const auto& [square, bounds] = square_about(octaves, place);
  if (square->kind != Square::Kind::smooth) return std::nullopt;
  const Along& along = along_at(*square, bounds, place);
  const AtPlace by_ratio = polynomials_at(bounds.ratio, bounds.ratio_width, octaves);
  At at;
  for (std::size_t k = 0; k <= load_degree; ++k) {
    for (std::size_t i = 0; i < parts; ++i) {
      at.value[i] += by_ratio.value[k] * along.value[k][i];
      at.by_ratio[i] += by_ratio.slope[k] * along.value[k][i];
      at.by_number[i] += by_ratio.value[k] * along.by_number[k][i];
    }
  }
  return at;
}

const CableFamilies::Family* CableFamilies::family_of(const HangingSituation& normal) const {
  if (!has_number(normal, number_)) return nullptr;
  HangingSituation one = without_number(normal, number_);
  one.memory = nullptr;
  constexpr std::size_t most_kept = 16;  // of designs that are told apart by one number: a few
  if (families_.size() >= most_kept && !families_.contains(one)) {
    families_.clear();
    asked_ = {};
  }
  const auto [known, is_new] = families_.try_emplace(one, Family{CableFamily(one, number_), {}});
  Family& family = known->second;
  if (is_new && knows_least_tension(one, number_)) {
    family.near_least.emplace(one, CableNumber::winch_over_least);
  }
  return &family;
}

double CableFamilies::widest() const {
  return varies_with_radius(number_) ? widest_piece : fineness_of(number_).ratio;
}

CableMemory::Piece CableFamilies::along_ratio(const HangingSituation& normal, double from,
                                              double width, LoadSeries<4>& series) const {
  const Family* family = family_of(normal);
  return family != nullptr ? family->all.along_ratio(from, width, place_of(normal, number_), series)
                           : Piece::not_known;
}

namespace {

/// What varies with a conductor's radius, and how much its logarithm changes with the radius'.
struct Varying {
  double value = 0;
  double growth = 0;
};

Varying winch_tension_at(const HangingSituation& situation, double radius) {
  const double weight = weight_at(situation, radius);
  return {*situation.paid_out.winch_tension / (weight * situation.height),
          -radius * weight_slope_at(situation, radius) / weight};
}

/// Drag over weight as `CableFamily` has it, and the number beside it.
struct RatioAndNumber {
  Varying ratio;
  Varying number;
};

RatioAndNumber with_reynolds(const HangingSituation& situation, double radius,
                             const Varying& bare_ratio) {
  const MovingAir& air = situation.air;
  const double diameter = *situation.cylinder_diameter(radius);
  const double reynolds = diameter * air.density / air.viscosity * std::abs(air.wind.x);
  const double growth = radius * (*situation.cylinder)[1] / diameter;
  const CylinderDrag drag = cylinder_drag(reynolds);
  return {{bare_ratio.value * drag.coefficient,
           bare_ratio.growth + growth * reynolds * drag.slope / drag.coefficient},
          {reynolds / std::sqrt(bare_ratio.value), growth - 0.5 * bare_ratio.growth}};
}

RatioAndNumber ratio_and_number(const HangingSituation& situation, double radius) {
  const DragOverWeight drag = drag_over_weight(situation, radius);
  const Varying ratio{drag.value, radius * drag.slope / drag.value};
  return situation.cylinder ? with_reynolds(situation, radius, ratio)
                            : RatioAndNumber{ratio, winch_tension_at(situation, radius)};
}

}  // namespace

const CableFamilies::Family* CableFamilies::family_by_radius(
    const HangingSituation& situation) const {
  for (const Asked& asked : asked_) {
    if (asked.situation == situation) return asked.family;
  }
  const bool on_winch = number_ == CableNumber::winch_tension;
  const bool has_one = varies_with_radius(number_) &&
                       on_winch == situation.paid_out.winch_tension.has_value() &&
                       on_winch != situation.cylinder.has_value();
  const auto normal = has_one ? normal_but_for_radius(situation) : std::nullopt;
  const Family* family = normal ? family_of(*normal) : nullptr;
  asked_ = {asked_[1], {situation, family}};
  return family;
}

std::optional<CableMemory::AtRadius> CableFamilies::at_radius(const HangingSituation& situation,
                                                              double radius) const {
  const Family* family = family_by_radius(situation);
  if (family == nullptr) return std::nullopt;
  const auto [ratio, number] = ratio_and_number(situation, radius);
  auto at = family->all.at(ratio.value, number.value);
  if (!at && family->near_least) at = family->near_least->at(ratio.value, number.value);
  if (!at) return std::nullopt;
  AtRadius there{at->hangs, at->value, {}};
  for (std::size_t i = 0; i < there.slope.size(); ++i) {
    there.slope[i] = at->by_ratio[i] * ratio.growth + at->by_number[i] * number.growth;
  }
  there.value.back() *= situation.height;
  there.slope.back() *= situation.height;
  return there;
}

namespace {

/// Whether these cables in normal form differ by the number alone; some may have no speed of their
/// own.
bool tells_apart(CableNumber number, const std::set<HangingSituation>& cables) {
  const auto is_of_radius = [&](const HangingSituation& normal, CableNumber n) {
    return has_number(normal, n) == (n == number);
  };
  std::map<bool, HangingSituation> others;  // by whether the number is 0
  for (const HangingSituation& normal : cables) {
    if (!is_of_radius(normal, CableNumber::winch_tension) ||
        !is_of_radius(normal, CableNumber::reynolds)) {
      return false;
    }
    if (cables.size() == 1) return true;
    if (!has_number(normal, number)) return false;
    const HangingSituation other = without_number(normal, number);
    const bool is_none = number_in(normal, number) == 0;
    if (others.try_emplace(is_none, other).first->second != other) return false;
  }
  return true;
}

/// Those that differ by more than rounding are told apart.
HangingSituation as_slack(HangingSituation normal) {
  if (normal.paid_out.length) {
    normal = with_number(normal, CableNumber::slack, rounded(slack_of(normal)));
  }
  return normal;
}

}  // namespace

std::optional<CableNumber> told_apart_by(std::span<const Design> designs) {
  std::map<Condition, std::set<HangingSituation>> cables;  // in normal form
  std::map<Condition, std::set<HangingSituation>> solved;  // as each would be by itself
  for (const Design& design : designs) {
    if (design.tether.model == TetherModel::straight) continue;
    for (const Condition condition : {Condition::hover, Condition::forward}) {
      const HangingSituation situation = hanging_situation(design, flight_state(design, condition));
      auto normal = normal_but_for_radius(situation);
      if (!normal) continue;
      normal = as_slack(*normal);
      cables[condition].insert(*normal);
      solved[condition].insert(normal_form(situation) ? *normal : situation);
    }
  }
  // Few cables that many designs have are solved sooner by themselves.
  const bool most_differ = std::ranges::any_of(
      solved, [&](const auto& of) { return 2 * of.second.size() > designs.size(); });
  if (!most_differ) return std::nullopt;
  for (const CableNumber number :
       {CableNumber::slack, CableNumber::aside, CableNumber::own_speed,
        CableNumber::profile_under_one_wind, CableNumber::profile_under_drone,
        CableNumber::winch_tension, CableNumber::reynolds}) {
    if (std::ranges::all_of(cables,
                            [&](const auto& of) { return tells_apart(number, of.second); })) {
      return number;
    }
  }
  return std::nullopt;
}

}  // namespace tethercalc
