#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "diagnose/fit_judgement.hpp"
#include "identify/statistics.hpp"
#include "model/constants.hpp"

namespace tethercalc {
namespace {

/// Sets that were not made of the best one by adding must be shorter than it by this much: e⁻³ = 5
/// % of the likelihood.
constexpr double clearly_shorter = 6;
/// A rival whose description is longer by less than this is not ruled out: e⁻⁴·⁵ = 1 % of the
/// likelihood, as at most one name in a hundred may be wrong.
constexpr double rival_excess = 9;
/// Shapes take the place of names only where they shorten the description by this much more: a
/// mechanism that is known to exist is the likelier cause, and the true shape of a named effect
/// differs a little from the idealised one. e⁻⁴ = 2 % of the likelihood.
constexpr double name_preference = 8;
/// What has no size but begins with a leap, as a cable that is at the air's temperature once its
/// heat is counted, comes behind those that explain as much.
constexpr double leap_alone = clearly_shorter;
/// Part of what unnamed shapes remove that they may miss of the unknown. A name beside them must
/// explain more than that, or it might name the unknown's rest.
constexpr double missed_by_shapes = 0.1;
constexpr std::size_t most_shapes = 3;  ///< more would describe noise that nobody reads
constexpr std::size_t beam = 4;         ///< subsets of one size that are tried with one more effect
/// Subsets of one size that are fitted: those that lower the squared error most where the model is
/// linear, which it nearly is.
constexpr std::size_t tried_sets = 12;

/// Exchanged for one name, those that leave the least error.
constexpr std::size_t exchanged_for_one = 3;

/// A name may leave so many times as much of the readings themselves: slow noise of a dozen
/// correlation times lets a true one leave a little more by chance.
constexpr double most_left = 1.25;

struct Model {
  Groups named;  ///< sorted
  Groups shapes;
  BlockFit fit;
  double length = 0;  ///< description length, in units of squared noise
};

/// What is told of a fit, with standard errors from the curvature of the likelihood. Unlike the
/// jackknife of the fit, they count what a parameter that rests on a bound leaves open in the
/// others.
ModelFit model_fit(const Record& record, const BlockFit& fit) {
  ModelFit all = neutral_fit(record);
  all.holdout_rmse = fit.rmse();
  const MatrixXd slopes = group_slopes(record, fit.freed.groups, fit.values);
  const auto shapes = static_cast<Index>(fit.freed.unnamed.size());
  MatrixXd jacobian(record.rows(), slopes.cols() + shapes);
  jacobian << slopes, fit.jacobian.rightCols(shapes);
  MatrixXd covariance;
  VectorXd systematic = VectorXd::Zero(jacobian.cols());
  if (slopes.cols() > 0) {
    covariance = symmetric_pseudo_inverse(gram_matrix(jacobian));
    for (const std::vector<double>& error : record.problem().systematic) {
      const VectorXd followed =
          covariance * inner_products_with(jacobian, record.scaled_column(error));
      systematic += followed.cwiseAbs2();
    }
  }
  Index column = 0;
  for (const std::size_t g : fit.freed.groups) {
    std::size_t index = record.first_parameter(g);
    for (const ModelParameter& p : record.problem().groups[g].parameters) {
      if (p.is_free()) {
        all.standard_error[index] =
            p.scale * std::sqrt(std::max(0.0, covariance(column, column)) + systematic[column]);
        ++column;
      }
      ++index;
    }
  }
  add_fit(record, fit, systematic_variance(record, fit), all);
  return all;
}

/// By how much other names would lower the squared error of a fit if the prediction were linear in
/// their parameters, from neutral on.
class LinearisedGains {
 public:
  /// `candidates` with those that are freed in the fit.
  LinearisedGains(const Record& record, const BlockFit& fit, const Groups& candidates) {
    const VectorXd weight = fit.weight.cwiseSqrt();
    MatrixXd slopes = fit.jacobian;
    for (std::size_t g = 0; g < record.problem().groups.size(); ++g) {
      Columns own;
      for (std::size_t k = 0; k < fit.active.size(); ++k) {
        const std::size_t first = record.first_parameter(g);
        const std::size_t p = fit.active[k];
        if (p < first || p >= first + record.problem().groups[g].parameters.size()) continue;
        const ModelParameter& parameter = record.parameters()[p];
        own.index.push_back(static_cast<Index>(k));
        own.off_neutral.push_back((fit.values[p] - parameter.neutral) / parameter.scale);
      }
      if (!contains(candidates, g)) {
        always_.insert(always_.end(), own.index.begin(), own.index.end());
        continue;
      }
      if (!contains(fit.freed.groups, g)) {
        const MatrixXd at_start = slopes_at_start(record, fit.values, g);
        for (Index k = 0; k < at_start.cols(); ++k) own.index.push_back(slopes.cols() + k);
        slopes.conservativeResize(Eigen::NoChange, slopes.cols() + at_start.cols());
        slopes.rightCols(at_start.cols()) = at_start;
      }
      columns_.emplace(g, std::move(own));
    }
    slopes = weight.asDiagonal() * slopes;
    gram_ = gram_matrix(slopes);
    along_ = inner_products_with(slopes, weight.cwiseProduct(fit.residual));
  }

