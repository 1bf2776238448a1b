#include "diagnose/fit_judgement.hpp"

#include <algorithm>
#include <cmath>

#include "identify/distributions.hpp"
#include "identify/linear_algebra.hpp"
#include "identify/series.hpp"

namespace tethercalc {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double aliased_below = 0.01;
/// Cosine beyond which a change of the prediction looks like another at all.
constexpr double alike = 0.1;

std::size_t owner_of(const Record& record, std::size_t parameter) {
  std::size_t owner = 0;
  while (owner + 1 < record.problem().groups.size() &&
         record.first_parameter(owner + 1) <= parameter) {
    ++owner;
  }
  return owner;
}

}  // namespace

MatrixXd size_slopes(const Record& record, std::vector<double> values, std::size_t group) {
  const std::vector<ModelParameter>& own = record.problem().groups[group].parameters;
  std::vector<Index> sizes;
  for (std::size_t k = 0; k < own.size(); ++k) {
    values[record.first_parameter(group) + k] = own[k].start;
    if (!own[k].shape_only) sizes.push_back(static_cast<Index>(k));
  }
  return group_slopes(record, group, values)(Eigen::all, sizes);
}

double gain_percent(double before, double after) {
  return before > 0 ? 100 * (1 - std::sqrt(after / before)) : 0;
}

double gain_se_percent(const VectorXd& before, const VectorXd& after, double other) {
  const auto blocks = static_cast<double>(before.size());
  VectorXd gain(before.size());
  for (Index b = 0; b < gain.size(); ++b) {
    gain[b] = gain_percent(other + before.sum() - before[b], other + after.sum() - after[b]);
  }
  return std::sqrt((blocks - 1) / blocks * (gain.array() - gain.mean()).square().sum());
}

