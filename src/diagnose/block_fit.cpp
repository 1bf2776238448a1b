#include "diagnose/block_fit.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "identify/statistics.hpp"
#include "model/constants.hpp"

namespace tethercalc {
namespace {

/// Huber's bound in robust standard deviations. At 3 it costs 0.5 % of efficiency where the noise
/// is normal, and hardly touches the honest residuals of a model that still lacks an effect.
constexpr double huber_bound = 3.0;
/// A slope is the sum of weight·(prediction there − prediction here) over neighbours so many scales
/// away; a scale is a change that matters, so the model is smooth over less.
struct Neighbour {
  double scales;
  double weight;
};
using Neighbours = std::vector<Neighbour>;

/// One close by: 1e-4 of an effect stands eight digits above rounding.
Neighbours for_search(double direction) { return {{direction * 1e-4, direction * 1e4}}; }

/// Five points (Abramowitz and Stegun, table 25.2): wrong by the fourth power of their distance,
/// and with rounding two to three digits lower, so that two machines report the same twelve.
constexpr double report_distance = 0.05;
Neighbours for_report(std::initializer_list<std::pair<double, double>> steps_and_weights) {
  Neighbours all;
  for (const auto& [steps, weight] : steps_and_weights) {
    all.push_back({steps * report_distance, weight / (12 * report_distance)});
  }
  return all;
}
Neighbours on_both_sides() { return for_report({{-2, 1}, {-1, -8}, {1, 8}, {2, -1}}); }
Neighbours on_one_side(double s) {
  return for_report({{s, 48 * s}, {2 * s, -36 * s}, {3 * s, 16 * s}, {4 * s, -3 * s}});
}

/// The first that stay within the parameter's bounds, else the last.
Neighbours neighbours(const ModelParameter& p, double here, FitUse use) {
  const auto within = [&](const Neighbours& all) {
    return std::all_of(all.begin(), all.end(), [&](const Neighbour& n) {
      const double there = here + n.scales * p.scale;
      return p.lower <= there && there <= p.upper;
    });
  };
  if (use == FitUse::report) {
    for (const Neighbours& all : {on_both_sides(), on_one_side(1), on_one_side(-1)}) {
      if (within(all)) return all;
    }
  }
  return within(for_search(1)) ? for_search(1) : for_search(-1);
}

/// A fit has converged when a step lowers the loss by less than this part: a hundred-thousandth of
/// the loss is far below what a block more or less changes.
constexpr double converged_decrease = 1e-7;
constexpr int most_iterations = 40;
/// For a search the slopes are kept after a step that lowered chi² by less than this, which is a
/// third of a standard error, and by less than this part of what the step before did.
constexpr double small_decrease = 0.1;
constexpr double small_decrease_ratio = 1e-2;
constexpr double first_damping = 1e-4;
/// Relative diagonal loading of the normal equations, so that parameters that happen to be parallel
/// share their effect instead of cancelling each other with huge values.
constexpr double loading = 1e-9;

double robust_sigma(const VectorXd& residual) {
  const VectorXd magnitude = residual.cwiseAbs();
  return mad_to_sigma * median({magnitude.begin(), magnitude.end()});
}

VectorXd huber_weights(const VectorXd& residual, double bound) {
  return (bound / residual.array().abs().max(bound)).matrix();
}

double huber_loss(const VectorXd& residual, double bound) {
  const auto beyond = residual.array().abs() - residual.array().abs().min(bound);
  return 0.5 * (residual.squaredNorm() - beyond.square().sum());
}

MatrixXd normal_matrix(const MatrixXd& jacobian, const VectorXd& weight) {
  return inner_products(weight.asDiagonal() * jacobian, jacobian);
}

VectorXd solve_loaded(MatrixXd normal, const VectorXd& gradient, double damping) {
  normal.diagonal() *= 1 + damping;
  normal.diagonal().array() += 1e-300;  // a column without any effect stays where it is
  return solve_symmetric(normal, gradient);
}

/// Model and unnamed regressors as one function of one vector: the freed parameters, each over its
/// scale, then the coefficients.
class FreedModel {
 public:
  FreedModel(const Record& record, const Freed& freed, std::vector<double> start)
      : record_(&record), values_(std::move(start)) {
    for (const std::size_t group : freed.groups) {
      const std::size_t count = record.problem().groups[group].parameters.size();
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t index = record.first_parameter(group) + k;
        if (record.parameters()[index].is_free()) free_.push_back(index);
      }
    }
    columns_.resize(record.rows(), static_cast<Index>(freed.unnamed.size()));
    for (std::size_t k = 0; k < freed.unnamed.size(); ++k) {
      VectorXd column = record.unnamed_columns().col(static_cast<Index>(freed.unnamed[k]));
      const double rms = std::sqrt(column.squaredNorm() / static_cast<double>(column.size()));
      if (rms > 0) column /= rms;
      column_size_.push_back(rms > 0 ? rms : 1);
      columns_.col(static_cast<Index>(k)) = column;
    }
    coefficients_ = VectorXd::Zero(columns_.cols());
  }