  /// With `named` freed, of which the fit frees some, and `out` back at neutral.
  [[nodiscard]] double of(const Groups& named, const Groups& out) const {
    VectorXd back = VectorXd::Zero(gram_.cols());
    for (const std::size_t g : out) {
      const Columns& own = columns_.at(g);
      for (std::size_t k = 0; k < own.off_neutral.size(); ++k) {
        back[own.index[k]] = own.off_neutral[k];
      }
    }
    std::vector<Index> free = always_;
    for (const std::size_t g : named) {
      const std::vector<Index>& own = columns_.at(g).index;
      free.insert(free.end(), own.begin(), own.end());
    }
    const VectorXd moved = inner_products_with(gram_, back);
    const VectorXd to_explain = along_ + moved;
    const VectorXd along = to_explain(free);
    return along.dot(pseudo_solution(gram_(free, free), along)) - back.dot(along_) -
           back.dot(to_explain);
  }

 private:
  struct Columns {
    std::vector<Index> index;
    std::vector<double> off_neutral;  ///< in scales; none where it is not freed
  };
  std::map<std::size_t, Columns> columns_;
  std::vector<Index> always_;  ///< columns of what every fit frees
  MatrixXd gram_;              ///< of all slopes
  VectorXd along_;             ///< the residual along each of them
};

class SubsetSearch {
 public:
  SubsetSearch(const SelectionProblem& problem, const SelectionOptions& options,
               const SelectionProgress& progress)
      : problem_(problem), record_(problem), options_(options), progress_(progress) {
    for (std::size_t g = 0; g < problem.groups.size(); ++g) {
      if (problem.groups[g].fitted) {
        fitted_.push_back(g);
      } else if (!problem.groups[g].twin_of) {
        candidates_.push_back(g);
      }
    }
    const double alpha = options.false_alarm_probability;
    const auto price = [alpha](std::size_t choices) {
      return 2 * std::log(std::max(1.0, static_cast<double>(choices)) / alpha);
    };
    name_price_ = price(problem.groups.size());
    shape_price_ = price(problem.unnamed.size());
  }

  Selection run() {
    place_fitted(record_);
    base_ = model({}, {}, nullptr);
    best_ = base_;
    for (const std::size_t g : candidates_) {
      if (is_placed(problem_.groups[g])) choose_places(record_, base_.fit, g);
    }
    find_aliased(base_, false);
    for (const Selection::Aliased& a : aliased_) std::erase(candidates_, a.group);
    search_names();
    search_shapes();
    if (!best_.shapes.empty()) add_names();
    if (!best_.named.empty()) find_aliased(best_, true);
    drop_unearned();
    return sum_up();
  }

