#include "diagnose/selection.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "diagnose/fit_judgement.hpp"
#include "identify/statistics.hpp"
#include "model/constants.hpp"

namespace tethercalc {
namespace {

/// An unnamed regressor outdoes a name only by at least this part of what the name removes: less is
/// within what the idealised shape of any named effect misses of nature.
constexpr double outdone_gain = 0.1;
/// An effect must remove so many times the usual gain to be named beside unnamed structure: what
/// the unnamed shape misses of the unknown must not be given a name.
constexpr double gain_beside_unnamed = 2.5;
/// Unnamed structure enters the estimates of the parameters only where it is at least this part of
/// the squared error. A small one disturbs them less without it than its chosen shape does with it.
constexpr double structure_that_disturbs = 0.25;

/// Of the fitted parameters, larger is better: −Σ log of the standard errors of those that every
/// fit frees.
double precision(const BlockFit& fit) {
  double sum = 0;
  for (std::size_t k = 0; k < fit.active.size(); ++k) {
    const auto column = static_cast<Index>(k);
    sum -= std::log(jackknife_covariance(fit, {column})(0, 0) + 1e-300) / 2;
  }
  return sum;
}

class Search {
 public:
  Search(const SelectionProblem& problem, const SelectionOptions& options,
         const SelectionProgress& progress)
      : record_(problem), options_(options), progress_(progress) {
    degrees_ = static_cast<double>(record_.blocks() - 1);
  }

  Selection run() {
    Selection result = nothing_selected(record_, options_);
    student_factor_ = student_quantile(degrees_, 0.975);
    tell("fitting the base model");
    place_fitted(record_);
    const BlockFit base = fit(selected_, nullptr);
    current_ = base;
    place_candidates();
    for (const std::size_t g : candidates()) {
      if (auto aliased = aliased_in(record_, base, g)) {
        aliased_.insert(g);
        result.aliased.push_back(std::move(*aliased));
      }
    }

    find_usual(base.freed.groups);

    // Every round either ends or leaves a set that no step goes to again.
    do {
      search_beside_usual();
      name_usual();
      put_one_for_two();
      put_in_order(base);
    } while (drop_unearned(base));
    place_candidates();
    sum_up(result);
    return result;
  }

 private:
  /// A fit with one more group and what speaks for it.
  struct Trial {
    std::size_t group = 0;
    BlockFit fit;
    double p_value = 1;
    bool worth_a_name = false;
  };

  void tell(const std::string& what) const {
    if (progress_) progress_(what);
  }
  [[nodiscard]] const ParameterGroup& group(std::size_t g) const {
    return record_.problem().groups[g];
  }

  /// Whether one of `selected` describes in more detail what the group does.
  [[nodiscard]] bool is_replaced(std::size_t g, const Groups& selected) const {
    return std::any_of(selected.begin(), selected.end(),
                       [&](std::size_t by) { return group(by).replaces == g; });
  }

  /// What is always free and `selected`, without what `replacing` describes in more detail.
  [[nodiscard]] Groups free_with(const Groups& selected, const Groups& replacing) const {
    Groups free;
    for (std::size_t g = 0; g < record_.problem().groups.size(); ++g) {
      const bool wanted = group(g).fitted || contains(selected, g) || contains(beside_, g);
      if (wanted && !is_replaced(g, replacing) && !is_replaced(g, beside_)) free.push_back(g);
    }
    return free;
  }

  /// The fit of what is always free, `selected`, and `shapes` without a name.
  [[nodiscard]] BlockFit fit(const Groups& selected, const Groups& shapes, const BlockFit* near,
                             FitUse use = FitUse::search) const {
    return fit_blocks(record_, {free_with(selected, selected), shapes}, near, use);
  }
  /// The same with the shapes that were found.
  [[nodiscard]] BlockFit fit(const Groups& selected, const BlockFit* near) const {
    return fit(selected, unnamed_, near);
  }

  /// The fit of `some` of the names. What any name replaces of the base is not there beside the
  /// others either, which it may resemble: of a wind along the nose a pitch offset.
  [[nodiscard]] BlockFit fit_some(const Groups& some, const BlockFit* near,
                                  FitUse use = FitUse::search) const {
    return fit_blocks(record_, {free_with(some, selected_), {}}, near, use);
  }
  /// Whether one of the names replaces what is always free.
  [[nodiscard]] bool base_changes() const {
    return std::ranges::any_of(selected_, [this](std::size_t g) {
      return group(g).replaces && group(*group(g).replaces).fitted;
    });
  }

