#include "model/cable_family.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace tethercalc {
namespace {

/// Of squares in which not all cables hang: narrower ones along that border would be many.
constexpr double narrowest_square = 1.0 / 32;
/// Where a winch decides how much is paid out: octaves of drag over weight, and what last terms may
/// be of the tension. Between radii such a load is a cubic, which misses by 1e-5.
constexpr double widest_on_winch = 1;
constexpr double little_on_winch = 1e-7;
/// Of the share of the wind that no profile shapes: over a quarter of it forces bend as over an
/// octave.
constexpr double share_scale = 4;

double slack_of(const HangingSituation& normal) {
  return normal.paid_out.length.value_or(0) / std::hypot(1, normal.offset) - 1;
}

double number_in(const HangingSituation& normal, CableNumber number) {
  switch (number) {
    case CableNumber::slack:
      return slack_of(normal);
    case CableNumber::aside:
      return normal.offset;
    case CableNumber::own_speed:
      return normal.air.even_share;
    case CableNumber::winch_tension:
      return normal.paid_out.winch_tension.value_or(0);
  }
  return 0;
}

HangingSituation with_number(HangingSituation normal, CableNumber number, double value) {
  switch (number) {
    case CableNumber::slack:
      normal.paid_out.length = (1 + value) * std::hypot(1, normal.offset);
      break;
    case CableNumber::aside: {
      // The same to its last digit for all that are as slack.
      constexpr double digits = 1e12;
      const double slack = std::round(slack_of(normal) * digits) / digits;
      normal.offset = value;
      if (normal.paid_out.length) normal.paid_out.length = (1 + slack) * std::hypot(1, value);
      break;
    }
    case CableNumber::own_speed:
      normal.air.even_share = value;
      break;
    case CableNumber::winch_tension:
      normal.paid_out.winch_tension = value;
      break;
  }
  return normal;
}

bool has_number(const HangingSituation& normal, CableNumber number) {
  if (number == CableNumber::own_speed) return normal.air.profile != WindProfile::uniform;
  return number_in(normal, number) > 0;
}

double place_of(const HangingSituation& normal, CableNumber number) {
  const double value = number_in(normal, number);
  return number == CableNumber::own_speed ? share_scale * value : std::log2(value);
}

/// The series of the ratio, without its parts beyond, of which a square has a series each.
template <std::size_t Parts, std::size_t Terms>
LoadSeries<Parts> unpacked(const std::array<double, Terms>& terms) {
  constexpr std::size_t all = Terms / (load_degree + 1);
  LoadSeries<Parts> series{};
  for (std::size_t k = 0; k <= load_degree; ++k) {
    std::copy_n(terms.begin() + static_cast<std::ptrdiff_t>(k * all), Parts, series[k].begin());
  }
  return series;
}

}  // namespace

HangingSituation CableFamily::cable_at(double place) const {
  return with_number(one_, number_,
                     number_ == CableNumber::own_speed ? place / share_scale : std::exp2(place));
}

bool CableFamily::solve(const Bounds& bounds, LoadSeries<terms>& series, double& tension) const {
  LoadSeries<terms> solved{};  // by place of the number, each a series of the ratio
  CableSolver solver(most_steps_for_load);
  for (std::size_t i = 0; i <= load_degree; ++i) {
    const HangingSituation cable = cable_at(load_place(bounds.number, bounds.number_width, i));
    const double first = first_ratio(cable);
    LoadSeries<parts> along{};
    for (std::size_t k = 0; k <= load_degree; ++k) {
      // To and fro: each cable is solved from one like it.
      const std::size_t j = i % 2 == 0 ? k : load_degree - k;
      LoadShares shares{};
      const double ratio = first * std::exp2(load_place(bounds.ratio, bounds.ratio_width, j));
      if (solve_shares(cable, solver, ratio, shares) != CableOutcome::hangs) return false;
      along[j] = shares;
      tension = std::max(tension, shares[2]);
    }
    along = series_through(along);
    for (std::size_t k = 0; k <= load_degree; ++k) {
      std::copy_n(along[k].begin(), parts,
                  solved[i].begin() + static_cast<std::ptrdiff_t>(k * parts));
    }
  }
  series = series_through(solved);
  return true;
}

void CableFamily::make(Square& square, const Bounds& bounds) const {
  using Kind = Square::Kind;
  LoadSeries<terms> series{};
  double tension = 0;
  const bool hangs = solve(bounds, series, tension);
  const double little = number_ == CableNumber::winch_tension ? little_on_winch : little_of_tension;
  const auto converges_by_ratio = [&](const std::array<double, terms>& of_number) {
    return is_converged(unpacked<parts>(of_number), tension, little);
  };
  const bool by_ratio = hangs && std::all_of(series.begin(), series.end(), converges_by_ratio);
  const bool by_number = hangs && is_converged(series, tension, little);
  if (by_ratio && by_number) {
    square.series = std::make_unique<LoadSeries<terms>>(series);
    square.kind = Kind::smooth;
    return;
  }
  // About the origin of the ratio cables may hang at no solved place, however like they are.
  const bool at_origin = bounds.ratio == 0 || bounds.ratio + bounds.ratio_width == 0;
  const bool ratio_wider = bounds.ratio_width >= bounds.number_width;
  const bool ratio_first = hangs ? !by_ratio : at_origin || ratio_wider;
  const bool ratio_halves =
      bounds.ratio_width > (hangs || at_origin ? narrowest_piece : narrowest_square);
  const bool number_halves = bounds.number_width > narrowest_square;
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
  const double by_ratio = number_ == CableNumber::winch_tension ? widest_on_winch : widest_piece;
  const std::pair which{number_of(octaves, by_ratio), number_of(place, widest_piece)};
  Square* square = &squares_[which];
  Bounds bounds{by_ratio * which.first, by_ratio, widest_piece * which.second, widest_piece};
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
  const double y = 2 * (place - bounds.number) / bounds.number_width - 1;
  series = unpacked<4>(value_at(*square->series, y));
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
  for (std::size_t j = 0; j <= load_degree; ++j) {
    const LoadSeries<parts> term = unpacked<parts>((*square.series)[j]);
    for (std::size_t k = 0; k <= load_degree; ++k) {
      for (std::size_t i = 0; i < parts; ++i) {
        along.value[k][i] += by_number.value[j] * term[k][i];
        along.by_number[k][i] += by_number.slope[j] * term[k][i];
      }
    }
  }
  return along;
}