 private:
  /// Whether the names leave clearly more of the readings than all but one of them do.
  [[nodiscard]] bool misfits(const Groups& named, const std::vector<double>& values) const {
    if (!problem_.left_of_readings) return false;
    const std::vector<double> left = problem_.left_of_readings(values);
    bool more = false;
    for (const std::size_t g : named) {
      const auto fewer = left_by_.find(without_group(named, g));
      if (fewer == left_by_.end()) continue;
      for (std::size_t k = 0; k < left.size(); ++k) more |= left[k] > most_left * fewer->second[k];
    }
    left_by_.emplace(named, left);
    return more;
  }

  /// Whether nothing but the leap with which it begins is left of it.
  [[nodiscard]] bool has_no_size(std::size_t g, const std::vector<double>& values) const {
    constexpr double none = 1e-3;  // of a change that matters
    const std::vector<ModelParameter>& parameters = problem_.groups[g].parameters;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      const ModelParameter& p = parameters[k];
      const double change = values[record_.first_parameter(g) + k] - p.neutral;
      if (!p.shape_only && std::abs(change) > none * p.scale) return false;
    }
    return true;
  }

  /// Its length is infinite where it misfits, or a name ends where its range does.
  [[nodiscard]] Model model(const Groups& named, const Groups& shapes, const BlockFit* near,
                            FitUse use = FitUse::search) const {
    Freed freed;
    freed.groups = fitted_;
    freed.groups.insert(freed.groups.end(), named.begin(), named.end());
    std::sort(freed.groups.begin(), freed.groups.end());
    freed.unnamed = shapes;
    Model result{named, shapes, fit_blocks(record_, freed, near, use), 0};
    const auto ends_with_its_range = [&](std::size_t g) {
      return is_at_bound(record_, result.fit, g);
    };
    if (std::any_of(named.begin(), named.end(), ends_with_its_range)) result.length = infinity;
    if (shapes.empty() && misfits(named, result.fit.values)) result.length = infinity;
    result.length += result.fit.squared_error() + shape_price_ * static_cast<double>(shapes.size());
    for (const std::size_t g : named) {
      result.length += name_price_ + 2 * std::log(chances(problem_.groups[g]));
      if (has_no_size(g, result.fit.values)) result.length += leap_alone;
    }
    if (shapes.empty() && result.length < infinity) {
      error_by_.emplace(named, result.fit.squared_error());
    }
    if (named.empty() || shapes.empty()) return result;
    const double missed =
        missed_by_shapes *
        std::max(0.0, fit_blocks(record_, {freed.groups, {}}, near).squared_error() -
                          result.fit.squared_error());
    for (const std::size_t g : named) {
      const Freed without{without_group(freed.groups, g), shapes};
      const double earned =
          fit_blocks(record_, without, &result.fit).squared_error() - result.fit.squared_error();
      if (earned < name_price_ + missed) result.length += missed;
    }
    return result;
  }

  void consider(Model candidate, double handicap = 0) {
    if (candidate.length + handicap < best_.length) best_ = std::move(candidate);
  }

  /// Sets of one candidate more than `parents`, or two, that promise most.
  [[nodiscard]] std::map<Groups, const Model*> promising(const std::vector<Model>& parents,
                                                         bool two_more) const {
    std::vector<std::tuple<double, Groups, const Model*>> sets;
    for (const Model& parent : parents) {
      Groups open;
      for (const std::size_t g : candidates_) {
        if (!contains(parent.named, g)) open.push_back(g);
      }
      const LinearisedGains gains(record_, parent.fit, candidates_);
      const auto add = [&](const Groups& more) {
        Groups named = parent.named;
        for (const std::size_t g : more) named = with_group(named, g);
        sets.emplace_back(parent.fit.residual.squaredNorm() - gains.of(named, {}), named, &parent);
      };
      for (std::size_t a = 0; a < open.size(); ++a) {
        if (!two_more) add({open[a]});
        for (std::size_t b = a + 1; two_more && b < open.size(); ++b) add({open[a], open[b]});
      }
    }
    std::sort(sets.begin(), sets.end());
    std::map<Groups, const Model*> best;
    for (const auto& [error, named, parent] : sets) {
      if (best.size() < tried_sets) best.emplace(named, parent);
    }
    return best;
  }

