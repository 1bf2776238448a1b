#include "diagnose/fit_judgement.hpp"

#include <algorithm>
#include <cmath>

#include "identify/statistics.hpp"
#include "model/constants.hpp"

namespace tethercalc {
namespace {

constexpr double aliased_below = 0.01;
/// Cosine beyond which a change of the prediction looks like another at all.
constexpr double alike = 0.1;

/// Chance of an open effect's size below which it is suspected.
constexpr double suspicious = 0.05;
/// A gain that is printed as 0.0 % would not help.
constexpr double least_worth_telling = 0.05;
/// So many times the gain that is asked of a name are suspicious by themselves: noise of a log long
/// enough to be judged does not gain a tenth of the error.
constexpr double much = 5;

bool is_hardly_chance(double p_value, const Gain& gain, double least_of_a_name,
                      const ParameterGroup& group) {
  // Of what is always there a little, or looked for at many moments, chance shows some.
  const double least = group.least_gain_factor > 1 ? least_of_a_name : 0;
  return p_value <= suspicious && gain.percent >= least && gain.percent > gain.se &&
         gain.percent >= least_worth_telling;
}

bool helps_much(const Gain& gain, const Gain& typical, double least_of_a_name) {
  return gain.percent >= much * least_of_a_name && gain.percent > 2 * gain.se &&
         typical.percent > 2 * typical.se;
}

/// Standard errors to either side of a 95 % interval.
double student_factor(const Record& record, std::size_t group) {
  return student_quantile(degrees_of_freedom(record, group), 0.975);
}

std::size_t owner_of(const Record& record, std::size_t parameter) {
  std::size_t owner = 0;
  while (owner + 1 < record.problem().groups.size() &&
         record.first_parameter(owner + 1) <= parameter) {
    ++owner;
  }
  return owner;
}

/// `values` with the first ones of the group.
std::vector<double> started(const Record& record, std::vector<double> values, std::size_t group) {
  for (std::size_t k = 0; k < record.problem().groups[group].parameters.size(); ++k) {
    const std::size_t index = record.first_parameter(group) + k;
    values[index] = record.parameters()[index].start;
  }
  return values;
}

/// The slopes at the first values by the sizes of the group alone.
MatrixXd size_slopes(const Record& record, const std::vector<double>& values, std::size_t group,
                     FitUse use) {
  const std::vector<ModelParameter>& own = record.problem().groups[group].parameters;
  std::vector<Index> sizes;
  Index column = 0;
  for (const ModelParameter& p : own) {
    if (!p.is_free()) continue;
    if (!p.shape_only) sizes.push_back(column);
    ++column;
  }
  return group_slopes(record, {group}, started(record, values, group), use)(Eigen::all, sizes);
}

/// What least squares knows of a column beside others: the part of its square that is its own.
double own_information(const MatrixXd& gram, const VectorXd& cross, double square) {
  return square - cross.dot(pseudo_solution(gram, cross));
}

/// The largest part of that which one block has.
double largest_share(const Record& record, const MatrixXd& others, const VectorXd& column) {
  const MatrixXd gram = gram_matrix(others);
  const VectorXd cross = inner_products_with(others, column);
  const double square = column.squaredNorm();
  const double all = own_information(gram, cross, square);
  if (!(all > 0)) return 0;
  double least_left = all;
  for (std::size_t b = 0; b < record.blocks(); ++b) {
    MatrixXd rows(record.block_size(b), others.cols());
    // Without columns there is no memory of which a part could be taken.
    if (others.cols() > 0) rows = others.middleRows(record.block_begin(b), record.block_size(b));
    const VectorXd part = column.segment(record.block_begin(b), record.block_size(b));
    least_left = std::min(least_left, own_information(gram - gram_matrix(rows),
                                                      cross - inner_products_with(rows, part),
                                                      square - part.squaredNorm()));
  }
  return 1 - least_left / all;
}

/// The sizes of the group by one step of weighted least squares beside what is free in the fit.
std::vector<SizeEstimate> sizes_beside(const Record& record, const BlockFit& fit,
                                       std::size_t group) {
  const MatrixXd sizes = size_slopes(record, fit.values, group, FitUse::report);
  MatrixXd slopes(sizes.rows(), fit.jacobian.cols() + sizes.cols());
  slopes << fit.jacobian, sizes;
  const VectorXd weight = fit.weight.cwiseSqrt();
  slopes = weight.asDiagonal() * slopes;
  const VectorXd residual = weight.cwiseProduct(fit.residual);
  const MatrixXd gram = gram_matrix(slopes);
  const VectorXd along = inner_products_with(slopes, residual);
  const VectorXd whole = pseudo_solution(gram, along);
  MatrixXd left_out(slopes.cols(), static_cast<Index>(record.blocks()));
  for (std::size_t b = 0; b < record.blocks(); ++b) {
    const MatrixXd rows = slopes.middleRows(record.block_begin(b), record.block_size(b));
    const VectorXd rest = residual.segment(record.block_begin(b), record.block_size(b));
    left_out.col(static_cast<Index>(b)) =
        pseudo_solution(gram - gram_matrix(rows), along - inner_products_with(rows, rest));
  }
  const MatrixXd covariance = jackknife_covariance(std::move(left_out));

  std::vector<SizeEstimate> estimates;
  const std::vector<ModelParameter>& own = record.problem().groups[group].parameters;
  for (std::size_t k = 0; k < own.size(); ++k) {
    if (own[k].shape_only || !own[k].is_free()) continue;
    const Index column = fit.jacobian.cols() + static_cast<Index>(estimates.size());
    SizeEstimate& size = estimates.emplace_back();
    size.parameter = record.first_parameter(group) + k;
    size.value = own[k].neutral + own[k].scale * whole[column];
    size.standard_error = own[k].scale * std::sqrt(covariance(column, column));
    std::vector<Index> others;
    for (Index c = 0; c < slopes.cols(); ++c) {
      if (c != column) others.push_back(c);
    }
    size.largest_block_share =
        largest_share(record, slopes(Eigen::all, others), slopes.col(column));
    const auto base = std::find(fit.active.begin(), fit.active.end(), own[k].product_with);
    if (base == fit.active.end()) continue;
    const Index base_column = base - fit.active.begin();
    const double relative = record.parameters()[*base].scale / fit.values[*base];
    size.base = 1 + relative * whole[base_column];
    size.base_error = relative * std::sqrt(covariance(base_column, base_column));
    size.covariance = own[k].scale * relative * covariance(column, base_column);
  }
  return estimates;
}

/// By how much the group would lower the squared error of the fit with its places at `values`, if
/// the prediction were linear in its sizes.
class PlaceGains {
 public:
  PlaceGains(const Record& record, const BlockFit& fit, std::size_t group)
      : record_(record),
        fit_(fit),
        group_(group),
        weight_(fit.weight.cwiseSqrt()),
        free_(weight_.asDiagonal() * fit.jacobian),
        inverse_(symmetric_pseudo_inverse(gram_matrix(free_))) {}

