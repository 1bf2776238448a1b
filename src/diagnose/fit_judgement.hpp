// What both searches ask of their fits: aliases, rivals, gains with their errors, and what is told
// of the fits in the end.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "diagnose/block_fit.hpp"

namespace tethercalc {

/// Student's degrees of freedom of what is said of the group: one less than it has blocks.
[[nodiscard]] double degrees_of_freedom(const Record& record, std::size_t group);

/// A rival must remove at least this part of what the selected effect does, and leave less to it
/// than this part of what it leaves.
inline constexpr double rival_gain = 0.5;

/// 100·(1 − √(after/before)) for squared errors; 0 where there was none.
[[nodiscard]] double gain_percent(double before, double after);

/// Sum of the differences of block errors and its standard error over blocks.
struct BlockDifference {
  double sum = 0;
  double se = 0;
};
[[nodiscard]] BlockDifference difference(const VectorXd& a, const VectorXd& b);

/// By how much a fit lowers the held-out error of another.
struct Gain {
  double percent = 0;  ///< as `gain_percent`
  double se = 0;       ///< its standard error, by leaving out one block after the other
};
[[nodiscard]] Gain gain_between(const BlockFit& before, const BlockFit& after);

/// Whether the gain is enough to name the group: at least `least_percent`, times the group's
/// factor, and positive beyond chance, two standard errors where there are many blocks. The one
/// rule for flights and power logs, for a step of the search and for what is told.
[[nodiscard]] bool earns_a_name(const Record& record, std::size_t group, const Gain& gain,
                                double least_percent);

/// Whether a size or a place of the group is at the end of its range, where no effect ends but the
/// range. A ratio may end there: of drag that is all linear.
[[nodiscard]] bool is_at_bound(const Record& record, const BlockFit& fit, std::size_t group);

/// Whether all sizes of the group are neutral, so that it changes nothing.
[[nodiscard]] bool is_neutral(const Record& record, const BlockFit& fit, std::size_t group);

/// Whether a fit has a larger held-out error in the rows of a kind than `without` has, beyond
/// chance: by Student's test over the blocks that have such rows, at 5 % over all kinds
/// (Bonferroni). A true cause makes no kind of row worse but by chance.
[[nodiscard]] bool spoils_a_kind(const Record& record, const BlockFit& without,
                                 const BlockFit& with);

/// A name with what it gains beside those told before it, and beside all others.
struct NamedGains {
  std::size_t group = 0;
  Gain in_order;
  Gain beside;
  /// Others were sought beside it, and may cancel most of what it does by itself: of its gain in
  /// order no more is asked than that it is positive.
  bool others_sought_beside = false;
};

/// A name that is not earned, and by which gain.
struct Unearned {
  std::size_t group = 0;
  Gain gain;
};

/// The weakest of the gains that do not earn their name; nothing where all do.
[[nodiscard]] std::optional<Unearned> weakest_unearned(const Record& record,
                                                       std::span<const NamedGains> names,
                                                       double least_percent);

/// By how much a fit predicts the typical block better than another: the mean over blocks of
/// 100·(1 − √(after/before)) as logarithms, each block held against itself. Unlike the gain, it
/// does not hang on the few blocks that have most of the error.
[[nodiscard]] Gain typical_gain_between(const BlockFit& before, const BlockFit& after);

/// A gain of more than two standard errors, as sure as the typical one is where that is surer: few
/// blocks may have most of the error, so that its sum is uncertain though all agree.
[[nodiscard]] Gain surer_gain_between(const BlockFit& before, const BlockFit& after);

/// The group that was freed between the two fits, with its gain.
[[nodiscard]] SelectedGroup freed_between(const BlockFit& before, const BlockFit& after,
                                          std::size_t group);

/// Whether less than a hundredth of what the group's size does to the prediction, in root mean
/// square, is its own beside what is free in `fit`: its variance is then inflated ten-thousandfold,
/// and a log of 10 minutes knows as much of it as 60 ms would without the alias. The groups that
/// mimic it, the nearest first, none where it does nothing at all; nothing where it is no alias.
[[nodiscard]] std::optional<Selection::Aliased> aliased_in(const Record& record,
                                                           const BlockFit& fit, std::size_t group);

/// Slopes of the prediction by the parameters of `group`, its own at their first values and all
/// others at `values`: one column a parameter, over its scale.
[[nodiscard]] MatrixXd slopes_at_start(const Record& record, std::vector<double> values,
                                       std::size_t group);

/// By how much `group` would lower the squared error of `fit` beside what is free in it, if the
/// prediction were linear in its sizes, from their first values on.
[[nodiscard]] double linear_gain(const Record& record, const BlockFit& fit, std::size_t group);

/// Places the parameters of `group` that have places where the group promises most beside what is
/// free in `fit`: where it would lower the squared error most if the prediction were linear in its
/// sizes. A place that no fit moves is sought on from the best of them, in steps of a thirty-second
/// of their distance, as long as that leads to a better one.
void choose_places(Record& record, const BlockFit& fit, std::size_t group);

/// The same for the groups that are always fitted, beside those of them without places.
void place_fitted(Record& record);

/// So many places were to choose from; 1 for most groups.
[[nodiscard]] double chances(const ParameterGroup& group);

/// Whether there is a choice.
[[nodiscard]] bool is_placed(const ParameterGroup& group);

/// A block that holds more of what a record knows cannot be stood for by the others: without it
/// the error would be more than three times as large, and the spread between blocks says nothing of
/// what only one of them shows.
inline constexpr double most_of_one_block = 0.9;

/// Of what the record knows of the group's change of the prediction, as fitted, beside all else
/// that is free in `fit`, the part that the block has which knows most. 0 where the group is at its
/// neutral values.
[[nodiscard]] double largest_block_share(const Record& record, const BlockFit& fit,
                                         std::size_t group);

/// Writes into `all` the standard error of a parameter of the group that stays at its place, which
/// `fit` does not know: moving it by that much costs, beside the fit without the group, what moving
/// the group's size by one standard error does.
void add_place_error(const Record& record, const BlockFit& without, const BlockFit& fit,
                     std::size_t group, ModelFit& all);

/// The fit with more groups freed.
using FitWithGroups = std::function<BlockFit(const Groups& more, FitUse use)>;

/// What `fit` says of each candidate that is neither selected in `found`, nor aliased, nor a rival
/// of one that is selected. Its sizes are those that reach furthest beside `fit` or one of
/// `alternatives`, which explain the record about as well: what one of them allows is not excluded.
[[nodiscard]] std::vector<Selection::Open> judge_open(const Record& record, const BlockFit& fit,
                                                      std::span<const BlockFit> alternatives,
                                                      const Selection& found,
                                                      const FitWithGroups& with);

/// The groups by rising distance.
[[nodiscard]] Groups in_order_of_nearness(std::vector<std::pair<double, std::size_t>> found);

/// A fit of nothing: neutral values.
[[nodiscard]] ModelFit neutral_fit(const Record& record);

/// What the systematic errors add to the variance of each parameter of the fit: the squares of how
/// far least squares would follow them.
[[nodiscard]] VectorXd systematic_variance(const Record& record, const BlockFit& fit);

/// Writes what `fit` freed into `all`. Errors are those of the spread between blocks, with
/// `systematic` (of the jacobian's columns, over their scales; may be empty) added to their
/// squares; where `all` has a larger one already it stays.
void add_fit(const Record& record, const BlockFit& fit, const VectorXd& systematic, ModelFit& all);

/// What the unnamed shapes of `complete` explain that `named`, without them, does not; nothing
/// where that is too little to be told, however sure.
[[nodiscard]] UnnamedStructure unnamed_in(const Record& record, const BlockFit& complete,
                                          const BlockFit& named, const SelectionOptions& options);

/// The frame of a result: what the record and the options say by themselves.
[[nodiscard]] Selection nothing_selected(const Record& record, const SelectionOptions& options);

struct UnnamedTrial {
  std::size_t regressor = 0;  ///< index into SelectionProblem::unnamed
  VectorXd block_error;       ///< held out, with the regressor added and all else refitted
};

/// The regressor that, added to `fit`, leaves the least held-out error, among those whose
/// coefficient beats chance: Student's test with the jackknife's standard error, at
/// `false_alarm_probability` over all regressors (Bonferroni). Those in `taken` and those that the
/// fit already contains are passed over.
[[nodiscard]] std::optional<UnnamedTrial> best_unnamed(const Record& record, const BlockFit& fit,
                                                       const std::vector<std::size_t>& taken,
                                                       double false_alarm_probability);

}  // namespace tethercalc