  void search_names() {
    for (const std::size_t g : candidates_) {
      if (progress_) progress_("trying " + problem_.groups[g].id);
      consider(model({g}, {}, &base_.fit));
    }
    // Two effects may cancel, so pairs are tried whatever singles say; three hardly do.
    std::vector<Model> level{base_};
    for (std::size_t size = 2; size <= std::min(options_.most_findings, candidates_.size());
         ++size) {
      std::vector<Model> next;
      for (const auto& [named, parent] : promising(level, size == 2)) {
        next.push_back(model(named, {}, &parent->fit));
      }
      level = std::move(next);
      std::sort(level.begin(), level.end(),
                [](const Model& a, const Model& b) { return a.length < b.length; });
      if (level.empty() || !(level.front().length < best_.length)) break;
      // Names that are not those found so far and one more may mimic what fewer explain.
      const Groups fewer = best_.named;
      for (const Model& more : level) {
        const bool adds =
            std::includes(more.named.begin(), more.named.end(), fewer.begin(), fewer.end());
        consider(more, adds ? 0 : clearly_shorter);
      }
      if (level.size() > beam) level.erase(level.begin() + beam, level.end());
    }
    exchange_names();
  }

  /// So many of the models, those with the least of something.
  [[nodiscard]] static std::vector<Model> least(std::vector<Model> models,
                                                double (*something)(const Model&),
                                                std::size_t count) {
    std::vector<std::pair<double, std::size_t>> order;
    for (const Model& m : models) order.emplace_back(something(m), order.size());
    std::vector<Model> first;
    for (const std::size_t k : in_order_of_nearness(std::move(order))) {
      if (first.size() < count) first.push_back(std::move(models[k]));
    }
    return first;
  }

  /// The best names with one in the place of each that explains nearly as much as it does.
  [[nodiscard]] std::vector<Model> exchanged(const Model& now) const {
    std::vector<Model> all;
    for (const std::size_t out : now.named) {
      const std::vector<Model> rest{model(without_group(now.named, out), {}, &now.fit)};
      std::vector<Model> instead;
      for (const auto& [named, parent] : promising(rest, false)) {
        if (named != now.named) instead.push_back(model(named, {}, &parent->fit));
      }
      const auto error = [](const Model& m) { return m.fit.squared_error(); };
      for (Model& m : least(std::move(instead), error, exchanged_for_one)) {
        all.push_back(std::move(m));
      }
    }
    return all;
  }

  /// Sets that differ from the parent's by up to two names less and up to two more and promise the
  /// shortest descriptions.
  [[nodiscard]] std::vector<Groups> promising_exchanges(const Model& parent) const {
    const LinearisedGains gains(record_, parent.fit, candidates_);
    Groups open;
    for (const std::size_t g : candidates_) {
      if (!contains(parent.named, g)) open.push_back(g);
    }
    std::vector<std::pair<double, Groups>> sets;
    for (const Groups& out : none_one_or_two_of(parent.named)) {
      Groups rest = parent.named;
      for (const std::size_t g : out) rest = without_group(rest, g);
      for (const Groups& in : none_one_or_two_of(open)) {
        Groups named = rest;
        for (const std::size_t g : in) named = with_group(named, g);
        if (named.empty() || named.size() > options_.most_findings) continue;
        const double names = name_price_ * static_cast<double>(named.size());
        sets.emplace_back(names - gains.of(named, out), std::move(named));
      }
    }
    std::sort(sets.begin(), sets.end());
    std::vector<Groups> best;
    for (auto& [length, named] : sets) {
      if (best.size() < tried_sets) best.push_back(std::move(named));
    }
    return best;
  }