  [[nodiscard]] double at(std::size_t parameter, double place) const {
    std::vector<double> values = started(record_, fit_.values, group_);
    values[parameter] = place;
    return of(values);
  }
  [[nodiscard]] double at_start() const { return of(started(record_, fit_.values, group_)); }

 private:
  [[nodiscard]] double of(const std::vector<double>& values) const {
    MatrixXd slopes = group_slopes(record_, {group_}, values);
    slopes = weight_.asDiagonal() * slopes;
    if (free_.cols() > 0)
      slopes -= product(free_, product(inverse_, inner_products(free_, slopes)));
    const VectorXd along = inner_products_with(slopes, weight_.cwiseProduct(fit_.residual));
    const VectorXd step = pseudo_solution(gram_matrix(slopes), along);
    return leaves_bounds(step) ? 0 : along.dot(step);
  }

  /// Whether a size would go below a bound that it starts from, as for a mass that is dropped.
  [[nodiscard]] bool leaves_bounds(const VectorXd& step) const {
    Index column = 0;
    for (const ModelParameter& p : record_.problem().groups[group_].parameters) {
      if (!p.is_free()) continue;
      if (!p.shape_only && p.lower == p.neutral && step[column] < 0) return true;
      ++column;
    }
    return false;
  }

  const Record& record_;
  const BlockFit& fit_;
  std::size_t group_;
  VectorXd weight_;
  MatrixXd free_;
  MatrixXd inverse_;  ///< of its normal matrix
};

/// A regressor of which less than this part of the sum of squares is its own, the rest being a
/// combination of what the fit contains, would only add noise.
constexpr double least_own_part = 1e-3;

/// Sums over one block; all that a linear extension of the fit needs.
struct BlockSums {
  MatrixXd normal;    ///< JᵀJ
  VectorXd gradient;  ///< Jᵀr
  MatrixXd cross;     ///< JᵀZ
  VectorXd own;       ///< Σz² of each regressor
  VectorXd slope;     ///< Σz·r
  double squared_residual = 0;
};

/// Robustness weights count in the fits, not in the held-out error.
BlockSums sums(const Record& record, const BlockFit& fit, std::size_t block, bool weighted) {
  const Index begin = record.block_begin(block);
  const Index size = record.block_size(block);
  // A matrix without columns has no data that rows could point into.
  const MatrixXd jacobian =
      fit.jacobian.cols() > 0 ? MatrixXd(fit.jacobian.middleRows(begin, size)) : MatrixXd(size, 0);
  const auto z = record.unnamed_columns().middleRows(begin, size);
  const VectorXd residual = fit.residual.segment(begin, size);
  VectorXd weight = VectorXd::Ones(size);
  if (weighted) weight = fit.weight.segment(begin, size);
  BlockSums s;
  s.normal = inner_products(weight.asDiagonal() * jacobian, jacobian);
  s.gradient = inner_products_with(jacobian, weight.cwiseProduct(residual));
  s.cross = inner_products(weight.asDiagonal() * jacobian, z);
  s.own = inner_products_with(z.cwiseAbs2(), weight);
  s.slope = inner_products_with(z, weight.cwiseProduct(residual));
  s.squared_residual = residual.squaredNorm();
  return s;
}

void add(BlockSums& total, const BlockSums& part, double sign) {
  total.normal += sign * part.normal;
  total.gradient += sign * part.gradient;
  total.cross += sign * part.cross;
  total.own += sign * part.own;
  total.slope += sign * part.slope;
}

}  // namespace

MatrixXd slopes_at_start(const Record& record, std::vector<double> values, std::size_t group) {
  return group_slopes(record, {group}, started(record, std::move(values), group));
}

double degrees_of_freedom(const Record& record, std::size_t group) {
  const std::size_t own = record.problem().groups[group].blocks;
  return static_cast<double>((own > 0 ? own : record.blocks()) - 1);
}

double gain_percent(double before, double after) {
  return before > 0 ? 100 * (1 - std::sqrt(after / before)) : 0;
}

BlockDifference difference(const VectorXd& a, const VectorXd& b) {
  const VectorXd d = a - b;
  const auto blocks = static_cast<double>(d.size());
  const double spread = (d.array() - d.mean()).square().sum();
  return {d.sum(), std::sqrt(blocks / (blocks - 1) * spread)};
}

Gain gain_between(const BlockFit& before, const BlockFit& after) {
  const double all_before = before.squared_error();
  const double all_after = after.squared_error();
  const auto blocks = static_cast<double>(before.block_error.size());
  VectorXd without(before.block_error.size());
  for (Index b = 0; b < without.size(); ++b) {
    without[b] = gain_percent(all_before - before.block_error[b], all_after - after.block_error[b]);
  }
  const double spread = (without.array() - without.mean()).square().sum();
  return {gain_percent(all_before, all_after), std::sqrt((blocks - 1) / blocks * spread)};
}

Gain typical_gain_between(const BlockFit& before, const BlockFit& after) {
  const VectorXd ratio =
      (after.block_error.array().max(1e-300) / before.block_error.array().max(1e-300)).log() / 2;
  const auto blocks = static_cast<double>(ratio.size());
  const double mean = ratio.mean();
  const double se = std::sqrt((ratio.array() - mean).square().sum() / (blocks * (blocks - 1)));
  return {-100 * std::expm1(mean), 100 * std::exp(mean) * se};
}

Gain surer_gain_between(const BlockFit& before, const BlockFit& after) {
  const Gain gain = gain_between(before, after);
  const Gain typical = typical_gain_between(before, after);
  if (!(gain.percent > 2 * gain.se && typical.percent > 0)) return gain;
  return {gain.percent, std::min(gain.se, gain.percent * typical.se / typical.percent)};
}

bool earns_a_name(const Record& record, std::size_t group, const Gain& gain, double least_percent) {
  return gain.percent >= least_percent * record.problem().groups[group].least_gain_factor &&
         gain.percent > student_factor(record, group) * gain.se;
}

bool is_at_bound(const Record& record, const BlockFit& fit, std::size_t group) {
  const std::vector<ModelParameter>& parameters = record.problem().groups[group].parameters;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const ModelParameter& p = parameters[k];
    const double value = fit.values[record.first_parameter(group) + k];
    if (p.lower < p.upper && !p.product_with && value != p.neutral &&
        (value <= p.lower || value >= p.upper)) {
      return true;
    }
  }
  return false;
}