  /// Of the hypothesis that the group is neutral. A group that replaces another has no neutral
  /// value to compare with; it is tested in the model that holds both, where neutral leaves the
  /// other alone (the encompassing test of non-nested models: Davidson and MacKinnon, Econometrica
  /// 49, 1981).
  [[nodiscard]] double p_value(std::size_t g, const BlockFit& without, const BlockFit& with) const {
    const std::optional<std::size_t> replaced = group(g).replaces;
    if (!replaced || !contains(without.freed.groups, *replaced)) {
      return wald_p_value(g, without, with);
    }
    const Freed both{with_group(with.freed.groups, *replaced), with.freed.unnamed};
    return wald_p_value(g, without, fit_blocks(record_, both, &with));
  }

  /// Wald's statistic with the jackknife covariance, referred to Hotelling's distribution for as
  /// many blocks, in the quantities that enter the prediction linearly. Where all parameters rest
  /// on a bound, and so do not vary between blocks, the held-out errors of the blocks are compared
  /// by Student's test instead.
  [[nodiscard]] double wald_p_value(std::size_t g, const BlockFit& without,
                                    const BlockFit& with) const {
    const auto column_of = [&with](std::size_t parameter) {
      return std::find(with.active.begin(), with.active.end(), parameter) - with.active.begin();
    };
    const auto active = static_cast<Index>(with.active.size());
    std::vector<double> distance;
    std::vector<VectorXd> without_block;
    for (std::size_t k = 0; k < group(g).parameters.size(); ++k) {
      const std::size_t index = record_.first_parameter(g) + k;
      const ModelParameter& p = record_.parameters()[index];
      const Index column = column_of(index);
      if (p.shape_only || column == active) continue;
      distance.push_back((with.values[index] - p.neutral) / p.scale);
      without_block.push_back(with.left_out.row(column).transpose());
      if (!p.product_with) continue;
      const double other = with.values[*p.product_with];
      const Index other_column = column_of(*p.product_with);
      without_block.back() *= other;
      if (other_column != active) {
        without_block.back() += distance.back() * record_.parameters()[*p.product_with].scale *
                                with.left_out.row(other_column).transpose();
      }
      distance.back() *= other;
    }
    const double degrees = degrees_of_freedom(record_, g);
    if (distance.empty()) {
      const BlockDifference gain = difference(without.block_error, with.block_error);
      return gain.sum > 0 ? 2 * student_tail(gain.sum / gain.se, degrees) : 1;
    }
    const auto count = static_cast<Index>(distance.size());
    MatrixXd spread(count, static_cast<Index>(record_.blocks()));
    for (Index k = 0; k < count; ++k) spread.row(k) = without_block[static_cast<std::size_t>(k)];
    const VectorXd offset = VectorXd::Map(distance.data(), count);
    const MatrixXd covariance = jackknife_covariance(std::move(spread));
    const double t2 = offset.dot(pseudo_solution(covariance, offset));
    const auto numerator = static_cast<double>(count);
    const double denominator = degrees + 1 - numerator;
    if (denominator < 1) return 1;  // so few blocks cannot tell so many sizes from chance
    return fisher_tail(t2 / numerator * denominator / degrees, numerator, denominator);
  }

  /// Of a gain of nothing, by Student's test.
  [[nodiscard]] double chance_of(const Gain& gain, std::size_t g) const {
    return gain.percent > 0
               ? 2 * student_tail(gain.percent / gain.se, degrees_of_freedom(record_, g))
               : 1;
  }

  /// Whether the group lowers the held-out error of the named part alone, too. A name that helps
  /// only beside an unnamed shape mends the shape, not the model.
  [[nodiscard]] bool earns_without_shapes(std::size_t g) const {
    if (unnamed_.empty()) return true;
    const BlockFit without = fit(selected_, {}, &current_);
    const BlockFit with = fit(selected_with(g), {}, &without);
    return gain_between(without, with).percent >= options_.least_gain_percent;
  }

