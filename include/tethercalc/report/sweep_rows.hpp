// One line of text a design: what a sweep writes.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/solve/optimize.hpp"
#include "tethercalc/solve/sweep_space.hpp"

namespace tethercalc {

/// A design's result in a sweep: its optimum or, where a sweep varies the cross-section itself,
/// what the given cable does.
struct SweepOutcome {
  bool given_area = false;                  ///< the cross-section was given, not found
  bool feasible = false;                    ///< there is an optimum, or the given cable will do
  Limit limited_by = Limit::minimum_power;  ///< not for a given, feasible cable
  Condition limiting_condition = Condition::hover;  ///< likewise
  double area = 0;                                  ///< m²; NaN where there is no optimum
  OperatingPoint hover;                             ///< at `area`; meaningless where that is NaN
  OperatingPoint forward;                           ///< likewise
  std::string reason;                               ///< why it is infeasible; empty where it is not
};

/// Optimises the design. With `given_area`, evaluates `design.tether.cross_section` instead, which
/// is feasible where it keeps the required headroom (unless there is a buffer battery) and can be
/// flown in both conditions.
[[nodiscard]] SweepOutcome sweep_outcome(const Design& design, bool given_area = false);

/// The total power in W where the design is judged by its power; NaN where it does not exist.
[[nodiscard]] double judged_power(const SweepOutcome& outcome, const Design& design);

/// How rows are written.
enum class RowFormat {
  csv,        ///< RFC 4180 with plain newlines; empty where a value does not exist
  json_lines  ///< one object a line, the CSV's columns its keys; null where one does not exist
};

/// Turns outcomes into rows: the varied values by their dot paths, then `status` ("optimal",
/// "infeasible"; "feasible" for a given cable), `limited_by`, `limiting_condition`,
/// `cross_section_mm2`, the operating points as "hover." and "forward." followed by the keys of
/// `operating_point_fields`, and `reason`. Numbers are the shortest texts that read back as the
/// same double.
class SweepRows {
 public:
  /// For rows that begin with a value of each of `axes`.
  SweepRows(std::span<const SweepAxis> axes, RowFormat format);

  /// The line of column names; empty for JSON Lines.
  [[nodiscard]] const std::string& header() const { return header_; }

  /// Appends one row, newline included. `values` has one number an axis.
  void append(std::string& text, std::span<const double> values, const SweepOutcome& outcome) const;

 private:
  std::vector<SweepAxis> axes_;
  RowFormat format_;
  std::string header_;
  std::vector<std::string> openings_;  ///< what stands in front of each column's value
};

/// What to compute of a sweep.
struct SweepJob {
  const SweepSpace* space = nullptr;  ///< the designs
  const Design* base = nullptr;       ///< what does not vary
  const SweepRows* rows = nullptr;    ///< how rows read
  RowRange range;                     ///< rows to compute
  std::uint64_t write_from = 0;       ///< rows before this one are computed without a text
  unsigned threads = 1;               ///< at least 1
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
  std::string text;               ///< their lines, of those from `write_from` on
  std::vector<JudgedRow> judged;  ///< one a row
};

/// True where a sweep varies the cross-section itself, so that cables are evaluated, not found.
[[nodiscard]] bool varies_cross_section(const SweepSpace& space);

/// Computes a sweep on several threads and hands its rows over in order, which does not depend on
/// their number. `consume` is called on this thread and returns false to stop. Holds a few hundred
/// kilobytes a thread, whatever the number of rows.
void compute_sweep(const SweepJob& job, const std::function<bool(const SweepChunk&)>& consume);

}  // namespace tethercalc