  [[nodiscard]] static std::vector<Groups> none_one_or_two_of(const Groups& groups) {
    std::vector<Groups> all{{}};
    for (std::size_t a = 0; a < groups.size(); ++a) {
      all.push_back({groups[a]});
      for (std::size_t b = a + 1; b < groups.size(); ++b) all.push_back({groups[a], groups[b]});
    }
    return all;
  }

  /// From the best names to better ones by exchanging some. A name that mimics two together is
  /// found before either of them, alone they may not fit at all, and names added to it mend what it
  /// does wrong.
  void exchange_names() {
    if (best_.named.size() < 2) return;
    if (progress_) progress_("exchanging effects");
    std::vector<Model> known = exchanged(best_);
    for (const Model& other : known) consider(other, clearly_shorter);
    known.push_back(best_);
    std::set<Groups> fitted;
    for (const Model& m : known) fitted.insert(m.named);
    std::set<Groups> left;  // of which all neighbours that promise most are known
    for (bool anew = true; anew;) {
      known = least(
          std::move(known), [](const Model& m) { return m.length; }, beam);
      std::vector<Model> found;
      for (const Model& parent : known) {
        if (!left.insert(parent.named).second) continue;
        for (const Groups& named : promising_exchanges(parent)) {
          if (!fitted.insert(named).second) continue;
          found.push_back(model(named, {}, &parent.fit));
          consider(found.back(), clearly_shorter);
        }
      }
      for (Model& m : found) known.push_back(std::move(m));
      anew = !found.empty();
    }
  }

  /// Shapes beside all of the names and instead of them; and, as some of them may mimic what has no
  /// name, beside all but one or two of them and beside each alone.
  void search_shapes() {
    if (problem_.unnamed.empty()) return;
    if (progress_) progress_("looking for structure without a name");
    const Model named = best_;
    consider(with_shapes(named));
    if (named.named.empty()) return;
    std::vector<Groups> kept{{}};
    for (std::size_t a = 0; a < named.named.size(); ++a) {
      const Groups rest = without_group(named.named, named.named[a]);
      if (rest.size() > 2) kept.push_back({named.named[a]});
      if (!rest.empty()) kept.push_back(rest);
      for (std::size_t b = a; b < rest.size() && rest.size() > 1; ++b) {
        kept.push_back(without_group(rest, rest[b]));
      }
    }
    for (const Groups& names : kept) {
      consider(with_shapes(names.empty() ? base_ : model(names, {}, &named.fit)), name_preference);
    }
  }

  /// Adds the unnamed shapes that are worth their price.
  [[nodiscard]] Model with_shapes(Model start) const {
    Model best = std::move(start);
    while (best.shapes.size() < most_shapes) {
      const std::optional<UnnamedTrial> trial =
          best_unnamed(record_, best.fit, best.shapes, options_.false_alarm_probability);
      if (!trial || best.fit.squared_error() - trial->block_error.sum() < shape_price_) {
        break;
      }
      Groups shapes = best.shapes;
      shapes.push_back(trial->regressor);
      best = model(best.named, shapes, &best.fit);
    }
    return best;
  }

  /// What the unknown had hidden; and names that beside it explain nothing go.
  void add_names() {
    for (bool changed = true; changed;) {
      changed = false;
      const Model now = best_;
      for (const std::size_t g : candidates_) {
        const bool in = contains(now.named, g);
        if (!in && now.named.size() >= options_.most_findings) continue;
        const Groups named = in ? without_group(now.named, g) : with_group(now.named, g);
        consider(model(named, now.shapes, &now.fit));
      }
      for (const std::size_t u : now.shapes) {
        consider(model(now.named, without_group(now.shapes, u), &now.fit));
      }
      changed = best_.length < now.length - 1e-9;
    }
  }