  [[nodiscard]] Trial judge(std::size_t g, const BlockFit& without, BlockFit with) const {
    const std::size_t tested = candidates().size() + (contains(selected_, g) ? 1 : 0);
    Trial trial;
    trial.group = g;
    const Gain gained = gain_between(without, with);
    // Two tests, of what it is and of what it does to blocks that it has not seen: where one block
    // holds most of what the record knows of a size, all blocks may still gain alike.
    trial.p_value = std::min(1.0, 2 * std::min(p_value(g, without, with), chance_of(gained, g)));
    trial.worth_a_name =
        earns_a_name(record_, g, surer_gain_between(without, with),
                     options_.least_gain_percent *
                         (without.freed.unnamed.empty() ? 1 : gain_beside_unnamed)) &&
        trial.p_value * static_cast<double>(tested) * chances(group(g)) <=
            options_.false_alarm_probability &&
        largest_block_share(record_, with, g) <= most_of_one_block &&
        !is_at_bound(record_, with, g) && !spoils_a_kind(record_, without, with);
    trial.fit = std::move(with);
    return trial;
  }

  /// Whether the group may be freed beside the selected ones.
  [[nodiscard]] bool is_open(std::size_t g) const {
    return !group(g).fitted && !contains(selected_, g) && !contains(beside_, g) &&
           !aliased_.contains(g);
  }

  [[nodiscard]] Groups candidates() const {
    Groups result;
    for (std::size_t g = 0; g < record_.problem().groups.size(); ++g) {
      if (is_open(g) && !is_replaced(g, selected_) && !is_replaced(g, beside_) &&
          !left_.contains(selected_with(g))) {
        result.push_back(g);
      }
    }
    return result;
  }

  /// Of `among`, the one with the least held-out error; among those within one standard error of it
  /// the one with the fewest parameters, or that another describes in more detail (Hastie,
  /// Tibshirani, Friedman, The Elements of Statistical Learning, 2nd ed., section 7.10).
  [[nodiscard]] std::optional<Trial> best_step(const Groups& among) const {
    std::vector<Trial> worthy;
    for (const std::size_t g : among) {
      tell("trying " + group(g).id);
      Trial trial = judge(g, current_, fit(selected_with(g), &current_));
      if (trial.worth_a_name && earns_without_shapes(g)) worthy.push_back(std::move(trial));
    }
    if (worthy.empty()) return std::nullopt;
    const auto best = std::min_element(
        worthy.begin(), worthy.end(),
        [](const auto& a, const auto& b) { return a.fit.squared_error() < b.fit.squared_error(); });
    const Trial* chosen = &*best;
    for (const Trial& trial : worthy) {
      const BlockDifference excess = difference(trial.fit.block_error, best->fit.block_error);
      const std::size_t count = group(trial.group).numbers;
      const std::size_t chosen_count = group(chosen->group).numbers;
      const bool coarser = group(chosen->group).replaces == trial.group;
      const bool better = trial.fit.squared_error() < chosen->fit.squared_error() &&
                          group(trial.group).replaces != chosen->group;
      const bool simpler = count < chosen_count || coarser || (count == chosen_count && better);
      if (simpler && excess.sum <= excess.se) chosen = &trial;
    }
    return *chosen;
  }

  [[nodiscard]] static Groups sorted(Groups groups) {
    std::sort(groups.begin(), groups.end());
    return groups;
  }
  [[nodiscard]] Groups selected_with(std::size_t g) const { return with_group(selected_, g); }
  [[nodiscard]] Groups selected_without(std::size_t g) const { return without_group(selected_, g); }

  /// Where each candidate promises most beside what has been found.
  void place_candidates() {
    for (const std::size_t g : candidates()) {
      if (is_placed(group(g))) choose_places(record_, current_, g);
    }
  }

  /// A step that makes others superfluous, so that less is explained in the end, is taken back.
  void step_forward() {
    while (selected_.size() < options_.most_findings) {
      place_candidates();
      std::optional<Trial> step = best_step(candidates());
      if (!step) return;
      const Groups before = selected_;
      const BlockFit fit_before = current_;
      selected_.push_back(step->group);
      current_ = std::move(step->fit);
      tell("found " + group(step->group).id);
      if (!unnamed_.empty()) continue;
      const Groups with = selected_;
      drop_superfluous();
      if (current_.squared_error() < fit_before.squared_error()) continue;
      tell("going back from " + group(step->group).id);
      left_.insert(sorted(without_usual(with)));
      selected_ = before;
      current_ = fit_before;
    }
  }

