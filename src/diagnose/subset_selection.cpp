#include "diagnose/subset_selection.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <list>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "diagnose/fit_judgement.hpp"
#include "diagnose/unnamed_structure.hpp"
#include "identify/distributions.hpp"
#include "identify/linear_algebra.hpp"
#include "identify/series.hpp"

namespace tethercalc {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A rival whose description is longer by less than this is not ruled out: e⁻³ = 5 % of the
/// likelihood.
constexpr double rival_excess = 6;
/// Shapes take the place of names only where they shorten the description by this much more: a
/// mechanism that is known to exist is the likelier cause, and the true shape of a named effect
/// differs a little from the idealised one. e⁻⁴ = 2 % of the likelihood.
constexpr double name_preference = 8;
/// Part of what unnamed shapes remove that they may miss of the unknown. A name beside them must
/// explain more than that, or it might name the unknown's rest.
constexpr double missed_by_shapes = 0.1;
constexpr std::size_t most_shapes = 3;  ///< more would describe noise that nobody reads
constexpr std::size_t beam = 4;         ///< subsets of one size that are tried with one more effect

struct Model {
  Groups named;  ///< sorted
  Groups shapes;
  BlockFit fit;
  double length = 0;  ///< description length, in units of squared noise
};

/// `whole` with the rows of one part and the shapes that concern them, whose indices in `whole` go
/// to `shapes`.
SelectionProblem problem_of_rows(const SelectionProblem& whole, const std::vector<char>& rows,
                                 Groups& shapes) {
  SelectionProblem part = whole;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i]) part.block[i] = -1;
  }
  part.unnamed.clear();
  for (std::size_t u = 0; u < whole.unnamed.size(); ++u) {
    const std::vector<double>& column = whole.unnamed[u].column;
    bool concerns = true;
    for (std::size_t i = 0; i < column.size(); ++i) concerns &= column[i] == 0 || rows[i];
    if (!concerns) continue;
    shapes.push_back(u);
    part.unnamed.push_back(whole.unnamed[u]);
  }
  return part;
}

/// The search in one part.
class PartSearch {
 public:
  PartSearch(const SelectionProblem& whole, const SelectionPart& part,
             const SelectionOptions& options, const SelectionProgress& progress)
      : problem_(problem_of_rows(whole, part.rows, shape_index_)),
        record_(problem_),
        options_(options),
        progress_(progress) {
    const std::set<int> blocks(problem_.block.begin(), problem_.block.end());
    block_ids_.assign(blocks.upper_bound(-1), blocks.end());
    for (const std::size_t g : part.groups) {
      (problem_.groups[g].fitted ? fitted_ : candidates_).push_back(g);
    }
    const double alpha = options.false_alarm_probability;
    const auto price = [alpha](std::size_t choices) {
      return 2 * std::log(std::max(1.0, static_cast<double>(choices)) / alpha);
    };
    name_price_ = price(problem_.groups.size());
    shape_price_ = price(problem_.unnamed.size());
  }

  void run() {
    base_ = model({}, {}, nullptr);
    best_ = base_;
    find_aliased(base_, false);
    for (const Selection::Aliased& a : aliased_) std::erase(candidates_, a.group);
    search_names();
    search_shapes();
    if (!best_.shapes.empty()) add_names();
    if (!best_.named.empty()) find_aliased(best_, true);
  }

  /// Leaves a name of the best model out.
  void take_back(std::size_t g) { best_ = best_without(g); }

  PartSearch(const PartSearch&) = delete;  // the record refers to the problem
  PartSearch& operator=(const PartSearch&) = delete;

  [[nodiscard]] const Record& record() const { return record_; }
  /// Of the shapes of this part among those of the whole.
  [[nodiscard]] const Groups& shape_index() const { return shape_index_; }
  /// Of the blocks of this part in the whole.
  [[nodiscard]] const std::vector<int>& block_ids() const { return block_ids_; }
  [[nodiscard]] const Model& base() const { return base_; }
  [[nodiscard]] const Model& best() const { return best_; }
  [[nodiscard]] const std::vector<Selection::Aliased>& aliased() const { return aliased_; }

  /// The named effects of the best model in the order of what they add, with the fit after each.
  [[nodiscard]] std::vector<std::pair<std::size_t, BlockFit>> in_order() const {
    std::vector<std::pair<std::size_t, BlockFit>> order;
    Groups so_far;
    const BlockFit* near = &best_.fit;
    while (so_far.size() < best_.named.size()) {
      std::optional<std::pair<std::size_t, BlockFit>> next;
      for (const std::size_t g : best_.named) {
        if (contains(so_far, g)) continue;
        BlockFit fit = model(with_group(so_far, g), {}, near).fit;
        if (!next || fit.squared_error() < next->second.squared_error()) next = {g, std::move(fit)};
      }
      so_far = with_group(so_far, next->first);
      order.push_back(std::move(*next));
    }
    return order;
  }

  /// Its names without its shapes.
  [[nodiscard]] BlockFit named_alone() const {
    return best_.shapes.empty() ? best_.fit : model(best_.named, {}, &best_.fit).fit;
  }