std::optional<CableFamily::At> CableFamily::at(double ratio, double place) const {
  const double octaves = std::log2(ratio / first_ratio(one_));
  if (!(std::abs(octaves) < most_octaves) || !(std::abs(place) < most_octaves)) return std::nullopt;
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

const CableFamily* CableFamilies::family_of(const HangingSituation& normal) const {
  if (!has_number(normal, number_)) return nullptr;
  HangingSituation one = with_number(normal, number_, 1);
  one.memory = nullptr;
  constexpr std::size_t most_kept = 16;  // of designs that are told apart by one number: a few
  if (families_.size() >= most_kept && !families_.contains(one)) families_.clear();
  return &families_.try_emplace(one, one, number_).first->second;
}

CableMemory::Piece CableFamilies::along_ratio(const HangingSituation& normal, double from,
                                              double width, LoadSeries<4>& series) const {
  const CableFamily* family = family_of(normal);
  return family != nullptr ? family->along_ratio(from, width, place_of(normal, number_), series)
                           : Piece::not_known;
}

std::optional<CableMemory::AtRadius> CableFamilies::on_winch(const HangingSituation& situation,
                                                             double radius) const {
  const std::optional<double> tension = situation.paid_out.winch_tension;
  auto normal = tension && number_ == CableNumber::winch_tension ? normal_surroundings(situation)
                                                                 : std::nullopt;
  if (!normal) return std::nullopt;
  const double weight = weight_at(situation, radius);
  const DragOverWeight ratio = drag_over_weight(situation, radius);
  normal->paid_out.winch_tension = *tension / (weight * situation.height);
  const CableFamily* family = family_of(*normal);
  const auto at =
      family != nullptr ? family->at(ratio.value, place_of(*normal, number_)) : std::nullopt;
  if (!at) return std::nullopt;
  const double ratio_grows = radius * ratio.slope / ratio.value;
  const double tension_grows = -radius * weight_slope_at(situation, radius) / weight;
  AtRadius there{at->value, {}};
  for (std::size_t i = 0; i < there.slope.size(); ++i) {
    there.slope[i] = at->by_ratio[i] * ratio_grows + at->by_number[i] * tension_grows;
  }
  there.value.back() *= situation.height;
  there.slope.back() *= situation.height;
  return there;
}

namespace {

/// Of a cable in normal form, on a winch with whatever tension.
std::optional<HangingSituation> normal_cable(const HangingSituation& situation) {
  if (!situation.paid_out.winch_tension) return normal_form(situation);
  auto normal = normal_surroundings(situation);
  if (normal) normal->paid_out.winch_tension = 1;
  return normal;
}

/// The numbers that differ between two cables in normal form.
std::vector<CableNumber> numbers_apart(const HangingSituation& a, const HangingSituation& b) {
  constexpr double rounding = 1e-9;
  std::vector<CableNumber> apart;
  // On a winch the tension over each conductor's weight.
  if (a.paid_out.winch_tension) apart.push_back(CableNumber::winch_tension);
  for (const CableNumber n : {CableNumber::slack, CableNumber::aside, CableNumber::own_speed}) {
    if (n == CableNumber::slack && a.paid_out.winch_tension) continue;
    const double one = number_in(a, n);
    const double other = number_in(b, n);
    if (std::abs(one - other) > rounding * std::abs(other)) apart.push_back(n);
  }
  return apart;
}

}  // namespace

std::optional<CableNumber> told_apart_by(std::span<const Design> designs) {
  std::map<Condition, HangingSituation> first;
  std::map<Condition, std::set<HangingSituation>> cables;
  std::optional<CableNumber> number;
  for (const Design& design : designs) {
    if (design.tether.model == TetherModel::straight) continue;
    for (const Condition condition : {Condition::hover, Condition::forward}) {
      const HangingSituation situation = hanging_situation(design, flight_state(design, condition));
      const auto normal = normal_cable(situation);
      if (!normal) continue;
      const HangingSituation& other = first.try_emplace(condition, *normal).first->second;
      cables[condition].insert(normal->paid_out.winch_tension ? situation : *normal);
      if (cables[condition].size() < 2) continue;
      const std::vector<CableNumber> apart = numbers_apart(*normal, other);
      if (apart.empty()) continue;
      const bool only_that =
          with_number(*normal, apart.front(), 1) == with_number(other, apart.front(), 1);
      if (apart.size() > 1 || !only_that || number.value_or(apart.front()) != apart.front()) {
        return std::nullopt;
      }
      number = apart.front();
    }
  }
  // Few cables that many designs have are solved sooner by themselves.
  const bool most_differ = std::ranges::any_of(
      cables, [&](const auto& of) { return 2 * of.second.size() > designs.size(); });
  return most_differ ? number : std::nullopt;
}

}  // namespace tethercalc