  /// `selected`, with those that have places where they promise most beside the others.
  [[nodiscard]] BlockFit placed_fit(const Groups& selected) {
    for (const std::size_t g : selected) {
      if (is_placed(group(g))) choose_places(record_, fit(without_group(selected, g), nullptr), g);
    }
    return fit(selected, nullptr);
  }

  /// Puts other candidates in the place of names with a place as long as that lowers the held-out
  /// error: a wave may have been the best single name for what is a step beside another.
  void exchange() {
    if (std::none_of(selected_.begin(), selected_.end(),
                     [&](auto g) { return is_placed(group(g)); })) {
      return;
    }
    for (bool exchanged = true; exchanged;) {
      exchanged = false;
      for (const std::size_t out : Groups(selected_)) {
        if (!is_placed(group(out))) continue;
        for (const std::size_t in : candidates()) {
          if (exchanged) break;
          const Groups trial = with_group(selected_without(out), in);
          if (left_.contains(trial)) continue;
          tell("trying " + group(in).id + " instead of " + group(out).id);
          BlockFit instead = placed_fit(trial);
          const BlockDifference better = difference(current_.block_error, instead.block_error);
          if (better.sum <= 2 * better.se) continue;
          selected_ = trial;
          current_ = std::move(instead);
          exchanged = true;
        }
      }
    }
    keep_places();
    drop_superfluous();
  }

  /// Fits to come start at the places that the names have, wherever the last trial had them.
  void keep_places() {
    for (const std::size_t g : selected_) {
      for (std::size_t k = 0; k < group(g).parameters.size(); ++k) {
        const std::size_t index = record_.first_parameter(g) + k;
        if (!group(g).parameters[k].places.empty()) record_.start_at(index, current_.values[index]);
      }
    }
  }

  /// Takes back what the other names make superfluous, the weakest first.
  void drop_superfluous() {
    while (!selected_.empty()) {
      std::optional<std::size_t> weakest;
      double weakest_error = infinity;
      BlockFit rest_fit;
      for (const std::size_t g : selected_) {
        BlockFit without = fit(selected_without(g), &current_);
        const bool earns = judge(g, without, current_).worth_a_name;
        if (!earns && without.squared_error() < weakest_error) {
          weakest = g;
          weakest_error = without.squared_error();
          rest_fit = std::move(without);
        }
      }
      if (!weakest) return;
      tell("taking back " + group(*weakest).id);
      leave(*weakest);
      current_ = std::move(rest_fit);
    }
  }

  /// Takes back a name if an unnamed regressor in its place explains significantly more and, once
  /// that is in, the name has nothing left to explain. Both are needed: an unnamed shape may
  /// outweigh a weak effect that is there beside it, and a flexible shape may mimic a name without
  /// doing better.
  bool drop_outdone() {
    for (const std::size_t g : selected_) {
      const BlockFit without = fit(selected_without(g), &current_);
      const std::optional<UnnamedTrial> best =
          best_unnamed(record_, without, unnamed_, options_.false_alarm_probability);
      if (!best) continue;
      const BlockDifference better = difference(current_.block_error, best->block_error);
      const double earned = without.squared_error() - current_.squared_error();
      // What was looked for at many places fits much of what is there: the better shape of it
      // counts.
      const bool outdone = is_placed(group(g)) ? better.sum > 0
                                               : better.sum > student_factor_ * better.se &&
                                                     better.sum > outdone_gain * earned;
      if (!outdone) continue;

      Groups shapes = unnamed_;
      shapes.push_back(best->regressor);
      BlockFit beside = fit(selected_, shapes, &current_);
      const BlockFit instead = fit(selected_without(g), shapes, &beside);
      if (judge(g, instead, std::move(beside)).worth_a_name) continue;
      tell("taking back " + group(g).id + ": " + record_.problem().unnamed[best->regressor].shape +
           " explains more");
      leave(g);
      current_ = fit(selected_, &current_);
      return true;
    }
    return false;
  }