  [[nodiscard]] Groups rivals(std::size_t g) const {
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
    return nearest_rivals(std::move(found));
  }

  /// The best model, but for one of its names.
  [[nodiscard]] Model best_without(std::size_t g) const {
    return model(without_group(best_.named, g), best_.shapes, &best_.fit);
  }

 private:
  [[nodiscard]] Model model(const Groups& named, const Groups& shapes, const BlockFit* near) const {
    Freed freed;
    freed.groups = fitted_;
    freed.groups.insert(freed.groups.end(), named.begin(), named.end());
    std::sort(freed.groups.begin(), freed.groups.end());
    freed.unnamed = shapes;
    Model result{named, shapes, fit_blocks(record_, freed, near), 0};
    result.length = result.fit.squared_error() + name_price_ * static_cast<double>(named.size()) +
                    shape_price_ * static_cast<double>(shapes.size());
    if (!named.empty() && !shapes.empty()) {
      freed.unnamed.clear();
      const double named_alone = fit_blocks(record_, freed, near).squared_error();
      result.length += missed_by_shapes * static_cast<double>(named.size()) *
                       std::max(0.0, named_alone - result.fit.squared_error());
    }
    return result;
  }

  void consider(Model candidate, double handicap = 0) {
    if (candidate.length + handicap < best_.length) best_ = std::move(candidate);
  }

  void search_names() {
    std::vector<Model> level{base_};
    for (std::size_t size = 1; size <= std::min(options_.most_findings, candidates_.size());
         ++size) {
      std::map<Groups, Model> next;
      for (const Model& parent : level) {
        for (const std::size_t g : candidates_) {
          if (contains(parent.named, g)) continue;
          const Groups named = with_group(parent.named, g);
          if (next.contains(named)) continue;
          if (progress_ && size == 1) progress_("trying " + problem_.groups[g].id);
          next.emplace(named, model(named, {}, &parent.fit));
        }
      }
      level.clear();
      for (auto& [named, m] : next) level.push_back(std::move(m));
      std::sort(level.begin(), level.end(),
                [](const Model& a, const Model& b) { return a.length < b.length; });
      const bool better = !level.empty() && level.front().length < best_.length;
      if (better) consider(level.front());
      // Two effects may cancel, so pairs are tried whatever singles say; three hardly do.
      if (size >= 2 && !better) break;
      if (size >= 2 && level.size() > beam) level.erase(level.begin() + beam, level.end());
    }
  }

  /// Shapes beside all of the names, beside all but one of them, and instead of them.
  void search_shapes() {
    if (problem_.unnamed.empty()) return;
    if (progress_) progress_("looking for structure without a name");
    const Model named = best_;
    consider(with_shapes(named));
    if (named.named.empty()) return;
    if (named.named.size() > 1) {
      for (const std::size_t g : named.named) {
        consider(with_shapes(model(without_group(named.named, g), {}, &named.fit)),
                 name_preference);
      }
    }
    consider(with_shapes(base_), name_preference);
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
      if (is_aliased(g) || contains(model.named, g)) continue;
      auto aliased = aliased_in(record_, model.fit, g);
      if (aliased && !(aliased->with.empty() && beside_findings)) {
        aliased_.push_back(std::move(*aliased));
      }
    }
  }

  [[nodiscard]] bool is_aliased(std::size_t g) const {
    return std::any_of(aliased_.begin(), aliased_.end(),
                       [g](const Selection::Aliased& a) { return a.group == g; });
  }

  Groups shape_index_;
  SelectionProblem problem_;
  Record record_;
  std::vector<int> block_ids_;
  const SelectionOptions& options_;
  const SelectionProgress& progress_;
  Groups fitted_;
  Groups candidates_;
  double name_price_ = 0;
  double shape_price_ = 0;
  Model base_;
  Model best_;
  std::vector<Selection::Aliased> aliased_;
};

/// Writes a part's fit into that of all, with standard errors from the curvature of the likelihood.
/// Unlike the jackknife of the fit, they count what a parameter that rests on a bound leaves open
/// in the others.
void merge_fit(const Record& record, const BlockFit& fit, const std::vector<int>& block_ids,
               ModelFit& all) {
  std::vector<std::size_t> parameters;
  MatrixXd jacobian(record.rows(), 0);
  for (const std::size_t g : fit.freed.groups) {
    const MatrixXd slopes = group_slopes(record, g, fit.values);
    jacobian.conservativeResize(Eigen::NoChange, jacobian.cols() + slopes.cols());
    jacobian.rightCols(slopes.cols()) = slopes;
    for (Index k = 0; k < slopes.cols(); ++k) {
      parameters.push_back(record.first_parameter(g) + static_cast<std::size_t>(k));
    }
  }
  const auto shapes = static_cast<Index>(fit.freed.unnamed.size());
  const Index named = jacobian.cols();
  jacobian.conservativeResize(Eigen::NoChange, named + shapes);
  jacobian.rightCols(shapes) = fit.jacobian.rightCols(shapes);

  MatrixXd covariance;
  if (named > 0) covariance = symmetric_pseudo_inverse(jacobian.transpose() * jacobian);
  for (Index k = 0; k < named; ++k) {
    const std::size_t index = parameters[static_cast<std::size_t>(k)];
    all.standard_error[index] =
        record.parameters()[index].scale * std::sqrt(std::max(0.0, covariance(k, k)));
  }
  add_fit(record, fit, block_ids, {}, all);
}

