// Which of many candidate effects a measured record needs, judged on blocks of it that were not
// fitted. Knows neither flights nor power lines: a model is a function from one parameter vector to
// the readings it predicts.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tethercalc/diagnose/diagnosis.hpp"

namespace tethercalc {

/// A parameter of the model, in the unit the model takes it in.
struct ModelParameter {
  double neutral = 0;  ///< the value that leaves the effect out
  /// Bounds of the search; the neutral value lies within, or below where the effect begins with a
  /// leap, of which slopes know nothing.
  double lower = 0;
  double upper = 0;  ///< not below `lower`
  double scale = 1;  ///< > 0, a change of it that matters: start of the search and step for slopes
  double start = 0;  ///< first value tried once freed; any value within the bounds
  bool shape_only = false;  ///< without effect while the others of its group are neutral (a time
                            ///< constant): takes no part in the test against chance
  /// Values within the bounds. Where there are any, the search starts from the one that promises
  /// most, and counts as many chances against its group.
  std::vector<double> places{};
  /// False where the prediction is no smooth function of it, as of the moment of a step: it stays
  /// at its place.
  bool fitted = true;
  /// Index, over the parameters of all groups, of one whose product with this one enters the
  /// prediction linearly (an area, of which this one is a ratio). The product is tested against
  /// chance and not the ratio, which has no usable spread where the other is near zero.
  std::optional<std::size_t> product_with{};

  /// Whether a fit may move it.
  [[nodiscard]] bool is_free() const { return fitted && lower < upper; }
};

/// Parameters that are freed together.
struct ParameterGroup {
  std::string id{};  ///< for messages
  /// Always free and never reported: drag areas, instrument gains, base effects. Else a candidate,
  /// at its neutral values until the record demands otherwise.
  bool fitted = false;
  /// A candidate that nearly every record holds, such as the wind: others are sought beside it, so
  /// that none takes its place, and it has to earn its own name afterwards. Where the record shows
  /// a group that replaces it, that one takes this part; one that replaces a fitted group only
  /// where it is marked itself.
  bool usual = false;
  std::vector<ModelParameter> parameters{};  ///< in the order that `predict` takes them
  /// That describe it: of two groups that explain alike, the one with fewer is taken.
  std::size_t numbers = 1;
  double least_gain_factor = 1;  ///< as in `Effect`
  /// So many blocks it acts in, where it belongs to one of several records; 0 for all.
  std::size_t blocks = 0;
  /// Index of a group that goes back to neutral when this one is freed, since this one describes
  /// the same thing in more detail; none by default.
  std::optional<std::size_t> replaces{};
  /// Index of a group that every record shows in the same way; this one is then never tried, and
  /// told as indistinguishable where that one is found. None by default.
  std::optional<std::size_t> twin_of{};
};

/// A shape that a record may follow without any effect of the catalogue: a column over the rows of
/// the record, made of one channel.
struct UnnamedRegressor {
  std::string channel{};         ///< such as "roll"
  std::string shape{};           ///< plain words, such as "roll squared, times airspeed"
  std::vector<double> column{};  ///< one element a row; its scale does not matter
  double size = 1;               ///< what a coefficient of 1 stands for, in `unit`
  std::string unit{};            ///< empty where the column has a unit of its own
  double least_gain_factor = 1;  ///< must gain so many times the usual minimum, as in `Effect`
  std::string formula{};         ///< of c times it, as a `Hypothesis` has one; empty: has none
  double formula_unit = 1;       ///< c where the coefficient is 1
  std::string quantity{};        ///< in words, what follows the shape, where that does not say it
};

/// A record and the model that should explain it. Readings of several instruments are stacked: one
/// row a reading.
struct SelectionProblem {
  std::vector<ParameterGroup> groups{};  ///< base and candidates

  /// Writes the predicted reading of every row. The first argument holds the parameters of all
  /// groups in their order. Must be deterministic, and finite within the bounds. It may be called
  /// thousands of times and must not see `measured`: no candidate may be built from what it
  /// explains.
  std::function<void(std::span<const double>, std::span<double>)> predict;