  [[nodiscard]] Index size() const { return static_cast<Index>(free_.size()) + columns_.cols(); }
  [[nodiscard]] const std::vector<std::size_t>& free() const { return free_; }
  [[nodiscard]] const std::vector<double>& values() const { return values_; }
  /// Of the columns as they were given.
  [[nodiscard]] VectorXd coefficients() const {
    const auto size = VectorXd::Map(column_size_.data(), coefficients_.size());
    return coefficients_.cwiseQuotient(size);
  }

  void residuals(VectorXd& out) const { residuals(values_, out); }
  void residuals(const std::vector<double>& values, VectorXd& out) const {
    record_->residuals(values, out);
    if (columns_.cols() > 0) out.noalias() -= columns_ * coefficients_;
  }

  /// The model after the step, bounds kept. What enters the prediction linearly moves straight: of
  /// a ratio to another parameter that is their product. Along a valley of equal products the ratio
  /// itself would creep.
  [[nodiscard]] FreedModel moved(const VectorXd& step) const {
    FreedModel result = *this;
    const auto move = [&](std::size_t k, double value) {
      const ModelParameter& p = record_->parameters()[free_[k]];
      result.values_[free_[k]] = std::clamp(value, p.lower, p.upper);
    };
    const auto change = [&](std::size_t k) {
      return record_->parameters()[free_[k]].scale * step[static_cast<Index>(k)];
    };
    for (std::size_t k = 0; k < free_.size(); ++k) move(k, values_[free_[k]] + change(k));
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const auto with = record_->parameters()[free_[k]].product_with;
      if (!with || !(result.values_[*with] > 0)) continue;
      const double before = values_[*with];
      const double ratio = values_[free_[k]];
      const double product =
          before * (ratio + change(k)) + ratio * (result.values_[*with] - before);
      move(k, product / result.values_[*with]);
    }
    result.coefficients_ += step.tail(columns_.cols());
    return result;
  }

  /// Slopes of the prediction by the parameters over their scales; `residual` is the one here.
  void jacobian(const VectorXd& residual, FitUse use, MatrixXd& out) const {
    out.resize(residual.size(), size());
    std::vector<double> values = values_;
    VectorXd there(residual.size());
    for (std::size_t k = 0; k < free_.size(); ++k) {
      const ModelParameter& p = record_->parameters()[free_[k]];
      const double here = values[free_[k]];
      auto column = out.col(static_cast<Index>(k));
      column.setZero();
      for (const Neighbour& n : neighbours(p, here, use)) {
        values[free_[k]] = here + n.scales * p.scale;
        residuals(values, there);
        column += n.weight * (residual - there);
      }
      values[free_[k]] = here;
    }
    out.rightCols(columns_.cols()) = columns_;
  }