bool is_neutral(const Record& record, const BlockFit& fit, std::size_t group) {
  const std::vector<ModelParameter>& parameters = record.problem().groups[group].parameters;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const double value = fit.values[record.first_parameter(group) + k];
    if (!parameters[k].shape_only && value != parameters[k].neutral) return false;
  }
  return true;
}

bool spoils_a_kind(const Record& record, const BlockFit& without, const BlockFit& with) {
  constexpr double by_chance = 0.05;
  const std::vector<std::vector<bool>>& kinds = record.problem().kinds;
  // Of the blocks that have such rows.
  const auto errors = [&](const std::vector<bool>& kind, const BlockFit& fit) {
    std::vector<double> squared;
    for (std::size_t b = 0; b < record.blocks(); ++b) {
      double sum = 0;
      bool any = false;
      for (Index i = 0; i < record.block_size(b); ++i) {
        const Index row = record.block_begin(b) + i;
        if (!kind[record.row_in_problem(row)]) continue;
        any = true;
        sum += std::pow(fit.holdout_residual[row], 2);
      }
      if (any) squared.push_back(sum);
    }
    return VectorXd(VectorXd::Map(squared.data(), static_cast<Index>(squared.size())));
  };
  const auto is_spoilt = [&](const std::vector<bool>& kind) {
    const VectorXd before = errors(kind, without);
    if (before.size() < static_cast<Index>(fewest_blocks)) return false;
    const BlockDifference more = difference(errors(kind, with), before);
    const auto degrees = static_cast<double>(before.size() - 1);
    return more.sum > 0 && student_tail(more.sum / more.se, degrees) <
                               by_chance / static_cast<double>(kinds.size());
  };
  return std::any_of(kinds.begin(), kinds.end(), is_spoilt);
}

