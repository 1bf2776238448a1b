// The designs of a sweep: which quantities vary, over which values, in which order.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "tethercalc/model/design.hpp"
#include "tethercalc/solve/unit_points.hpp"

namespace tethercalc {

/// Equally spaced decimal numbers: number i is (first + i·step)/10^decimals, rounded once, so that
/// 0:1:0.1 yields 0.3 and not 0.30000000000000004.
struct DecimalRange {
  std::int64_t first = 0;   ///< times 10^decimals
  std::int64_t step = 1;    ///< times 10^decimals, of either sign
  std::uint64_t count = 1;  ///< how many numbers
  int decimals = 0;         ///< 0 … 22, powers of ten that double represents exactly
};

/// Choices without a number, such as motors: a value is the position in this list.
struct NamedChoices {
  std::vector<std::string> names;  ///< as rows print them
};

/// Draws between two ends with equal chance. For sampled sweeps.
struct Uniform {
  double lo = 0;  ///< lower end
  double hi = 0;  ///< upper end
};

/// Draws one of lo, lo + 1 … hi with equal chance. For sampled sweeps.
struct UniformInteger {
  std::int64_t lo = 0;  ///< the least
  std::int64_t hi = 0;  ///< the largest
};

/// Draws from a normal distribution. For sampled sweeps.
struct Normal {
  double mean = 0;                ///< of the distribution
  double standard_deviation = 0;  ///< likewise, > 0
};

/// One varied quantity of a design.
struct SweepAxis {
  std::string name;  ///< dot path of the field: "tether.length_m"
  /// What it takes, or is drawn from.
  std::variant<DecimalRange, std::vector<double>, NamedChoices, Uniform, UniformInteger, Normal>
      values;
  /// Puts a value, in the field's practical unit or the position of a named choice, into a design.
  /// Called from several threads at once on different designs.
  std::function<void(Design&, double)> apply;
};

/// Number of values, nothing for a continuous distribution.
[[nodiscard]] std::optional<std::uint64_t> value_count(const SweepAxis& axis);

/// Value `index` (< value_count) of an axis that can be enumerated.
[[nodiscard]] double value_at(const SweepAxis& axis, std::uint64_t index);

/// The value below which a share `u` in (0, 1) of the draws lies. Values of a list or range are
/// drawn with equal chance.
[[nodiscard]] double quantile(const SweepAxis& axis, double u);

/// `design` with a value of each axis in place, as `SweepCursor` puts them there.
[[nodiscard]] Design with_values(Design design, std::span<const SweepAxis> axes,
                                 std::span<const double> values);

/// Rows [begin, end).
struct RowRange {
  std::uint64_t begin = 0;  ///< the first row, counted from 0
  std::uint64_t end = 0;    ///< the row after the last
};

/// The rows of part `part` of `parts` (1 ≤ part ≤ parts): consecutive, so that the parts one after
/// the other are all `rows`, and differing in number by one at most.
[[nodiscard]] RowRange shard_rows(std::uint64_t rows, std::uint64_t part, std::uint64_t parts);

/// The designs of a sweep, by row. Holds axes, not designs: its size does not grow with the rows.
class SweepSpace {
 public:
  /// Every combination, the last axis changing fastest. Throws std::invalid_argument where an axis
  /// cannot be enumerated or there are 2^63 combinations or more.
  explicit SweepSpace(std::vector<SweepAxis> axes);

  /// `plan.count` draws.
  SweepSpace(std::vector<SweepAxis> axes, const SamplePlan& plan);

  /// Number of combinations or draws.
  [[nodiscard]] std::uint64_t rows() const { return rows_; }
  /// What varies, in the order of the columns.
  [[nodiscard]] std::span<const SweepAxis> axes() const { return axes_; }
  /// The plan of a sampled space; nothing for every combination.
  [[nodiscard]] const std::optional<SamplePlan>& sample() const { return plan_; }

 private:
  std::vector<SweepAxis> axes_;
  std::optional<SamplePlan> plan_;
  std::uint64_t rows_ = 1;
};

/// The numbers of at most `most` (≥ 2) of `rows` rows, spread evenly from the first to the last.
[[nodiscard]] std::vector<std::uint64_t> spread_rows(std::uint64_t rows, std::uint64_t most);

/// Walks the rows of a space. One a thread.
class SweepCursor {
 public:
  /// Starts at row 0 of a space with at least one row. `space` must outlive the cursor.
  SweepCursor(const SweepSpace& space, const Design& base);

  /// Goes to `row` (< the space's rows).
  void move_to(std::uint64_t row);

  /// The varied values of this row, one an axis, in the axes' order.
  [[nodiscard]] std::span<const double> values() const { return values_; }

  /// The base design with these values in place.
  [[nodiscard]] const Design& design() const { return design_; }

  /// The same for values given one by one: what sensitivity analysis mixes from two draws.
  void set_values(std::span<const double> values);

 private:
  const SweepSpace* space_;
  Design design_;
  std::optional<UnitPoints> points_;
  std::vector<std::size_t> order_;  ///< axes in the order of application
  std::vector<double> values_;
  std::vector<double> next_;
};

}  // namespace tethercalc