  /// True where the parameter of column k rests on a bound and `gradient` pushes it outward.
  [[nodiscard]] bool held(Index k, double gradient) const {
    if (k >= static_cast<Index>(free_.size())) return false;
    const std::size_t index = free_[static_cast<std::size_t>(k)];
    const ModelParameter& p = record_->parameters()[index];
    return (values_[index] <= p.lower && gradient <= 0) ||
           (values_[index] >= p.upper && gradient >= 0);
  }

  /// The part of `step` after which the parameter of column k is stopped by a bound; +infinity
  /// where it is not.
  [[nodiscard]] double part_to_bound(Index k, const VectorXd& step) const {
    if (k >= static_cast<Index>(free_.size())) return infinity;
    const std::size_t index = free_[static_cast<std::size_t>(k)];
    const ModelParameter& p = record_->parameters()[index];
    const double value = values_[index];
    double base = 1;
    double base_change = 0;
    if (p.product_with && values_[*p.product_with] > 0) {
      base = values_[*p.product_with];
      const auto other = std::find(free_.begin(), free_.end(), *p.product_with);
      if (other != free_.end()) {
        base_change = record_->parameters()[*other].scale * step[other - free_.begin()];
      }
    }
    // Their product moves straight, so the distance of a ratio counts by what it is a ratio to.
    const auto to = [&](double bound, double outward) {
      if (!std::isfinite(bound)) return infinity;
      const double distance = outward * base * (bound - value);
      const double speed = outward * (base * p.scale * step[k] + (value - bound) * base_change);
      if (distance <= 0) return speed >= 0 ? 0 : infinity;
      return speed > 0 ? distance / speed : infinity;
    };
    return std::min(to(p.lower, -1), to(p.upper, 1));
  }

 private:
  const Record* record_;
  std::vector<double> values_;
  std::vector<std::size_t> free_;
  MatrixXd columns_;
  std::vector<double> column_size_;
  VectorXd coefficients_;  ///< of the columns brought to size 1
};

std::vector<Index> columns_not_held(const FreedModel& model, const VectorXd& gradient) {
  std::vector<Index> kept;
  for (Index k = 0; k < model.size(); ++k) {
    if (!model.held(k, gradient[k])) kept.push_back(k);
  }
  return kept;
}

struct WeightedMinimum {
  FreedModel model;
  VectorXd residual;
  MatrixXd jacobian;
  VectorXd weight;

  /// Beyond which a residual here counts less.
  [[nodiscard]] double bound() const {
    return huber_bound * std::max(robust_sigma(residual), 1e-12);
  }
  /// Weights by that bound where the model stands.
  void weigh(double beyond) { weight = huber_weights(residual, beyond); }
  /// The same, and slopes.
  void look_around(double beyond, FitUse use) {
    weigh(beyond);
    model.jacobian(residual, use, jacobian);
  }
  [[nodiscard]] VectorXd gradient() const {
    return inner_products_with(jacobian, weight.cwiseProduct(residual));
  }
};

/// The normal equations of the parameters that no bound holds.
class NormalEquations {
 public:
  explicit NormalEquations(const WeightedMinimum& at)
      : normal_(normal_matrix(at.jacobian, at.weight)),
        gradient_(at.gradient()),
        kept_(columns_not_held(at.model, gradient_)) {}

  /// Holds what a bound stops on the way to the minimum, the nearest first. Where a search ends,
  /// slopes do not tell what its bounds hold: that of a ratio is nearly that of what it is a ratio
  /// to, which there is zero but for rounding. Far from the minimum the way to it tells nothing.
  void hold_what_is_stopped(const FreedModel& model) {
    kept_.resize(static_cast<std::size_t>(model.size()));
    std::iota(kept_.begin(), kept_.end(), Index{0});
    for (;;) {
      const VectorXd whole = step(loading);
      const auto part = [&](Index k) { return model.part_to_bound(k, whole); };
      const auto first = std::ranges::min_element(kept_, {}, part);
      if (first == kept_.end() || part(*first) >= 1) return;
      kept_.erase(first);
    }
  }