std::optional<Unearned> weakest_unearned(const Record& record, std::span<const NamedGains> names,
                                         double least_percent) {
  std::optional<Unearned> weakest;
  for (const NamedGains& name : names) {
    const bool positive = name.others_sought_beside && name.in_order.percent > 0;
    for (const Gain& gain : {positive ? name.beside : name.in_order, name.beside}) {
      if (weakest && gain.percent >= weakest->gain.percent) continue;
      if (!earns_a_name(record, name.group, gain, least_percent)) weakest = {name.group, gain};
    }
  }
  return weakest;
}

SelectedGroup freed_between(const BlockFit& before, const BlockFit& after, std::size_t group) {
  const Gain gained = gain_between(before, after);
  return {group, before.rmse(), after.rmse(), gained.percent, gained.se};
}

std::optional<Selection::Aliased> aliased_in(const Record& record, const BlockFit& fit,
                                             std::size_t group) {
  std::vector<Index> columns;
  for (std::size_t k = 0; k < fit.active.size(); ++k) {
    if (record.problem().groups[group].replaces != owner_of(record, fit.active[k])) {
      columns.push_back(static_cast<Index>(k));
    }
  }
  MatrixXd slopes = size_slopes(record, fit.values, group, FitUse::search);
  const VectorXd norms = slopes.colwise().norm();
  if (norms.minCoeff() <= 0) return Selection::Aliased{group, {}};
  slopes = slopes * norms.cwiseInverse().asDiagonal();
  const VectorXd size = slopes.col(0);
  if (!columns.empty()) {
    slopes = left_by(fit.jacobian(Eigen::all, columns), slopes);
  }
  const MatrixXd gram = gram_matrix(slopes);
  const double least = least_eigenvalue(gram).value;
  if (std::sqrt(std::max(least, 0.0)) >= aliased_below) return std::nullopt;

  std::vector<std::pair<double, std::size_t>> nearness;
  for (const Index k : columns) {
    const VectorXd other = fit.jacobian.col(k);
    const double cosine = std::abs(other.dot(size)) / std::max(other.norm(), 1e-300);
    if (cosine > alike) {
      nearness.emplace_back(-cosine, owner_of(record, fit.active[static_cast<std::size_t>(k)]));
    }
  }
  std::sort(nearness.begin(), nearness.end());
  Selection::Aliased aliased{group, {}};
  for (const auto& [cosine, owner] : nearness) {
    if (!contains(aliased.with, owner)) aliased.with.push_back(owner);
  }
  return aliased;
}