  void find_aliased(const Model& model, bool beside_findings) {
    for (const std::size_t g : candidates_) {
      if (contains(model.named, g)) continue;
      auto aliased = aliased_in(record_, model.fit, g);
      if (aliased && !(aliased->with.empty() && beside_findings)) {
        aliased_.push_back(std::move(*aliased));
      }
    }
  }

  /// The best model, but for one of its names.
  [[nodiscard]] Model best_without(std::size_t g, FitUse use = FitUse::search) const {
    return model(without_group(best_.named, g), best_.shapes, &best_.fit, use);
  }

  [[nodiscard]] double squared_error_of(const Groups& named) const {
    const auto known = error_by_.find(named);
    return known != error_by_.end() ? known->second
                                    : model(named, {}, &best_.fit).fit.squared_error();
  }

  /// Other sets of at most one name more that explain the record about as well and need each of
  /// theirs: two causes may be mimicked by two others, or by one, none of which mimics one of them
  /// alone.
  [[nodiscard]] std::vector<Model> other_sets() const {
    std::vector<Model> sets;
    if (best_.named.empty() || !best_.shapes.empty()) return sets;
    const double worst = best_.fit.squared_error() + rival_excess;
    std::vector<std::pair<double, Groups>> near;
    for (const auto& [named, error] : error_by_) {
      const bool other = !is_part(named, best_.named) && !is_part(best_.named, named);
      if (other && named.size() <= best_.named.size() + 1 && error <= worst) {
        near.emplace_back(error, named);
      }
    }
    std::ranges::sort(near);
    for (const auto& [error, named] : near) {
      if (sets.size() == beam) break;
      const auto is_needed = [&, &names = named](std::size_t g) {
        return squared_error_of(without_group(names, g)) > worst;
      };
      if (std::ranges::all_of(named, is_needed)) sets.push_back(model(named, {}, &best_.fit));
    }
    return sets;
  }

  [[nodiscard]] static bool is_part(const Groups& part, const Groups& of) {
    return std::includes(of.begin(), of.end(), part.begin(), part.end());
  }

  /// `others` as `other_sets` has them.
  [[nodiscard]] Groups rivals(std::size_t g, const std::vector<Model>& others) const {
    const Groups rest = without_group(best_.named, g);
    const double alone = best_without(g).fit.squared_error();
    const double earned = alone - best_.fit.squared_error();
    std::vector<std::pair<double, std::size_t>> found;
    for (const std::size_t c : candidates_) {
      if (contains(best_.named, c)) continue;
      const Model rival = model(with_group(rest, c), best_.shapes, &best_.fit);
      if (rival.length - best_.length <= rival_excess &&
          alone - rival.fit.squared_error() >= rival_gain * earned) {
        found.emplace_back(rival.length, c);
      }
    }
    Groups told{g};
    for (const std::size_t c : in_order_of_nearness(std::move(found))) told.push_back(c);
    for (const Model& other : others) {
      // More names are told only where they earn their price.
      if (contains(other.named, g) || other.length > best_.length + rival_excess) continue;
      for (const std::size_t c : other.named) {
        if (!contains(best_.named, c) && !contains(told, c)) told.push_back(c);
      }
    }
    Groups result;  // each with its twins, which every record shows told
    for (const std::size_t c : told) {
      if (c != g) result.push_back(c);
      for (std::size_t twin = 0; twin < problem_.groups.size(); ++twin) {
        const ParameterGroup& other = problem_.groups[twin];
        if (other.twin_of == c && !other.fitted) result.push_back(twin);
      }
    }
    return result;
  }