  /// Of all parameters, those that are held staying where they are.
  [[nodiscard]] VectorXd step(double damping) const {
    VectorXd step = VectorXd::Zero(gradient_.size());
    step(kept_) = solve_loaded(normal_(kept_, kept_), gradient_(kept_), damping);
    return step;
  }
  /// Columns of the jacobian.
  [[nodiscard]] const std::vector<Index>& kept() const { return kept_; }

 private:
  MatrixXd normal_;
  VectorXd gradient_;
  std::vector<Index> kept_;
};

/// Where the search has ended.
NormalEquations equations_at_end(const WeightedMinimum& at) {
  NormalEquations equations(at);
  equations.hold_what_is_stopped(at.model);
  return equations;
}

/// Undamped steps from a converged fit for as long as each is shorter than the one before, which
/// is down to rounding: where a search ends depends on how it came there. What is left of the
/// slowest direction is extrapolated from the last two steps (D. G. Anderson, J. ACM 12, 1965, with
/// a memory of one).
void polish(WeightedMinimum& minimum) {
  constexpr int most_steps = 40;
  const auto look_around = [&minimum] {
    minimum.model.residuals(minimum.residual);
    minimum.look_around(minimum.bound(), FitUse::report);
  };
  FreedModel best = minimum.model;
  double shortest = 1;  // standard errors: what moves further had not converged
  VectorXd last_step;
  VectorXd move;
  for (int i = 0; i < most_steps; ++i) {
    look_around();
    const VectorXd step = equations_at_end(minimum).step(loading);
    const VectorXd change = minimum.jacobian * step;
    if (!(change.norm() < shortest)) break;
    shortest = change.norm();
    best = minimum.model;
    const VectorXd turn = i > 0 ? VectorXd(step - last_step) : VectorXd::Zero(step.size());
    const VectorXd seen = minimum.jacobian * turn;
    const double left = seen.squaredNorm() > 0 ? change.dot(seen) / seen.squaredNorm() : 0;
    move = i > 0 ? VectorXd(step - left * (move + turn)) : step;
    last_step = step;
    minimum.model = minimum.model.moved(move);
  }
  minimum.model = std::move(best);
  look_around();
}

WeightedMinimum minimise(FreedModel model, const Record& record, FitUse use) {
  WeightedMinimum at{std::move(model), VectorXd(record.rows()), {}, {}};
  at.model.residuals(at.residual);
  VectorXd trial_residual(record.rows());
  double damping = first_damping;
  double last_decrease = 1;
  bool slopes_kept = false;
  for (int iteration = 0;; ++iteration) {
    const double bound = at.bound();
    if (slopes_kept) {
      at.weigh(bound);
    } else {
      at.look_around(bound, FitUse::search);
    }
    if (at.model.size() == 0 || iteration == most_iterations) break;

    const NormalEquations equations(at);
    const double loss = huber_loss(at.residual, bound);
    double decrease = 0;
    for (int attempt = 0; attempt < 12; ++attempt) {
      FreedModel trial = at.model.moved(equations.step(damping + loading));
      trial.residuals(trial_residual);
      const double trial_loss = huber_loss(trial_residual, bound);
      if (trial_loss < loss) {
        decrease = (loss - trial_loss) / loss;
        at.model = std::move(trial);
        at.residual = trial_residual;
        damping = std::max(damping / 10, 1e-12);
        break;
      }
      damping = std::max(damping, 1e-8) * 10;
    }
    if (slopes_kept && decrease == 0) {
      slopes_kept = false;
      damping = first_damping;
      continue;
    }
    if (decrease < converged_decrease) {
      at.weigh(bound);
      break;
    }
    slopes_kept = decrease * static_cast<double>(record.rows()) < small_decrease &&
                  decrease < small_decrease_ratio * last_decrease;
    last_decrease = decrease;
  }
  if (use == FitUse::report && at.model.size() > 0) polish(at);
  return at;
}