  /// Takes the group back; no step returns to the set that is left, and a usual group that is left
  /// has no name.
  void leave(std::size_t g) {
    left_.insert(sorted(without_usual(selected_)));
    if (contains(usual_, g)) unearned_usual_.push_back(g);
    selected_ = selected_without(g);
  }

  /// What is there in nearly every record, or describes in more detail what is.
  void find_usual(const Groups& fitted) {
    for (std::size_t g = 0; g < record_.problem().groups.size(); ++g) {
      const auto& coarser = group(g).replaces;
      const bool counts = coarser
                              ? group(*coarser).usual && (group(g).usual || !group(*coarser).fitted)
                              : group(g).usual && !is_replaced(g, fitted);
      if (counts && is_open(g)) usual_.push_back(g);
    }
  }

  [[nodiscard]] Groups without_usual(Groups groups) const {
    std::erase_if(groups, [this](std::size_t g) { return contains(usual_, g); });
    return groups;
  }

  /// Names and unnamed shapes beside all usual groups, which have no name meanwhile.
  void search_beside_usual() {
    selected_ = without_usual(std::move(selected_));
    beside_ = usual_;
    std::erase_if(beside_, [this](std::size_t g) { return is_replaced(g, usual_); });
    unnamed_.clear();
    current_ = fit(selected_, nullptr);
    do {
      step_forward();
      exchange();
    } while (drop_outdone());
    find_unnamed();
    if (!unnamed_.empty()) step_forward();  // what the unknown had hidden
  }

  /// Names the usual groups that earn it. No unnamed shape takes that from them: they are known to
  /// be there.
  void name_usual() {
    beside_.clear();
    const Groups shapes = std::exchange(unnamed_, {});
    current_ = fit(selected_, nullptr);
    while (selected_.size() < options_.most_findings) {
      Groups open = candidates();
      std::erase_if(open, [&](std::size_t g) {
        return !contains(usual_, g) || contains(unearned_usual_, g);
      });
      std::optional<Trial> step = best_step(open);
      if (!step) break;
      selected_.push_back(step->group);
      current_ = std::move(step->fit);
    }
    unnamed_ = shapes;
    current_ = fit(selected_, &current_);
  }

  /// Puts one candidate in the place of two names where it explains at least as much as both: found
  /// one after the other they may only mimic it together, as a wind and an asymmetry do a pull.
  void put_one_for_two() {
    while (std::optional<OneForTwo> found = best_one_for_two()) {
      const std::size_t by = found->by.group;
      tell("found " + group(by).id + " instead of two");
      Groups others = found->two;
      for (const std::size_t g : found->two) {
        for (const std::size_t c : rivals(g, fit(selected_without(g), &current_))) {
          if (c != by && !contains(others, c)) others.push_back(c);
        }
      }
      for (const std::size_t g : found->two) leave(g);
      selected_.push_back(by);
      current_ = std::move(found->by.fit);
      instead_of_.insert_or_assign(by, InsteadOf{std::move(found->two), std::move(others)});
    }
  }

  struct OneForTwo {
    Groups two;
    Trial by;
  };

  [[nodiscard]] std::optional<OneForTwo> best_one_for_two() const {
    std::optional<OneForTwo> best;
    const auto consider = [&](std::size_t a, std::size_t b) {
      const Groups others = without_group(selected_without(a), b);
      const BlockFit rest = fit(others, &current_);
      const double earned = rest.squared_error() - current_.squared_error();
      for (const std::size_t c : candidates()) {
        if (is_placed(group(c)) || linear_gain(record_, rest, c) < rival_gain * earned) continue;
        Trial trial = judge(c, rest, fit(with_group(others, c), &rest));
        const BlockFit& least = best ? best->by.fit : current_;
        if (!trial.worth_a_name || trial.fit.squared_error() > least.squared_error()) continue;
        best = OneForTwo{{a, b}, std::move(trial)};
      }
    };
    for (const std::size_t a : selected_) {
      for (const std::size_t b : selected_) {
        if (a < b && !is_placed(group(a)) && !is_placed(group(b))) consider(a, b);
      }
    }
    return best;
  }

