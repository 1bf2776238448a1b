#include "model/cable_family.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tethercalc {
namespace {

constexpr double narrowest_square = 1.0 / 32;
/// Where forces turn sharply with the ratio; as narrow as `SimilarCables` has them.
constexpr double narrowest_by_ratio = 1.0 / 1024;
constexpr double share_scale = 4;
/// Places beyond which nothing is remembered.
constexpr double furthest = 60;

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
      std::copy_n(shares.begin(), parts - 1, along[j].begin());
      along[j].back() = shares.back();
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
  bool by_ratio = hangs;  // whether it converges
  bool by_number = hangs && is_converged(series, tension);
  for (std::size_t l = 0; l <= load_degree && by_ratio; ++l) {
    for (std::size_t i = terms - 2 * parts; i < terms; ++i) {
      by_ratio = by_ratio && std::abs(series[l][i]) < little_of_tension * tension;
    }
  }
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
      bounds.ratio_width > (hangs || at_origin ? narrowest_by_ratio : narrowest_square);
  const bool number_halves = bounds.number_width > narrowest_square;
  if (ratio_first ? !ratio_halves : !number_halves) {
    square.kind = Kind::given_up;
    return;
  }
  square.kind = ratio_first ? Kind::halved_by_ratio : Kind::halved_by_number;
  square.halves = std::make_unique<std::array<Square, 2>>();
}

std::pair<const CableFamily::Square*, CableFamily::Bounds> CableFamily::square_about(
    double octaves, double place, double narrowest) const {
  using Kind = Square::Kind;
  const auto number_of = [](double x) { return static_cast<int>(std::floor(x / widest_piece)); };
  const std::pair which{number_of(octaves), number_of(place)};
  Square* square = &squares_[which];
  Bounds bounds{widest_piece * which.first, widest_piece, widest_piece * which.second,
                widest_piece};
  for (;;) {
    if (square->kind == Kind::unknown) make(*square, bounds);
    const bool by_ratio = square->kind == Kind::halved_by_ratio;
    if (!square->halves || (by_ratio && bounds.ratio_width <= narrowest)) return {square, bounds};
    double& from = by_ratio ? bounds.ratio : bounds.number;
    double& width = by_ratio ? bounds.ratio_width : bounds.number_width;
    width /= 2;
    const bool upper = (by_ratio ? octaves : place) >= from + width;
    if (upper) from += width;
    square = &(*square->halves)[upper ? 1 : 0];
  }
}

CableMemory::Piece CableFamily::along_ratio(double from, double width, double place,
                                            LoadSeries<4>& series) const {
  if (!(std::abs(place) < furthest)) return CableMemory::Piece::not_known;
  const auto& [square, bounds] = square_about(from + width / 2, place, width);
  if (square->kind == Square::Kind::halved_by_ratio) return CableMemory::Piece::halved;
  if (square->kind == Square::Kind::given_up && width <= narrowest_by_ratio) {
    return CableMemory::Piece::too_sharp;
  }
  if (square->kind != Square::Kind::smooth || bounds.ratio_width != width)
    return CableMemory::Piece::not_known;
  const auto there =
      value_at(*square->series, 2 * (place - bounds.number) / bounds.number_width - 1);
  for (std::size_t k = 0; k <= load_degree; ++k) {
    std::copy_n(there.begin() + static_cast<std::ptrdiff_t>(k * parts), series[k].size(),
                series[k].begin());
  }
  return CableMemory::Piece::smooth;
}

std::optional<CableFamily::At> CableFamily::at(double ratio, double place) const {
  const double octaves = std::log2(ratio / first_ratio(one_));
  if (!(std::abs(octaves) < furthest) || !(std::abs(place) < furthest)) return std::nullopt;
  const auto& [square, bounds] = square_about(octaves, place);
  if (square->kind != Square::Kind::smooth) return std::nullopt;
  const double x = 2 * (octaves - bounds.ratio) / bounds.ratio_width - 1;
  const double y = 2 * (place - bounds.number) / bounds.number_width - 1;
  const auto series_at = [y](const LoadSeries<terms>& of) {
    const auto there = value_at(of, y);
    LoadSeries<parts> series{};
    for (std::size_t k = 0; k <= load_degree; ++k) {
      std::copy_n(there.begin() + static_cast<std::ptrdiff_t>(k * parts), parts, series[k].begin());
    }
    return series;
  };
  const auto shares = [](const std::array<double, parts>& values) {
    LoadShares out{};
    std::copy_n(values.begin(), parts - 1, out.begin());
    out.back() = values.back();
    return out;
  };
  const LoadSeries<parts> value = series_at(*square->series);
  return At{shares(value_at(value, x)), shares(value_at(slope_of(value, bounds.ratio_width), x)),
            shares(value_at(series_at(slope_of(*square->series, bounds.number_width)), x))};
}

const CableFamily* CableFamilies::family_of(const HangingSituation& normal) const {
  if (!has_number(normal, number_)) return nullptr;
  HangingSituation one = with_number(normal, number_, 1);
  one.shared = {};
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

std::optional<CableNumber> told_apart_by(std::span<const Design> designs) {
  struct Told {
    HangingSituation as_it_is;
    HangingSituation normal;
  };
  std::map<Condition, Told> first;
  std::optional<CableNumber> number;
  for (const Design& design : designs) {
    if (design.tether.model == TetherModel::straight) continue;
    for (const Condition condition : {Condition::hover, Condition::forward}) {
      const HangingSituation situation = hanging_situation(design, flight_state(design, condition));
      auto normal = situation.paid_out.winch_tension ? normal_surroundings(situation)
                                                     : normal_form(situation);
      if (!normal) continue;
      if (situation.paid_out.winch_tension) normal->paid_out.winch_tension = 1;
      const auto [known, is_first] = first.try_emplace(condition, Told{situation, *normal});
      if (is_first || known->second.as_it_is == situation) continue;
      const HangingSituation& other = known->second.normal;
      if (situation.paid_out.winch_tension.has_value() !=
          other.paid_out.winch_tension.has_value()) {
        return std::nullopt;
      }
      std::optional<CableNumber> differs;
      if (situation.paid_out.winch_tension) differs = CableNumber::winch_tension;
      for (const CableNumber n : {CableNumber::slack, CableNumber::aside, CableNumber::own_speed}) {
        if (situation.paid_out.winch_tension && n == CableNumber::slack) continue;
        constexpr double rounding = 1e-9;
        const double apart = std::abs(number_in(*normal, n) - number_in(other, n));
        if (apart <= rounding * std::abs(number_in(other, n))) continue;
        if (differs) return std::nullopt;
        differs = n;
      }
      if (!differs) continue;
      if (number && number != differs) return std::nullopt;
      number = differs;
    }
  }
  return number;
}

}  // namespace tethercalc