std::optional<Selection::Aliased> aliased_in(const Record& record, const BlockFit& fit,
                                             std::size_t group) {
  std::vector<Index> columns;
  for (std::size_t k = 0; k < fit.active.size(); ++k) {
    if (record.problem().groups[group].replaces != owner_of(record, fit.active[k])) {
      columns.push_back(static_cast<Index>(k));
    }
  }
  MatrixXd slopes = size_slopes(record, fit.values, group);
  const VectorXd norms = slopes.colwise().norm();
  if (norms.minCoeff() <= 0) return Selection::Aliased{group, {}};
  slopes = slopes * norms.cwiseInverse().asDiagonal();
  const VectorXd size = slopes.col(0);
  if (!columns.empty()) {
    const MatrixXd others = fit.jacobian(Eigen::all, columns);
    slopes -= others * least_squares(others, slopes);
  }
  const MatrixXd gram = slopes.transpose() * slopes;
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

namespace {

/// The sizes of the group by one step of weighted least squares beside what is free in the fit.
std::vector<SizeEstimate> sizes_beside(const Record& record, const BlockFit& fit,
                                       std::size_t group) {
  const MatrixXd sizes = size_slopes(record, fit.values, group);
  MatrixXd slopes(sizes.rows(), fit.jacobian.cols() + sizes.cols());
  slopes << fit.jacobian, sizes;
  const VectorXd weight = fit.weight.cwiseSqrt();
  slopes = weight.asDiagonal() * slopes;
  const VectorXd residual = weight.cwiseProduct(fit.residual);
  const MatrixXd gram = slopes.transpose() * slopes;
  const VectorXd along = slopes.transpose() * residual;
  const auto step = [](const MatrixXd& g, const VectorXd& a) -> VectorXd {
    return symmetric_pseudo_inverse(g) * a;
  };
  const VectorXd whole = step(gram, along);
  MatrixXd left_out(slopes.cols(), static_cast<Index>(record.blocks()));
  for (std::size_t b = 0; b < record.blocks(); ++b) {
    const MatrixXd rows = slopes.middleRows(record.block_begin(b), record.block_size(b));
    const VectorXd rest = residual.segment(record.block_begin(b), record.block_size(b));
    left_out.col(static_cast<Index>(b)) =
        step(gram - rows.transpose() * rows, along - rows.transpose() * rest);
  }
  const MatrixXd covariance = jackknife_covariance(std::move(left_out));

  std::vector<SizeEstimate> estimates;
  const std::vector<ModelParameter>& own = record.problem().groups[group].parameters;
  for (std::size_t k = 0; k < own.size(); ++k) {
    if (own[k].shape_only) continue;
    const Index column = fit.jacobian.cols() + static_cast<Index>(estimates.size());
    SizeEstimate& size = estimates.emplace_back();
    size.parameter = record.first_parameter(group) + k;
    size.value = own[k].neutral + own[k].scale * whole[column];
    size.standard_error = own[k].scale * std::sqrt(covariance(column, column));
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

}  // namespace

std::vector<Selection::Open> judge_open(const Record& record, const BlockFit& fit,
                                        const Groups& candidates,
                                        const std::function<BlockFit(std::size_t)>& with) {
  const auto degrees = static_cast<double>(record.blocks() - 1);
  std::vector<Selection::Open> open;
  for (const std::size_t g : candidates) {
    Selection::Open& candidate = open.emplace_back();
    candidate.group = g;
    candidate.sizes = sizes_beside(record, fit, g);
    for (const SizeEstimate& size : candidate.sizes) {
      const double offset = size.value - record.parameters()[size.parameter].neutral;
      const double p = 2 * student_tail(std::abs(offset) / size.standard_error, degrees) *
                       static_cast<double>(candidate.sizes.size() * candidates.size());
      if (size.standard_error > 0) candidate.p_value = std::min(candidate.p_value, p);
    }
    const BlockFit freed = with(g);
    candidate.gain_percent = gain_percent(fit.squared_error(), freed.squared_error());
    candidate.gain_se_percent = gain_se_percent(fit.block_error, freed.block_error);
    candidate.freed = neutral_fit(record.problem(), record.blocks());
    add_fit(record, freed, {}, candidate.freed);
  }
  return open;
}

LinearisedGains::LinearisedGains(const Record& record, const BlockFit& fit,
                                 const Groups& candidates) {
  const VectorXd weight = fit.weight.cwiseSqrt();
  const MatrixXd free = weight.asDiagonal() * fit.jacobian;
  MatrixXd slopes(fit.residual.size(), 0);
  for (const std::size_t g : candidates) {
    std::vector<double> values = fit.values;
    const std::vector<ModelParameter>& own = record.problem().groups[g].parameters;
    for (std::size_t k = 0; k < own.size(); ++k) {
      values[record.first_parameter(g) + k] = own[k].start;
      columns_[g].push_back(slopes.cols() + static_cast<Index>(k));
    }
    const MatrixXd of_group = group_slopes(record, g, values);
    slopes.conservativeResize(Eigen::NoChange, slopes.cols() + of_group.cols());
    slopes.rightCols(of_group.cols()) = weight.asDiagonal() * of_group;
  }
  if (free.cols() > 0) slopes -= free * least_squares(free, slopes);
  gram_ = slopes.transpose() * slopes;
  along_ = slopes.transpose() * weight.cwiseProduct(fit.residual);
}

double LinearisedGains::of(const Groups& groups) const {
  std::vector<Index> columns;
  for (const std::size_t g : groups) {
    columns.insert(columns.end(), columns_.at(g).begin(), columns_.at(g).end());
  }
  const VectorXd along = along_(columns);
  return along.dot(symmetric_pseudo_inverse(gram_(columns, columns)) * along);
}

Groups without_rivals(Groups open, const std::vector<SelectedGroup>& selected) {
  for (const SelectedGroup& s : selected) {
    std::erase_if(open, [&s](std::size_t g) { return contains(s.indistinguishable, g); });
  }
  return open;
}

Groups in_order_of_nearness(std::vector<std::pair<double, std::size_t>> found) {
  std::sort(found.begin(), found.end());
  Groups groups;
  for (const auto& [distance, group] : found) groups.push_back(group);
  return groups;
}

Groups twins_of(const SelectionProblem& problem, std::size_t group) {
  Groups twins;
  for (std::size_t g = 0; g < problem.groups.size(); ++g) {
    if (problem.groups[g].twin_of == group && !problem.groups[g].fitted) twins.push_back(g);
  }
  return twins;
}

ModelFit neutral_fit(const SelectionProblem& problem, std::size_t blocks) {
  ModelFit fit;
  for (const ParameterGroup& group : problem.groups) {
    for (const ModelParameter& p : group.parameters) fit.values.push_back(p.neutral);
  }
  fit.standard_error.assign(fit.values.size(), 0);
  fit.product_covariance.assign(fit.values.size(), 0);
  fit.without_block.assign(blocks, fit.values);
  return fit;
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

void name_channels(const SelectionProblem& problem, UnnamedStructure& unnamed) {
  for (const std::size_t u : unnamed.regressors) {
    const std::string& channel = problem.unnamed[u].channel;
    if (!contains(unnamed.channels, channel)) unnamed.channels.push_back(channel);
  }
}

}  // namespace tethercalc