  /// The names by what each adds to those before it. None stays that adds nothing there.
  void put_in_order(const BlockFit& base) {
    Groups order;
    BlockFit before = base;
    while (order.size() < selected_.size()) {
      std::optional<std::size_t> next;
      BlockFit best;
      for (const std::size_t g : selected_) {
        if (contains(order, g)) continue;
        Groups more = order;
        more.push_back(g);
        BlockFit after = fit_some(more, &current_);
        if (next && after.squared_error() >= best.squared_error()) continue;
        next = g;
        best = std::move(after);
      }
      if (best.squared_error() >= before.squared_error()) {
        leave(*next);
        current_ = fit(selected_, &current_);
        drop_superfluous();
        return put_in_order(base);
      }
      order.push_back(*next);
      before = std::move(best);
    }
    selected_ = std::move(order);
  }

  /// The last name whose size the others have moved to nothing or to the end of its range; else the
  /// weakest one whose gain, as it will be told or beside all the other names, does not earn one.
  [[nodiscard]] std::optional<std::size_t> unearned(const BlockFit& base) const {
    const BlockFit all = fit(selected_, {}, &current_);
    for (auto g = selected_.rbegin(); g != selected_.rend(); ++g) {
      if (is_at_bound(record_, all, *g) || is_neutral(record_, all, *g)) return *g;
    }
    BlockFit before = base;
    Groups so_far;
    std::vector<NamedGains> names;
    for (const std::size_t g : selected_) {
      so_far.push_back(g);
      BlockFit after = fit_some(so_far, &current_);
      const BlockFit without = fit(selected_without(g), {}, &current_);
      names.push_back({g, surer_gain_between(before, after), surer_gain_between(without, all),
                       base_changes() || contains(usual_, g)});
      before = std::move(after);
    }
    const auto weakest = weakest_unearned(record_, names, options_.least_gain_percent);
    return weakest ? std::optional(weakest->group) : std::nullopt;
  }

  /// Takes back what is not earned. True where that was a name that others were judged beside, so
  /// that the search has to go on.
  bool drop_unearned(const BlockFit& base) {
    while (const std::optional<std::size_t> g = unearned(base)) {
      tell("taking back " + group(*g).id);
      leave(*g);
      if (!contains(usual_, *g)) return true;
      current_ = fit(selected_, &current_);
    }
    return false;
  }

  /// Looks beside all effects that are certain, those too small for a name included: what a known
  /// effect explains is no unknown one.
  void find_unnamed() {
    tell("looking for structure without a name");
    Search certain = *this;
    certain.options_.least_gain_percent = 0;
    certain.step_forward();
    certain.options_ = options_;
    certain.add_unnamed();
    unnamed_ = certain.unnamed_;
    current_ = fit(selected_, &current_);
  }

  void add_unnamed() {
    constexpr std::size_t most_regressors = 4;  // more would describe noise nobody reads
    while (unnamed_.size() < most_regressors) {
      const std::optional<UnnamedTrial> best =
          best_unnamed(record_, current_, unnamed_, options_.false_alarm_probability);
      if (!best) return;
      const BlockDifference drop = difference(current_.block_error, best->block_error);
      const double least_gain = options_.least_unexplained_percent *
                                record_.problem().unnamed[best->regressor].least_gain_factor;
      if (drop.sum <= student_factor_ * drop.se ||
          gain_percent(current_.squared_error(), best->block_error.sum()) < least_gain) {
        return;
      }
      unnamed_.push_back(best->regressor);
      current_ = fit(selected_, &current_);
    }
  }

  void sum_up(Selection& result) {
    BlockFit before = fit({}, {}, nullptr, FitUse::report);
    result.base = model_fit(before);
    current_ = fit(selected_, unnamed_, &current_, FitUse::report);
    Groups so_far;
    for (const std::size_t g : selected_) {
      // Gains are those of the named part alone, one finding after the other.
      so_far.push_back(g);
      BlockFit after = fit_some(so_far, &current_, FitUse::report);
      SelectedGroup& entry = result.selected.emplace_back(freed_between(before, after, g));
      const BlockFit without = fit(selected_without(g), &current_);
      entry.p_value = p_value(g, without, current_);
      entry.indistinguishable = rivals(g, without);
      before = std::move(after);
    }
    result.extended = model_fit(before);
    const double share = 1 - current_.squared_error() / before.squared_error();
    const bool disturbed =
        share >= structure_that_disturbs && precision(current_) > precision(before);
    const BlockFit& complete = disturbed ? current_ : before;
    result.complete = model_fit(complete);
    for (const std::size_t g : selected_) {
      if (!is_placed(group(g))) continue;
      const BlockFit without = fit(selected_without(g), complete.freed.unnamed, &complete);
      add_place_error(record_, without, complete, g, result.complete);
    }
    result.open = judge_open(record_, complete, {}, result, [&](const Groups& more, FitUse use) {
      Groups groups = selected_;
      groups.insert(groups.end(), more.begin(), more.end());
      return fit(groups, complete.freed.unnamed, &complete, use);
    });
    result.unnamed = unnamed_in(record_, current_, before, options_);
  }