double linear_gain(const Record& record, const BlockFit& fit, std::size_t group) {
  return PlaceGains(record, fit, group).at_start();
}

void choose_places(Record& record, const BlockFit& fit, std::size_t group) {
  const PlaceGains gains(record, fit, group);
  const std::vector<ModelParameter>& own = record.problem().groups[group].parameters;
  for (std::size_t k = 0; k < own.size(); ++k) {
    const std::vector<double>& places = own[k].places;
    if (places.empty()) continue;
    const std::size_t parameter = record.first_parameter(group) + k;
    double best = places.front();
    double most = -infinity;
    const auto consider = [&](double place) {
      if (place < own[k].lower || place > own[k].upper) return;
      const double gain = gains.at(parameter, place);
      if (gain <= most) return;
      best = place;
      most = gain;
    };
    for (const double place : places) consider(place);
    if (!own[k].fitted) {
      // A gain over moments is rough: a stage's rows are means over seconds, and where noise has
      // much memory a step shows in the one row in which it falls. So the best of a neighbourhood
      // may be the way to a better one.
      constexpr int parts = 32;
      const double part =
          (places.back() - places.front()) / static_cast<double>(places.size() * parts);
      for (double middle = infinity; middle != best;) {
        middle = best;
        for (int i = -parts; i <= parts; ++i) consider(middle + i * part);
      }
      const double nearest = best;
      for (const double beside : {-part / 2, part / 2}) consider(nearest + beside);
    }
    record.start_at(parameter, best);
  }
}

void place_fitted(Record& record) {
  Freed others;
  Groups placed;
  for (std::size_t g = 0; g < record.problem().groups.size(); ++g) {
    if (!record.problem().groups[g].fitted) continue;
    (is_placed(record.problem().groups[g]) ? placed : others.groups).push_back(g);
  }
  if (placed.empty()) return;
  const BlockFit fit = fit_blocks(record, others, nullptr);
  for (const std::size_t g : placed) choose_places(record, fit, g);
}

bool is_placed(const ParameterGroup& group) { return chances(group) > 1; }

double chances(const ParameterGroup& group) {
  double count = 1;
  for (const ModelParameter& p : group.parameters) {
    count *= static_cast<double>(std::max<std::size_t>(1, p.places.size()));
  }
  return count;
}

double largest_block_share(const Record& record, const BlockFit& fit, std::size_t group) {
  const VectorXd weight = fit.weight.cwiseSqrt();
  const std::size_t first = record.first_parameter(group);
  const std::size_t last = first + record.problem().groups[group].parameters.size();
  VectorXd column = VectorXd::Zero(fit.jacobian.rows());
  std::vector<Index> others;
  for (Index k = 0; k < fit.jacobian.cols(); ++k) {
    const std::size_t parameter = static_cast<std::size_t>(k) < fit.active.size()
                                      ? fit.active[static_cast<std::size_t>(k)]
                                      : last;
    if (parameter < first || parameter >= last) {
      others.push_back(k);
      continue;
    }
    const ModelParameter& p = record.parameters()[parameter];
    if (p.shape_only) continue;
    column +=
        (fit.values[parameter] - p.neutral) / p.scale * weight.cwiseProduct(fit.jacobian.col(k));
  }
  return largest_share(record, weight.asDiagonal() * fit.jacobian(Eigen::all, others), column);
}

void add_place_error(const Record& record, const BlockFit& without, const BlockFit& fit,
                     std::size_t group, ModelFit& all) {
  const std::size_t first = record.first_parameter(group);
  const std::vector<ModelParameter>& own = record.problem().groups[group].parameters;
  const auto held =
      std::find_if(own.begin(), own.end(), [](const ModelParameter& p) { return !p.fitted; });
  const auto size = std::find(fit.active.begin(), fit.active.end(), first);
  if (held == own.end() || size == fit.active.end()) return;
  const Index column = size - fit.active.begin();
  std::vector<Index> others;
  for (Index k = 0; k < fit.jacobian.cols(); ++k) {
    if (k != column) others.push_back(k);
  }
  VectorXd slope = fit.jacobian.col(column);
  if (!others.empty()) {
    slope = left_by(fit.jacobian(Eigen::all, others), slope);
  }
  const double cost = jackknife_covariance(fit, {column})(0, 0) * slope.squaredNorm();

  const std::size_t parameter = first + static_cast<std::size_t>(held - own.begin());
  const double place = fit.values[parameter];
  const PlaceGains gains(record, without, group);
  const double most = gains.at(parameter, place);
  const double distance =
      (held->places.back() - held->places.front()) / static_cast<double>(held->places.size());
  const auto reach = [&](double direction, double furthest) {
    double reached = 0;
    for (double step = distance / 100; reached + step < furthest; step *= 1.25) {
      reached += step;
      if (gains.at(parameter, place + direction * reached) < most - cost) return reached;
    }
    return furthest;
  };
  all.standard_error[parameter] =
      (reach(-1, place - held->lower) + reach(1, held->upper - place)) / 2;
}

