// Points spread over the unit cube, from which sampled sweeps draw their designs.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

namespace tethercalc {

/// How points are spread.
enum class SampleMethod {
  sobol,           ///< low-discrepancy sequence with a random digital shift
  latin_hypercube  ///< one point in each of `count` equal slices of every dimension
};

/// Which points to draw.
struct SamplePlan {
  std::uint64_t count = 0;                    ///< number of points, > 0
  SampleMethod method = SampleMethod::sobol;  ///< how they are spread
  std::uint64_t seed = 0;                     ///< other seeds, other points
};

/// The points of a plan in any order: each depends on the plan and its own index alone, so that
/// threads, shards and resumed runs draw the same ones, and none is stored.
///
/// Sobol: direction numbers of Joe and Kuo (2008) as in Boost.Random, the zeroth point included
/// (dropping it spoils the balance of 2^k points; Owen 2022, "On dropping the first Sobol' point"),
/// and shifted digit by digit by a seeded random number for each dimension, which keeps the
/// sequence's evenness (L'Ecuyer and Lemieux 2002). The first d dimensions are the same whatever
/// the number of dimensions. Latin hypercube (McKay, Beckman and Conover 1979): the slices are put
/// in random order by a keyed permutation (a Feistel cipher that walks its cycles until it falls
/// into the range; Black and Rogaway 2002) instead of a shuffled table.
class UnitPoints {
 public:
  /// Throws std::invalid_argument for no points, no dimensions, or more than 1000 dimensions.
  UnitPoints(const SamplePlan& plan, std::size_t dimensions);
  ~UnitPoints();
  /// Movable, so that each thread can be given its own.
  UnitPoints(UnitPoints&&) noexcept;
  /// Likewise.
  UnitPoints& operator=(UnitPoints&&) noexcept;

  /// Writes point `index` (< count) to `point`, one number in (0, 1) a dimension. A few ns a
  /// dimension; with Sobol, fastest where indices follow each other.
  void at(std::uint64_t index, std::span<double> point);

 private:
  struct Sequence;
  SamplePlan plan_;
  std::size_t dimensions_;
  std::unique_ptr<Sequence> sequence_;  ///< null for a Latin hypercube
};

}  // namespace tethercalc