  std::vector<double> measured{};  ///< one a row
  std::vector<double> noise{};  ///< one a row, > 0, in the unit of `measured`: weighs instruments
                                ///< against each other; a common factor changes nothing
  /// Block of each row: 0 … block count − 1, contiguous stretches of time, the same stretch for
  /// every instrument, each several correlation times long. −1 leaves a row out of everything.
  std::vector<int> block{};

  /// Where rows are differences of readings, from which the memory of their noise was taken, they
  /// hardly see what lasts: the root mean square of what each instrument's readings themselves are
  /// off, in any unit. Of no name may it make that clearly larger. Empty: rows are readings.
  std::function<std::vector<double>(std::span<const double>)> left_of_readings{};

  /// Kinds of rows, such as those of turns: one element a row, whether it is one. What mends some
  /// rows by spoiling those of a kind is not what was at work, and gets no name.
  std::vector<std::vector<bool>> kinds{};

  std::vector<UnnamedRegressor> unnamed{};  ///< shapes to look for in what is left

  /// Errors that are the same in all blocks, so that the spread between blocks cannot show them:
  /// each the change of the prediction, one a row, by one standard deviation of the error. They
  /// widen the standard errors of the parameters and decide nothing.
  std::vector<std::vector<double>> systematic{};
};

/// A group that was freed, after the joint fit.
struct SelectedGroup {
  std::size_t group = 0;       ///< index into SelectionProblem::groups
  double rmse_before = 0;      ///< held out, with the groups selected before it
  double rmse_after = 0;       ///< held out, with it as well; everything free refitted together
  double gain_percent = 0;     ///< 100·(1 − after/before)
  double gain_se_percent = 0;  ///< standard error over blocks
  double p_value = 1;          ///< of no gain, two-sided, before correction
  std::vector<std::size_t> indistinguishable{};  ///< groups that explain as well in its place
};

/// Values of all parameters and their covariance over blocks.
struct ModelFit {
  std::vector<double> values{};          ///< all groups in their order; not freed ones are neutral
  std::vector<double> standard_error{};  ///< 0 where not freed
  /// Covariance of a parameter with the one of `ModelParameter::product_with`; 0 where there is
  /// none, and where one of them is not freed.
  std::vector<double> product_covariance{};
  /// Values with block b left out: `without_block[b]`.
  std::vector<std::vector<double>> without_block{};
  double holdout_rmse = 0;  ///< in units of `noise`, every block predicted by the fit without it
  std::vector<double> holdout_residual{};  ///< measured − predicted, one a row, 0 in rows left out
};

/// A size of a group that is not freed, as one step of least squares beside all that is free would
/// have it, bounds or not.
struct SizeEstimate {
  std::size_t parameter = 0;  ///< of all groups
  double value = 0;
  double standard_error = 0;  ///< from the spread over blocks
  /// Of a parameter with a `product_with`, which the same step moves: that one over its value in
  /// the fit, its error, and the covariance of both. The size is a ratio to it, known only together
  /// with it.
  double base = 1;
  double base_error = 0;
  double covariance = 0;
  /// Of what the record knows of it, the part of the block that knows most.
  double largest_block_share = 0;
};

/// What is left and no candidate explains.
struct UnnamedStructure {
  std::vector<std::size_t> regressors{};  ///< into SelectionProblem::unnamed, strongest first
  std::vector<double> coefficients{};     ///< of their columns, in the unit of `measured`
  std::vector<std::string> channels{};    ///< theirs, without repetition
  double share_percent = 0;               ///< of the held-out squared error of the extended model
};

/// The outcome of a search.
struct Selection {
  std::size_t rows = 0;    ///< used
  std::size_t blocks = 0;  ///< with rows in them
  /// Half width of a 95 % interval over its standard error, for the parameters of each group.
  std::vector<double> student_factor{};
  ModelFit base;      ///< only the fitted groups free
  ModelFit extended;  ///< with the selected groups
  /// The best estimates: with the selected groups and, where it is large (a quarter of the squared
  /// error) and makes the estimates more precise, with the unnamed structure; else the same as
  /// `extended`.
  ModelFit complete;
  std::vector<SelectedGroup> selected{};  ///< in the order they were found
  /// A candidate that is neither selected nor indistinguishable from one that is, beside those.
  struct Open {
    std::size_t group = 0;
    std::vector<SizeEstimate> sizes{};
    /// Of all sizes being neutral, corrected for the number of sizes and of such candidates.
    double p_value = 1;
    double gain_percent = 0;     ///< of freeing it
    double gain_se_percent = 0;  ///< standard error over blocks
    bool suspected = false;      ///< its size or its gain is hardly chance, though not sure enough
    ModelFit freed{};            ///< with it freed
    /// Of what the record knows of it as freed, the part of the block that knows most.
    double largest_block_share = 0;
    bool at_bound = false;     ///< as freed, see `is_at_bound`
    bool spoils_kind = false;  ///< by being freed, see `spoils_a_kind`
  };
  std::vector<Open> open{};       ///< in their order
  double least_gain_percent = 0;  ///< that was asked of a name
  /// Groups that chance cannot explain by the record's noise, and that gain too unevenly over its
  /// blocks to be named: they are suspected.
  std::vector<std::size_t> doubted{};
  /// Candidates whose change of the prediction is a combination of what is already free.
  struct Aliased {
    std::size_t group = 0;            ///< the candidate
    std::vector<std::size_t> with{};  ///< groups that mimic it, the nearest first
  };
  std::vector<Aliased> aliased{};  ///< never tried
  UnnamedStructure unnamed;        ///< beside the selected groups
};

/// Forward steps with backward checks.
///
/// Each step frees the candidate with the largest drop of held-out error, provided the drop beats
/// chance over blocks and is worth a name; all free parameters are then refitted together and what
/// no longer earns its place goes back to neutral. Standard errors and held-out errors come from
/// the same fits, each with one block left out (delete-a-block jackknife, Künsch 1989), so that
/// correlation within a block needs no model. Outlying rows are down-weighted (Huber 1964).
///
/// All of this beside the usual groups, which are named afterwards where they earn it.
///
/// Structure left over is sought among `unnamed`; an effect that an unnamed regressor explains
/// significantly better, or makes superfluous, is taken back: a name is never forced on it.
///
/// Throws std::invalid_argument where sizes disagree, a noise is not positive, a bound is reversed,
/// or fewer than `fewest_blocks` blocks hold rows.
[[nodiscard]] Selection select_effects(const SelectionProblem& problem,
                                       const SelectionOptions& options = {},
                                       const SelectionProgress& progress = {});

/// Like `select_effects`, for rows whose noise is independent and of size 1, so that held-out
/// squared errors can be compared by likelihood.
///
/// Every candidate is fitted; of all pairs, and of the best few models with one more, those that
/// promise most where the model is linear: a greedy first step can be wrong where two effects
/// cancel or mimic a third together. Of all models the one with the least description length wins:
/// held-out squared error, plus for each effect 2·ln(candidates/α), plus for each unnamed shape
/// 2·ln(shapes/α), the price of having picked one out of so many (Rissanen 1978; with α the chance
/// of a false alarm, since χ² exceeds 2·ln(1/p) with probability below p). Shapes without a name
/// cost more than names, so a name wins where both explain equally well, and a shape wins where it
/// takes two wrong names to mimic it.
///
/// `SelectionOptions::false_alarm_probability` is α, for named and for unnamed ones each. Names
/// that gain less than `least_gain_percent` of the record's held-out error, in their order or
/// beside all others, are taken back. Throws as `select_effects` does.
[[nodiscard]] Selection select_subset(const SelectionProblem& problem,
                                      const SelectionOptions& options,
                                      const SelectionProgress& progress);

}  // namespace tethercalc