namespace {

/// Of what is suspected for its gain alone, all that gains nothing beside the surest suspect: a
/// model that may move far mimics much.
void clear_mimics(const Record& record, const Selection& found, const FitWithGroups& with,
                  std::vector<Selection::Open>& open) {
  const auto surer = [](const Selection::Open& a, const Selection::Open& b) {
    const auto sureness = [](const Selection::Open& o) {
      return o.suspected ? o.gain_percent / std::max(o.gain_se_percent, 1e-300) : -infinity;
    };
    return sureness(a) < sureness(b);
  };
  const auto surest = std::max_element(open.begin(), open.end(), surer);
  if (surest == open.end() || !surest->suspected) return;
  const BlockFit beside = with({surest->group}, FitUse::search);
  for (Selection::Open& other : open) {
    if (&other == &*surest || !other.suspected || other.p_value <= suspicious) continue;
    const BlockFit both = with({surest->group, other.group}, FitUse::search);
    other.suspected =
        earns_a_name(record, other.group, gain_between(beside, both), found.least_gain_percent);
  }
}

/// The sizes of a group that is freed in the fit, as far as no bound holds them.
std::vector<SizeEstimate> sizes_in(const Record& record, const BlockFit& fit, std::size_t group) {
  std::vector<SizeEstimate> estimates;
  const std::vector<ModelParameter>& own = record.problem().groups[group].parameters;
  for (std::size_t k = 0; k < own.size(); ++k) {
    if (own[k].shape_only || !own[k].is_free()) continue;
    SizeEstimate& size = estimates.emplace_back();
    size.parameter = record.first_parameter(group) + k;
    size.value = fit.values[size.parameter];
    const auto column = std::ranges::find(fit.active, size.parameter);
    if (column == fit.active.end()) continue;
    size.standard_error =
        own[k].scale * std::sqrt(jackknife_covariance(fit, {column - fit.active.begin()})(0, 0));
  }
  return estimates;
}

/// Takes each of `others` that reaches further from its neutral value.
void reach_further(std::vector<SizeEstimate>& sizes, const std::vector<SizeEstimate>& others,
                   const Record& record, std::size_t group) {
  const double student = student_factor(record, group);
  const auto reach = [&record, student](const SizeEstimate& size) {
    return std::abs(size.value - record.parameters()[size.parameter].neutral) +
           student * size.standard_error;
  };
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    if (others[k].standard_error > 0 && reach(others[k]) > reach(sizes[k])) sizes[k] = others[k];
  }
}

}  // namespace

