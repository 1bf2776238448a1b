#include "tethercalc/study/sweep.hpp"

#include <algorithm>
#include <cmath>

#include "model/cable_family.hpp"
#include "model/constants.hpp"

namespace tethercalc {
namespace {

SweepOutcome given_cable(const Design& design) {
  SweepOutcome outcome;
  outcome.given_area = true;
  const double area = design.tether.cross_section.value_or(nan);
  outcome.points = evaluate_areas_to_tell(design, std::span(&area, 1)).front();
  const DemandMargin& worst = outcome.points.worst;
  outcome.feasible = worst.met();
  if (outcome.feasible) return outcome;
  outcome.limited_by = missed_limit(design, outcome.points.in(worst.condition), worst.demand);
  outcome.limiting_condition = worst.condition;
  return outcome;
}

JudgedRow judged(const SweepOutcome& outcome, const Design& design) {
  return {outcome.area(), judged_power(outcome, design), outcome.feasible};
}

/// The number that tells the cables of a sweep's rows apart, where each would have its own; nothing
/// where the rows are too few to pay for solving the cables between them as well.
std::optional<CableNumber> number_of_cables(const SweepSpace& space, const Design& base) {
  constexpr std::uint64_t worth_it = 500;
  constexpr std::uint64_t looked_at = 16;
  if (space.rows() < worth_it) return std::nullopt;
  std::vector<Design> designs;
  SweepCursor cursor(space, base);
  for (const std::uint64_t row : spread_rows(space.rows(), looked_at)) {
    cursor.move_to(row);
    designs.push_back(cursor.design());
  }
  return told_apart_by(designs);
}

/// Outcomes of a sweep's rows, the same in whatever order and by however many threads, each of
/// which has its own.
class RowOutcomes {
 public:
  RowOutcomes(bool given_area, std::optional<CableNumber> number) : given_area_(given_area) {
    if (number) memory_ = std::make_shared<const CableFamilies>(*number);
  }
  [[nodiscard]] SweepOutcome of(const Design& row) const {
    if (!memory_) return sweep_outcome(row, given_area_);
    Design design = row;  // who writes rows must not keep the memory
    design.tether.memory = memory_.get();
    return sweep_outcome(design, given_area_);
  }

 private:
  bool given_area_;
  std::shared_ptr<const CableMemory> memory_;
};

/// Appends what a point of two samples comes to: in the first, in the second, and in the first with
/// each axis in turn taken from the second. `unit` holds its place in both, in shares.
void add_mixtures(std::span<const SweepAxis> axes, std::span<const double> unit,
                  const RowOutcomes& outcomes, SweepCursor& cursor, std::vector<JudgedRow>& rows) {
  const auto add = [&](const std::vector<double>& values) {
    cursor.set_values(values);
    rows.push_back(judged(outcomes.of(cursor.design()), cursor.design()));
  };
  std::vector<double> a;
  std::vector<double> b;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    a.push_back(quantile(axes[i], unit[i]));
    b.push_back(quantile(axes[i], unit[axes.size() + i]));
  }
  add(a);
  add(b);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    std::vector<double> mixed = a;
    mixed[i] = b[i];
    add(mixed);
  }
}

/// One output of what `add_mixtures` made of some points.
template <typename Output>
SensitivitySample sample_of(const std::vector<JudgedRow>& rows, std::size_t axes,
                            const Output& output) {
  SensitivitySample sample;
  sample.mixed.resize(axes);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::size_t which = k % (axes + 2);
    auto& values = which == 0 ? sample.a : which == 1 ? sample.b : sample.mixed[which - 2];
    values.push_back(output(rows[k]));
  }
  return sample;
}

/// Of how many points some design is infeasible.
std::uint64_t incomplete_points(const std::vector<JudgedRow>& rows, std::size_t axes) {
  std::uint64_t count = 0;
  for (auto point = rows.begin(); point != rows.end();) {
    const auto next = point + static_cast<std::ptrdiff_t>(axes + 2);
    if (!std::all_of(point, next, [](const JudgedRow& row) { return row.feasible; })) ++count;
    point = next;
  }
  return count;
}

}  // namespace

SweepOutcome sweep_outcome(const Design& design, bool given_area) {
  if (given_area) return given_cable(design);
  const Optimization result = optimum_alone(design);
  SweepOutcome outcome;
  outcome.feasible = result.feasible;
  outcome.limited_by = result.limited_by;
  outcome.limiting_condition = result.limiting_condition;
  if (result.feasible) {
    outcome.points = result;
  } else {
    outcome.points.area = nan;
    outcome.refusal = refusal_of(design, result);
  }
  return outcome;
}

double judged_power(const SweepOutcome& outcome, const Design& design) {
  if (std::isnan(outcome.area())) return nan;
  return outcome.points.in(design.requirements.power_at).total_power;
}