/// Gauss–Newton steps without one block each: (H − H_b)·δ = g − g_b.
MatrixXd steps_without_blocks(const BlockFit& fit, const Record& record) {
  const Index columns = fit.jacobian.cols();
  MatrixXd steps = MatrixXd::Zero(columns, static_cast<Index>(record.blocks()));
  if (columns == 0) return steps;
  std::vector<MatrixXd> normals;
  std::vector<VectorXd> gradients;
  MatrixXd normal = MatrixXd::Zero(columns, columns);
  VectorXd gradient = VectorXd::Zero(columns);
  for (std::size_t b = 0; b < record.blocks(); ++b) {
    const auto rows = Eigen::seqN(record.block_begin(b), record.block_size(b));
    const MatrixXd jacobian = fit.jacobian(rows, Eigen::all);
    const VectorXd weight = fit.weight(rows);
    normals.push_back(normal_matrix(jacobian, weight));
    gradients.push_back(inner_products_with(jacobian, weight.cwiseProduct(fit.residual(rows))));
    normal += normals.back();
    gradient += gradients.back();
  }
  for (std::size_t b = 0; b < record.blocks(); ++b) {
    steps.col(static_cast<Index>(b)) =
        solve_loaded(normal - normals[b], gradient - gradients[b], loading);
  }
  return steps;
}

/// The values of `near` for what is free in both, elsewhere the parameters' own first ones.
std::vector<double> first_values(const Record& record, const Freed& freed, const BlockFit* near) {
  std::vector<double> values;
  for (const ModelParameter& p : record.parameters()) values.push_back(p.neutral);
  for (const std::size_t g : freed.groups) {
    const bool known = near != nullptr && contains(near->freed.groups, g);
    for (std::size_t k = 0; k < record.problem().groups[g].parameters.size(); ++k) {
      const std::size_t index = record.first_parameter(g) + k;
      values[index] = known ? near->values[index] : record.parameters()[index].start;
    }
  }
  return values;
}

}  // namespace

Groups with_group(Groups groups, std::size_t group) {
  groups.push_back(group);
  std::sort(groups.begin(), groups.end());
  return groups;
}

Groups without_group(Groups groups, std::size_t group) {
  std::erase(groups, group);
  return groups;
}

Record::Record(const SelectionProblem& problem)
    : problem_(problem), predicted_(problem.measured.size()) {
  const std::size_t size = problem.measured.size();
  const auto demand_rows = [size](const auto& column, const std::string& name) {
    if (column.size() != size) throw std::invalid_argument(name + " must have one element a row");
  };
  demand_rows(problem.noise, "measured, noise and block");
  demand_rows(problem.block, "measured, noise and block");
  for (const UnnamedRegressor& regressor : problem.unnamed) {
    demand_rows(regressor.column, "the regressor \"" + regressor.shape + "\"");
  }
  for (const auto& column : problem.systematic) demand_rows(column, "a systematic error");
  for (const auto& kind : problem.kinds) demand_rows(kind, "a kind of rows");
  for (const ParameterGroup& group : problem.groups) {
    first_.push_back(parameters_.size());
    for (const ModelParameter& p : group.parameters) {
      if (!(p.neutral <= p.upper && p.lower <= p.start && p.start <= p.upper && p.scale > 0)) {
        throw std::invalid_argument("a parameter of \"" + group.id +
                                    "\" has its neutral or first value outside its bounds");
      }
      parameters_.push_back(p);
    }
  }

  for (std::size_t i = 0; i < size; ++i) {
    if (problem.block[i] >= 0) rows_.push_back(i);
  }
  std::stable_sort(rows_.begin(), rows_.end(), [&problem](std::size_t a, std::size_t b) {
    return problem.block[a] < problem.block[b];
  });
  inverse_noise_.resize(rows());
  for (Index i = 0; i < rows(); ++i) {
    const std::size_t row = row_in_problem(i);
    if (!(problem.noise[row] > 0)) throw std::invalid_argument("noise must be positive");
    inverse_noise_[i] = 1 / problem.noise[row];
    const bool first_of_block =
        i == 0 || problem.block[row] != problem.block[row_in_problem(i - 1)];
    if (first_of_block) block_begin_.push_back(i);
  }
  block_begin_.push_back(rows());
  if (blocks() < fewest_blocks) {
    throw std::invalid_argument("the record has too few blocks with readings in them");
  }
  unnamed_columns_.resize(rows(), static_cast<Index>(problem.unnamed.size()));
  for (Index k = 0; k < unnamed_columns_.cols(); ++k) {
    unnamed_columns_.col(k) = scaled_column(problem.unnamed[static_cast<std::size_t>(k)].column);
  }
}