std::vector<Selection::Open> judge_open(const Record& record, const BlockFit& fit,
                                        std::span<const BlockFit> alternatives,
                                        const Selection& found, const FitWithGroups& with) {
  Groups candidates;
  for (std::size_t g = 0; g < record.problem().groups.size(); ++g) {
    const auto is_told = [g](const SelectedGroup& s) {
      return s.group == g || contains(s.indistinguishable, g);
    };
    const auto is_aliased = [g](const Selection::Aliased& a) { return a.group == g; };
    if (!record.problem().groups[g].fitted &&
        std::none_of(found.selected.begin(), found.selected.end(), is_told) &&
        std::none_of(found.aliased.begin(), found.aliased.end(), is_aliased)) {
      candidates.push_back(g);
    }
  }
  std::vector<Selection::Open> open;
  for (const std::size_t g : candidates) {
    Selection::Open& candidate = open.emplace_back();
    candidate.group = g;
    candidate.sizes = sizes_beside(record, fit, g);
    for (const SizeEstimate& size : candidate.sizes) {
      const double offset = size.value - record.parameters()[size.parameter].neutral;
      const double p =
          2 * student_tail(std::abs(offset) / size.standard_error, degrees_of_freedom(record, g)) *
          static_cast<double>(candidate.sizes.size() * candidates.size()) *
          chances(record.problem().groups[g]);
      if (size.standard_error > 0) candidate.p_value = std::min(candidate.p_value, p);
    }
    for (const BlockFit& alternative : alternatives) {
      reach_further(candidate.sizes,
                    contains(alternative.freed.groups, g) ? sizes_in(record, alternative, g)
                                                          : sizes_beside(record, alternative, g),
                    record, g);
    }
    BlockFit freed = with({g}, FitUse::search);
    Gain gained = gain_between(fit, freed);
    candidate.suspected =
        (contains(found.doubted, g) && gained.percent >= least_worth_telling) ||
        is_hardly_chance(candidate.p_value, gained, found.least_gain_percent,
                         record.problem().groups[g]) ||
        helps_much(gained, typical_gain_between(fit, freed), found.least_gain_percent);
    if (candidate.suspected) {
      freed = with({g}, FitUse::report);
      gained = gain_between(fit, freed);
    }
    candidate.gain_percent = gained.percent;
    candidate.gain_se_percent = gained.se;
    candidate.largest_block_share = largest_block_share(record, freed, g);
    candidate.at_bound = is_at_bound(record, freed, g);
    candidate.spoils_kind = spoils_a_kind(record, fit, freed);
    candidate.freed = neutral_fit(record);
    add_fit(record, freed, {}, candidate.freed);
    if (is_placed(record.problem().groups[g])) {
      add_place_error(record, fit, freed, g, candidate.freed);
    }
  }
  clear_mimics(record, found, with, open);
  return open;
}

Groups in_order_of_nearness(std::vector<std::pair<double, std::size_t>> found) {
  std::sort(found.begin(), found.end());
  Groups groups;
  for (const auto& [distance, group] : found) groups.push_back(group);
  return groups;
}

ModelFit neutral_fit(const Record& record) {
  ModelFit fit;
  for (const ModelParameter& p : record.parameters()) fit.values.push_back(p.neutral);
  fit.standard_error.assign(fit.values.size(), 0);
  fit.product_covariance.assign(fit.values.size(), 0);
  fit.without_block.assign(record.blocks(), fit.values);
  return fit;
}

VectorXd systematic_variance(const Record& record, const BlockFit& fit) {
  VectorXd variance = VectorXd::Zero(fit.jacobian.cols());
  if (fit.jacobian.cols() == 0) return variance;
  const MatrixXd weighted = fit.weight.cwiseSqrt().asDiagonal() * fit.jacobian;
  for (const std::vector<double>& column : record.problem().systematic) {
    const VectorXd change = fit.weight.cwiseSqrt().cwiseProduct(record.scaled_column(column));
    variance += least_squares(weighted, change).cwiseAbs2();
  }
  return variance;
}

void add_fit(const Record& record, const BlockFit& fit, const VectorXd& systematic, ModelFit& all) {
  for (const std::size_t g : fit.freed.groups) {
    const std::size_t first = record.first_parameter(g);
    for (std::size_t k = 0; k < record.problem().groups[g].parameters.size(); ++k) {
      all.values[first + k] = fit.values[first + k];
      for (auto& values : all.without_block) values[first + k] = fit.values[first + k];
    }
  }
  for (std::size_t k = 0; k < fit.active.size(); ++k) {
    const std::size_t index = fit.active[k];
    const auto column = static_cast<Index>(k);
    const ModelParameter& p = record.parameters()[index];
    const double variance = jackknife_covariance(fit, {column})(0, 0) +
                            (systematic.size() > 0 ? systematic[column] : 0);
    all.standard_error[index] = std::max(all.standard_error[index], p.scale * std::sqrt(variance));
    const auto other = std::find(fit.active.begin(), fit.active.end(), p.product_with);
    if (other != fit.active.end()) {
      all.product_covariance[index] =
          p.scale * record.parameters()[*other].scale *
          jackknife_covariance(fit, {column, other - fit.active.begin()})(0, 1);
    }
    for (std::size_t b = 0; b < record.blocks(); ++b) {
      double& value = all.without_block[b][index];
      value = std::clamp(value + p.scale * fit.left_out(column, static_cast<Index>(b)), p.lower,
                         p.upper);
    }
  }
}

