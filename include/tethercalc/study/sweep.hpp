// Many designs: what each comes to, how the results are spread, and which inputs spread them.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tethercalc/solve/ordered_chunks.hpp"
#include "tethercalc/solve/sensitivity.hpp"
#include "tethercalc/solve/spread.hpp"
#include "tethercalc/solve/sweep_space.hpp"
#include "tethercalc/study/optimum.hpp"

namespace tethercalc {

/// A design's result in a sweep: its optimum or, where a sweep varies the cross-section itself,
/// what the given cable does.
struct SweepOutcome {
  bool given_area = false;                  ///< the cross-section was given, not found
  bool feasible = false;                    ///< there is an optimum, or the given cable will do
  Limit limited_by = Limit::minimum_power;  ///< not for a given, feasible cable
  Condition limiting_condition = Condition::hover;  ///< likewise
  AreaPoints points;  ///< at that cross-section; its area NaN where there is no optimum
  std::optional<Refusal> refusal;  ///< why there is none

  /// The cross-section in m²; NaN where there is none.
  [[nodiscard]] double area() const { return points.area; }
};

/// Optimises the design. With `given_area`, evaluates `design.tether.cross_section` instead, which
/// is feasible where it meets all demands.
[[nodiscard]] SweepOutcome sweep_outcome(const Design& design, bool given_area = false);

/// The total power in W where the design is judged by its power; NaN where it does not exist.
[[nodiscard]] double judged_power(const SweepOutcome& outcome, const Design& design);

/// One row of a sweep as computed.
struct SweepRow {
  std::span<const double> values;  ///< one an axis
  const Design& design;            ///< with these values
  const SweepOutcome& outcome;     ///< its result
};

/// Appends what is to be kept of a row to `text`. Called from several threads at once.
using RowWriter = std::function<void(std::string& text, const SweepRow& row)>;

/// What to compute of a sweep.
struct SweepJob {
  const SweepSpace* space = nullptr;  ///< the designs
  const Design* base = nullptr;       ///< what does not vary
  RowWriter write;                    ///< how rows read
  RowRange range;                     ///< rows to compute
  std::uint64_t write_from = 0;       ///< rows before this one are computed without a text
  ChunkRunner runner;                 ///< by whom
};

/// What a summary needs of one row. NaN where there is none.
struct JudgedRow {
  double area = 0;        ///< m²
  double power = 0;       ///< W, `judged_power`
  bool feasible = false;  ///< as in SweepOutcome
};

/// Consecutive rows.
struct SweepChunk {
  RowRange range;                 ///< which rows
  std::string text;               ///< what was written of those from `write_from` on
  std::vector<JudgedRow> judged;  ///< one a row
};

/// Whether a solved tether lies on the ground: the first that does of four rows spread over a
/// sweep.
[[nodiscard]] std::optional<GroundContact> ground_contact(const SweepSpace& space,
                                                          const Design& base);

/// True where a sweep varies the cross-section itself, so that cables are evaluated, not found.
[[nodiscard]] bool varies_cross_section(const SweepSpace& space);

/// Computes a sweep and hands its rows over in order. `consume` is called on this thread and
/// returns false to stop. Holds a few hundred kilobytes a thread, whatever the number of rows.
void compute_sweep(const SweepJob& job, const std::function<bool(const SweepChunk&)>& consume);

/// Sensitivity of each result to each axis of a sweep, in the order of the axes.
struct SweepSensitivity {
  std::uint64_t points = 0;       ///< of each of the two samples that were mixed
  std::uint64_t evaluations = 0;  ///< designs computed: points·(axes + 2)
  std::uint64_t incomplete = 0;   ///< points with some infeasible design, left out where it matters
  std::vector<Sensitivity> area;  ///< of the optimum
  std::vector<Sensitivity> power;     ///< of the total power where the design is judged by it
  std::vector<Sensitivity> feasible;  ///< of being feasible, as 1 or 0; empty where all or none are
};

/// Largest number of points of a sensitivity analysis: their standard errors are then below 0.01 in
/// all but odd cases, in about a second.
inline constexpr std::uint64_t most_sensitivity_points = 1 << 16;

/// Sobol indices over the axes of a sampled space, with as many points as it has draws, at most
/// `most_sensitivity_points`. The first of the two samples continues the space's own kind of sample
/// and seed.
[[nodiscard]] SweepSensitivity sweep_sensitivity(const SweepSpace& space, const Design& base,
                                                 const ChunkRunner& runner = {});

/// What all draws of a sampled sweep say together.
struct SweepSummary {
  std::uint64_t draws = 0;       ///< rows added
  std::uint64_t infeasible = 0;  ///< those of them without an optimum
  Spread area;                   ///< m²
  Spread power;                  ///< W, where the design is judged by its power
  SweepSensitivity sensitivity;  ///< from `sweep_sensitivity`

  /// Counts one row in.
  void add(const JudgedRow& row);
};

}  // namespace tethercalc