  /// The names of the best model in the order of what they add, with their gains.
  [[nodiscard]] std::vector<SelectedGroup> selected() const {
    std::vector<SelectedGroup> order;
    Groups so_far;
    BlockFit before = base_.fit;
    while (so_far.size() < best_.named.size()) {
      std::optional<std::pair<std::size_t, BlockFit>> next;
      for (const std::size_t g : best_.named) {
        if (contains(so_far, g)) continue;
        BlockFit fit = model(with_group(so_far, g), {}, &best_.fit, FitUse::report).fit;
        if (!next || fit.squared_error() < next->second.squared_error()) next = {g, std::move(fit)};
      }
      so_far = with_group(so_far, next->first);
      order.push_back(freed_between(before, next->second, next->first));
      before = std::move(next->second);
    }
    return order;
  }

  /// Leaves out the names whose gain, where they stand in the order or beside all others, does not
  /// earn one, the weakest first; by the fits that will be told.
  void drop_unearned() {
    base_ = model({}, {}, nullptr, FitUse::report);
    while (true) {
      best_ = model(best_.named, best_.shapes, &best_.fit, FitUse::report);
      std::vector<NamedGains> names;
      for (const SelectedGroup& s : selected()) {
        const BlockFit without = best_without(s.group, FitUse::report).fit;
        names.push_back(
            {s.group, {s.gain_percent, s.gain_se_percent}, gain_between(without, best_.fit)});
      }
      const auto unearned = weakest_unearned(record_, names, options_.least_gain_percent);
      if (!unearned) return;
      if (unearned->gain.percent >= options_.least_gain_percent) {
        doubted_.push_back(unearned->group);
      }
      best_ = best_without(unearned->group);
    }
  }

  [[nodiscard]] Selection sum_up() {
    Selection result = nothing_selected(record_, options_);
    result.aliased = aliased_;
    result.selected = selected();
    std::vector<Model> others = other_sets();
    for (SelectedGroup& entry : result.selected) {
      entry.indistinguishable = rivals(entry.group, others);
      entry.p_value = chi_squared_tail(
          best_without(entry.group).fit.squared_error() - best_.fit.squared_error(),
          static_cast<double>(problem_.groups[entry.group].parameters.size()));
    }
    result.doubted = doubted_;
    std::vector<BlockFit> alternatives;
    for (Model& other : others) alternatives.push_back(std::move(other.fit));
    result.open = judge_open(record_, best_.fit, alternatives, result,
                             [this](const Groups& more, FitUse use) {
                               Groups named = best_.named;
                               for (const std::size_t g : more) named = with_group(named, g);
                               return model(named, best_.shapes, &best_.fit, use).fit;
                             });
    for (Selection::Open& open : result.open) {
      open.suspected =
          open.suspected && !misfits(with_group(best_.named, open.group), open.freed.values);
    }
    const BlockFit named =
        best_.shapes.empty() ? best_.fit : model(best_.named, {}, &best_.fit, FitUse::report).fit;
    result.base = model_fit(record_, base_.fit);
    result.extended = model_fit(record_, named);
    result.complete = model_fit(record_, best_.fit);
    for (const std::size_t g : best_.named) {
      if (is_placed(problem_.groups[g])) {
        add_place_error(record_, best_without(g).fit, best_.fit, g, result.complete);
      }
    }
    result.unnamed = unnamed_in(record_, best_.fit, named, options_);
    return result;
  }

  const SelectionProblem& problem_;
  Record record_;
  const SelectionOptions& options_;
  const SelectionProgress& progress_;
  Groups fitted_;
  Groups candidates_;
  double name_price_ = 0;
  double shape_price_ = 0;
  Model base_;
  Model best_;
  std::vector<Selection::Aliased> aliased_;
  Groups doubted_;  ///< names that were left out although they gain what is asked
  /// Squared errors of all sets of names that were fitted, but for those that cannot be.
  mutable std::map<Groups, double> error_by_;
  mutable std::map<Groups, std::vector<double>> left_by_;  ///< of the readings, by sets of names
};

}  // namespace

Selection select_subset(const SelectionProblem& problem, const SelectionOptions& options,
                        const SelectionProgress& progress) {
  return SubsetSearch(problem, options, progress).run();
}

}  // namespace tethercalc