void Record::residuals(const std::vector<double>& values, VectorXd& out) const {
  problem_.predict(values, predicted_);
  out.resize(rows());
  for (Index i = 0; i < rows(); ++i) {
    const std::size_t row = row_in_problem(i);
    out[i] = (problem_.measured[row] - predicted_[row]) * inverse_noise_[i];
  }
}

VectorXd Record::scaled_column(const std::vector<double>& column) const {
  VectorXd out(rows());
  for (Index i = 0; i < rows(); ++i) out[i] = column[row_in_problem(i)] * inverse_noise_[i];
  return out;
}

BlockFit fit_blocks(const Record& record, const Freed& freed, const BlockFit* near, FitUse use) {
  WeightedMinimum minimum =
      minimise(FreedModel(record, freed, first_values(record, freed, near)), record, use);
  const FreedModel& model = minimum.model;

  BlockFit fit;
  fit.freed = freed;
  fit.values = model.values();
  fit.coefficients = model.coefficients();
  const std::vector<Index> kept = equations_at_end(minimum).kept();
  for (const Index k : kept) {
    if (k < static_cast<Index>(model.free().size())) {
      fit.active.push_back(model.free()[static_cast<std::size_t>(k)]);
    }
  }
  fit.jacobian = minimum.jacobian(Eigen::all, kept);
  fit.residual = std::move(minimum.residual);
  fit.weight = std::move(minimum.weight);
  fit.left_out = steps_without_blocks(fit, record);

  fit.holdout_residual.resize(record.rows());
  fit.block_error.resize(static_cast<Index>(record.blocks()));
  for (std::size_t b = 0; b < record.blocks(); ++b) {
    const auto rows = Eigen::seqN(record.block_begin(b), record.block_size(b));
    VectorXd held_out = fit.residual(rows);
    if (fit.jacobian.cols() > 0) {
      held_out -= product(fit.jacobian(rows, Eigen::all), fit.left_out.col(static_cast<Index>(b)));
    }
    fit.holdout_residual(rows) = held_out;
    fit.block_error[static_cast<Index>(b)] = held_out.squaredNorm();
  }
  return fit;
}

MatrixXd group_slopes(const Record& record, const Groups& groups, const std::vector<double>& values,
                      FitUse use) {
  const FreedModel model(record, {groups, {}}, values);
  VectorXd residual;
  MatrixXd slopes;
  model.residuals(residual);
  model.jacobian(residual, use, slopes);
  return slopes;
}

MatrixXd jackknife_covariance(MatrixXd left_out) {
  const auto blocks = static_cast<double>(left_out.cols());
  left_out.colwise() -= left_out.rowwise().mean().eval();
  return product((blocks - 1) / blocks * left_out, left_out.transpose());
}

MatrixXd jackknife_covariance(const BlockFit& fit, const std::vector<Index>& of) {
  return jackknife_covariance(fit.left_out(of, Eigen::all));
}

}  // namespace tethercalc