/// A named effect of a part's best model and what it adds to the names before it there.
struct Named {
  PartSearch* search = nullptr;
  SelectedGroup entry;
  VectorXd before, after;  ///< squared errors of the part's blocks

  [[nodiscard]] double gain() const { return before.sum() - after.sum(); }
};

/// The names of all parts, those that gain most first, with their gains in all of the record.
std::vector<Named> named_in(std::list<PartSearch>& parts, double base_error, double rows) {
  std::vector<Named> named;
  for (PartSearch& part : parts) {
    VectorXd before = part.base().fit.block_error;
    for (const auto& [g, fit] : part.in_order()) {
      Named& n = named.emplace_back();
      n.search = &part;
      n.entry.group = g;
      n.before = std::move(before);
      n.after = fit.block_error;
      before = n.after;
    }
  }
  std::stable_sort(named.begin(), named.end(),
                   [](const Named& a, const Named& b) { return a.gain() > b.gain(); });
  double error = base_error;
  for (Named& n : named) {
    const double after = error - n.gain();
    n.entry.rmse_before = std::sqrt(error / rows);
    n.entry.rmse_after = std::sqrt(after / rows);
    n.entry.gain_percent = gain_percent(error, after);
    n.entry.gain_se_percent = gain_se_percent(n.before, n.after, error - n.before.sum());
    error = after;
  }
  return named;
}

/// The same, without those that gain too little to be worth a name beside all others.
std::vector<Named> worth_a_name(std::list<PartSearch>& parts, double base_error, double rows,
                                double least_gain) {
  while (true) {
    std::vector<Named> named = named_in(parts, base_error, rows);
    const auto weakest = std::min_element(
        named.begin(), named.end(),
        [](const Named& a, const Named& b) { return a.entry.gain_percent < b.entry.gain_percent; });
    if (weakest == named.end() || weakest->entry.gain_percent >= least_gain) return named;
    weakest->search->take_back(weakest->entry.group);
  }
}

}  // namespace

Selection select_subset(const SelectionProblem& problem, const std::vector<SelectionPart>& parts,
                        const SelectionOptions& options, const SelectionProgress& progress) {
  Selection result;
  const int blocks = 1 + *std::max_element(problem.block.begin(), problem.block.end());
  result.base = result.extended = result.complete =
      neutral_fit(problem, static_cast<std::size_t>(std::max(blocks, 0)));

  std::list<PartSearch> searches;
  double base_error = 0;
  for (const SelectionPart& part : parts) {
    PartSearch& search = searches.emplace_back(problem, part, options, progress);
    search.run();
    result.rows += static_cast<std::size_t>(search.record().rows());
    result.blocks = std::max(result.blocks, search.record().blocks());
    for (const Selection::Aliased& aliased : search.aliased()) result.aliased.push_back(aliased);
    base_error += search.base().fit.squared_error();
  }
  const auto rows = static_cast<double>(result.rows);
  for (Named& n : worth_a_name(searches, base_error, rows, options.least_gain_percent)) {
    const PartSearch& search = *n.search;
    n.entry.indistinguishable = search.rivals(n.entry.group);
    n.entry.p_value = chi_squared_tail(
        search.best_without(n.entry.group).fit.squared_error() - search.best().fit.squared_error(),
        static_cast<double>(problem.groups[n.entry.group].parameters.size()));
    result.selected.push_back(std::move(n.entry));
  }

  double named_error = 0;
  double complete_error = 0;
  for (const PartSearch& search : searches) {
    const Model& best = search.best();
    const BlockFit named = search.named_alone();
    named_error += named.squared_error();
    complete_error += best.fit.squared_error();
    merge_fit(search.record(), search.base().fit, search.block_ids(), result.base);
    merge_fit(search.record(), named, search.block_ids(), result.extended);
    merge_fit(search.record(), best.fit, search.block_ids(), result.complete);
    for (std::size_t k = 0; k < best.shapes.size(); ++k) {
      result.unnamed.regressors.push_back(search.shape_index()[best.shapes[k]]);
      result.unnamed.coefficients.push_back(best.fit.coefficients[static_cast<Index>(k)]);
    }
  }
  result.base.holdout_rmse = std::sqrt(base_error / rows);
  result.extended.holdout_rmse = std::sqrt(named_error / rows);
  result.complete.holdout_rmse = std::sqrt(complete_error / rows);
  result.student_factor = student_quantile(static_cast<double>(result.blocks) - 1, 0.975);
  name_channels(problem, result.unnamed);
  if (!result.unnamed.regressors.empty()) {
    result.unnamed.share_percent = 100 * std::max(0.0, 1 - complete_error / named_error);
  }
  return result;
}

}  // namespace tethercalc
