// The grammar PATH=VALUES: what a sweep varies and a search frees, as people write it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/solve/sweep_space.hpp"

namespace tethercalc {

/// What is done with the values of an axis.
enum class AxisUse {
  enumerated,  ///< every combination, as by `sweep --vary`
  sampled,     ///< drawn, as by `sweep --vary --sample`
  searched     ///< for the best, as by `design --free`
};

/// The axes that `texts` describe, each "path=values" about a field of the spec `base`:
///
/// | values            | meaning                                                               |
/// |-------------------|-----------------------------------------------------------------------|
/// | `40:100:5`        | 40, 45 … 100; the last value only where a step meets it               |
/// | `40,60,75`        | these; names for motors and materials, hover or forward, true or false |
/// | `all`             | all that the library has, or all words that the field takes           |
/// | `10..60`          | between 10 and 60: drawn with equal chance, or searched; not enumerated |
/// | `75~1.5`          | drawn from a normal distribution: mean 75, standard deviation 1.5     |
///
/// A path is one that `find_field` knows and names a number, a motor, a material, a condition or a
/// switch; a number of a material varies that of whatever material the design has. Motor and
/// material files are relative to the spec. In a sample, lists and ranges are drawn from with equal
/// chance. A search may have a range of equal ends.
///
/// Throws InputError with every problem of every axis: unknown or repeated fields, fields that do
/// not change the result, unreadable values, values out of the field's range, names that the
/// library lacks, values that do not go with the use.
[[nodiscard]] std::vector<SweepAxis> read_axes(std::span<const std::string> texts,
                                               const DesignFile& base, AxisUse use);

/// Throws InputError where some row of `space` is not allowed: a number drawn out of its range, or
/// fields in conflict, such as a converter that cuts off above the supply voltage; it names the
/// first row of each conflict. `option` is what the message calls the axes. Fast where the ends of
/// the axes are allowed together; otherwise it walks a sample's draws, about ten million a second.
void check_sweep_rows(const SweepSpace& space, const DesignFile& base,
                      const std::string& option = "--vary");

/// Designs to be drawn, as written.
struct SampleRequest {
  std::uint64_t draws = 0;       ///< how many
  std::string method = "sobol";  ///< "sobol", which an empty one stands for, or "lhs"
  std::uint64_t seed = 0;        ///< of the draws
};

/// The designs that the axes `texts` (see `read_axes`) make of `base`: every combination or, with
/// `sample`, draws. Throws InputError as `read_axes` and `check_sweep_rows` do, for an unknown
/// method, and where there are too many combinations.
[[nodiscard]] SweepSpace read_sweep_space(std::span<const std::string> texts,
                                          const DesignFile& base,
                                          const std::optional<SampleRequest>& sample = {});

/// The way of sampling that `method` names (see SampleRequest). Throws InputError where it names
/// none.
[[nodiscard]] SampleMethod sample_method(const std::string& method);

}  // namespace tethercalc
