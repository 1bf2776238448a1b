// What both searches ask of their fits: aliases, rivals, gains with their errors, and what is told
// of the fits in the end.
#pragma once

#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "diagnose/block_fit.hpp"

namespace tethercalc {

/// A rival must remove at least this part of what the selected effect does.
inline constexpr double rival_gain = 0.5;

/// 100·(1 − √(after/before)) for squared errors; 0 where there was none.
[[nodiscard]] double gain_percent(double before, double after);

/// Standard error of the gain by leaving out one block after the other, from the squared errors of
/// the blocks. `other` is the squared error that does not change.
[[nodiscard]] double gain_se_percent(const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                                     double other = 0);

/// Whether less than a hundredth of what the group's size does to the prediction, in root mean
/// square, is its own beside what is free in `fit`: its variance is then inflated ten-thousandfold,
/// and a log of 10 minutes knows as much of it as 60 ms would without the alias. The groups that
/// mimic it, the nearest first, none where it does nothing at all; nothing where it is no alias.
[[nodiscard]] std::optional<Selection::Aliased> aliased_in(const Record& record,
                                                           const BlockFit& fit, std::size_t group);

/// Slopes of the prediction by the sizes of `group`, its own parameters at their first values and
/// all others at `values`: one column a size, over its scale.
[[nodiscard]] Eigen::MatrixXd size_slopes(const Record& record, std::vector<double> values,
                                          std::size_t group);

/// By how much groups would lower the squared error of a fit if the prediction were linear in
/// their parameters.
class LinearisedGains {
 public:
  LinearisedGains(const Record& record, const BlockFit& fit, const Groups& candidates);
  /// Of these candidates together.
  [[nodiscard]] double of(const Groups& groups) const;

 private:
  std::map<std::size_t, std::vector<Eigen::Index>> columns_;
  Eigen::MatrixXd gram_;   ///< of all slopes beside what is free in the fit
  Eigen::VectorXd along_;  ///< the residual along each of them
};

/// What the fit says of each of `candidates`. `with` gives the fit with one of them freed.
[[nodiscard]] std::vector<Selection::Open> judge_open(
    const Record& record, const BlockFit& fit, const Groups& candidates,
    const std::function<BlockFit(std::size_t)>& with);

/// `open` without what the selected are indistinguishable from.
[[nodiscard]] Groups without_rivals(Groups open, const std::vector<SelectedGroup>& selected);

/// The groups by rising distance.
[[nodiscard]] Groups in_order_of_nearness(std::vector<std::pair<double, std::size_t>> found);

/// The groups that every record shows in the same way as `group`.
[[nodiscard]] Groups twins_of(const SelectionProblem& problem, std::size_t group);

/// A fit of nothing: neutral values.
[[nodiscard]] ModelFit neutral_fit(const SelectionProblem& problem, std::size_t blocks);

/// Writes what `fit` freed into `all`. Errors are those of the spread between blocks, with
/// `systematic` (of the jacobian's columns, over their scales; may be empty) added to their
/// squares; where `all` has a larger one already it stays.
void add_fit(const Record& record, const BlockFit& fit, const Eigen::VectorXd& systematic,
             ModelFit& all);

/// The channels of the regressors found, without repetition.
void name_channels(const SelectionProblem& problem, UnnamedStructure& unnamed);

}  // namespace tethercalc