UnnamedStructure unnamed_in(const Record& record, const BlockFit& complete, const BlockFit& named,
                            const SelectionOptions& options) {
  UnnamedStructure unnamed;
  // A quarter of the squared error that a name has to remove.
  const double least_share = options.least_gain_percent / 2;
  const double share = 100 * (1 - complete.squared_error() / named.squared_error());
  if (complete.freed.unnamed.empty() || share < least_share) return unnamed;
  unnamed.share_percent = share;
  unnamed.regressors = complete.freed.unnamed;
  unnamed.coefficients.assign(complete.coefficients.begin(), complete.coefficients.end());
  for (const std::size_t u : unnamed.regressors) {
    const std::string& channel = record.problem().unnamed[u].channel;
    if (!contains(unnamed.channels, channel)) unnamed.channels.push_back(channel);
  }
  return unnamed;
}

Selection nothing_selected(const Record& record, const SelectionOptions& options) {
  Selection nothing;
  nothing.rows = static_cast<std::size_t>(record.rows());
  nothing.blocks = record.blocks();
  for (std::size_t g = 0; g < record.problem().groups.size(); ++g) {
    nothing.student_factor.push_back(student_factor(record, g));
  }
  nothing.least_gain_percent = options.least_gain_percent;
  return nothing;
}

// --- Structure without a name ---

std::optional<UnnamedTrial> best_unnamed(const Record& record, const BlockFit& fit,
                                         const std::vector<std::size_t>& taken,
                                         double false_alarm_probability) {
  const auto count = static_cast<Index>(record.problem().unnamed.size());
  if (count == 0) return std::nullopt;
  const auto blocks = static_cast<Index>(record.blocks());

  std::vector<BlockSums> held_out;
  std::vector<BlockSums> fitted;
  for (std::size_t b = 0; b < record.blocks(); ++b) {
    held_out.push_back(sums(record, fit, b, false));
    fitted.push_back(sums(record, fit, b, true));
  }
  BlockSums total = fitted.front();
  for (std::size_t b = 1; b < record.blocks(); ++b) add(total, fitted[b], 1);

  MatrixXd coefficient(blocks, count);
  MatrixXd error(blocks, count);
  VectorXd own_part = VectorXd::Ones(count);
  for (Index b = 0; b < blocks; ++b) {
    BlockSums rest = total;
    add(rest, fitted[static_cast<std::size_t>(b)], -1);
    const BlockSums& out = held_out[static_cast<std::size_t>(b)];
    const Index size = rest.normal.rows();
    MatrixXd along = MatrixXd::Zero(size, count);  // (JᵀJ)⁻¹JᵀZ
    VectorXd step = VectorXd::Zero(size);
    if (size > 0) {
      along = solve_symmetric(rest.normal, rest.cross);
      step = solve_symmetric(rest.normal, rest.gradient);
    }
    for (Index k = 0; k < count; ++k) {
      const double own = rest.own[k] - rest.cross.col(k).dot(along.col(k));
      own_part[k] = std::min(own_part[k], rest.own[k] > 0 ? own / rest.own[k] : 0);
      if (own_part[k] < least_own_part) continue;
      const double beta = (rest.slope[k] - rest.cross.col(k).dot(step)) / own;
      const VectorXd delta = step - along.col(k) * beta;
      coefficient(b, k) = beta;
      error(b, k) = out.squared_residual + delta.dot(out.normal * delta) +
                    beta * beta * out.own[k] - 2 * (delta.dot(out.gradient) + beta * out.slope[k]) +
                    2 * beta * delta.dot(out.cross.col(k));
    }
  }

  const auto degrees = static_cast<double>(blocks - 1);
  const double threshold =
      -student_quantile(degrees, false_alarm_probability / 2 / static_cast<double>(count));
  std::optional<Index> best;
  for (Index k = 0; k < count; ++k) {
    if (own_part[k] < least_own_part || contains(taken, static_cast<std::size_t>(k))) continue;
    const VectorXd values = coefficient.col(k);
    const double mean = values.mean();
    const double se =
        std::sqrt(degrees / static_cast<double>(blocks) * (values.array() - mean).square().sum());
    if (!(std::abs(mean) > threshold * se)) continue;
    if (!best || error.col(k).sum() < error.col(*best).sum()) best = k;
  }
  if (!best) return std::nullopt;
  return UnnamedTrial{static_cast<std::size_t>(*best), error.col(*best)};
}

}  // namespace tethercalc