  [[nodiscard]] Groups rivals(std::size_t g, const BlockFit& without) const {
    std::vector<std::pair<double, std::size_t>> found;
    for (std::size_t c = 0; c < record_.problem().groups.size(); ++c) {
      if (!is_open(c) || group(c).replaces == g) continue;
      const BlockFit rival = fit(with_group(selected_without(g), c), &current_);
      const bool only_placed = is_placed(group(c)) && !is_placed(group(g));
      if (explains_as_well(rival, g, without, only_placed)) {
        found.emplace_back(rival.squared_error(), c);
      }
    }
    Groups told = in_order_of_nearness(std::move(found));
    const auto instead = instead_of_.find(g);
    if (instead == instead_of_.end()) return told;
    Groups both = selected_without(g);
    for (const std::size_t c : instead->second.two) both.push_back(c);
    if (!explains_as_well(fit(sorted(both), &current_), g, without, false)) return told;
    for (const std::size_t c : instead->second.others) {
      if (is_open(c) && !contains(told, c)) told.push_back(c);
    }
    return told;
  }

  /// Whether `rival`, in which others stand in the place of the name, leaves open which of them is
  /// at work.
  [[nodiscard]] bool explains_as_well(const BlockFit& rival, std::size_t g, const BlockFit& without,
                                      bool only_placed) const {
    const double earned = without.squared_error() - current_.squared_error();
    const BlockDifference excess = difference(rival.block_error, current_.block_error);
    // A step at the very beginning is all but steady: what is looked for at many places puts
    // others in doubt only where it does clearly better.
    const double allowed = only_placed ? -student_factor_ : student_factor_;
    // Where few blocks have most of the error, its sum is uncertain though all blocks agree.
    const Gain of_found = typical_gain_between(rival, current_);
    return without.squared_error() - rival.squared_error() >= rival_gain * earned &&
           rival.squared_error() * (1 - rival_gain) < current_.squared_error() &&
           excess.sum <= allowed * excess.se &&
           !earns_a_name(record_, g, of_found, options_.least_gain_percent);
  }

  [[nodiscard]] ModelFit model_fit(const BlockFit& fit) const {
    ModelFit result = neutral_fit(record_);
    add_fit(record_, fit, systematic_variance(record_, fit), result);
    result.holdout_rmse = fit.rmse();
    result.holdout_residual.assign(record_.problem().measured.size(), 0);
    for (Index i = 0; i < record_.rows(); ++i) {
      const std::size_t row = record_.row_in_problem(i);
      result.holdout_residual[row] = fit.holdout_residual[i] * record_.problem().noise[row];
    }
    return result;
  }

  Record record_;
  SelectionOptions options_;
  const SelectionProgress& progress_;
  double degrees_ = 0;
  double student_factor_ = 0;
  Groups selected_;
  Groups unnamed_;
  Groups usual_;
  Groups beside_;  ///< usual groups, while others are sought beside them
  std::set<std::size_t> aliased_;
  Groups unearned_usual_;  ///< that were taken back
  /// What a name stands for.
  struct InsteadOf {
    Groups two;     ///< names
    Groups others;  ///< these, and what may be at work in the place of one of them
  };
  std::map<std::size_t, InsteadOf> instead_of_;
  std::set<Groups> left_;  ///< sets of which a name was taken back, so that the search ends
  BlockFit current_;
};

}  // namespace

Selection select_effects(const SelectionProblem& problem, const SelectionOptions& options,
                         const SelectionProgress& progress) {
  return Search(problem, options, progress).run();
}

}  // namespace tethercalc