std::optional<GroundContact> ground_contact(const SweepSpace& space, const Design& base) {
  constexpr std::uint64_t looked_at = 4;  // one on a weak winch may take seconds
  if (space.rows() == 0) return std::nullopt;
  const bool given_area = varies_cross_section(space);
  SweepCursor cursor(space, base);
  for (const std::uint64_t row : spread_rows(space.rows(), looked_at)) {
    cursor.move_to(row);
    const Design& design = cursor.design();
    if (design.tether.model == TetherModel::straight) continue;
    const double area = sweep_outcome(design, given_area).area();
    if (auto ground = ground_contact(area, shapes_in_flight(design, area))) return ground;
  }
  return std::nullopt;
}

bool varies_cross_section(const SweepSpace& space) {
  const auto axes = space.axes();
  return std::ranges::count(axes, "tether.cross_section_mm2", &SweepAxis::name) > 0;
}

void compute_sweep(const SweepJob& job, const std::function<bool(const SweepChunk&)>& consume) {
  // About a millisecond of work and 100 kilobytes of text: long against the handing over, short
  // enough to stay in a core's cache.
  constexpr std::uint64_t rows_per_chunk = 256;
  const RowRange all = job.range;
  if (all.begin >= all.end) return;
  const std::uint64_t chunks = (all.end - all.begin + rows_per_chunk - 1) / rows_per_chunk;
  const bool given_area = varies_cross_section(*job.space);
  const auto number = number_of_cables(*job.space, *job.base);

  const auto make_worker = [&] {
    return [&, cursor = SweepCursor(*job.space, *job.base),
            outcomes = RowOutcomes(given_area, number)](std::uint64_t index,
                                                        SweepChunk& chunk) mutable {
      chunk.range.begin = all.begin + index * rows_per_chunk;
      chunk.range.end = std::min(chunk.range.begin + rows_per_chunk, all.end);
      chunk.text.clear();
      chunk.judged.clear();
      for (std::uint64_t row = chunk.range.begin; row < chunk.range.end; ++row) {
        cursor.move_to(row);
        const SweepOutcome outcome = outcomes.of(cursor.design());
        chunk.judged.push_back(judged(outcome, cursor.design()));
        if (row >= job.write_from)
          job.write(chunk.text, {cursor.values(), cursor.design(), outcome});
      }
    };
  };
  compute_in_order<SweepChunk>(0, chunks, job.runner, make_worker, consume);
}

void SweepSummary::add(const JudgedRow& row) {
  ++draws;
  if (!row.feasible || std::isnan(row.power)) {
    ++infeasible;
    return;
  }
  area.add(row.area);
  power.add(row.power);
}

SweepSensitivity sweep_sensitivity(const SweepSpace& space, const Design& base,
                                   const ChunkRunner& runner) {
  constexpr std::uint64_t points_per_chunk = 64;
  const std::size_t axes = space.axes().size();
  SweepSensitivity result;
  result.points = std::min(space.rows(), most_sensitivity_points);
  result.evaluations = result.points * (axes + 2);
  using Rows = std::vector<JudgedRow>;
  const SamplePlan plan{result.points, space.sample()->method, space.sample()->seed};
  const bool given_area = varies_cross_section(space);
  const auto number = number_of_cables(space, base);
  const auto make_worker = [&] {
    return [&, cursor = SweepCursor(space, base), outcomes = RowOutcomes(given_area, number),
            points = UnitPoints(plan, 2 * axes),
            unit = std::vector<double>(2 * axes)](std::uint64_t index, Rows& rows) mutable {
      rows.clear();
      const std::uint64_t begin = index * points_per_chunk;
      const std::uint64_t end = std::min(begin + points_per_chunk, result.points);
      for (std::uint64_t j = begin; j < end; ++j) {
        points.at(j, unit);
        add_mixtures(space.axes(), unit, outcomes, cursor, rows);
      }
    };
  };
  Rows all;
  const std::uint64_t chunks = (result.points + points_per_chunk - 1) / points_per_chunk;
  compute_in_order<Rows>(0, chunks, runner, make_worker, [&](const Rows& rows) {
    all.insert(all.end(), rows.begin(), rows.end());
    return true;
  });
  const auto indices = [&](const auto& output) {
    return sobol_indices(sample_of(all, axes, output), plan.seed);
  };
  result.incomplete = incomplete_points(all, axes);
  result.area = indices([](const JudgedRow& row) { return row.feasible ? row.area : nan; });
  result.power = indices([](const JudgedRow& row) { return row.feasible ? row.power : nan; });
  if (result.incomplete > 0) {
    result.feasible = indices([](const JudgedRow& row) { return row.feasible ? 1.0 : 0.0; });
    if (std::isnan(result.feasible.front().total.value)) result.feasible.clear();
  }
  return result;
}

}  // namespace tethercalc
