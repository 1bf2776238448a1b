// What a sweep varies, as people write it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/solve/sweep_space.hpp"

namespace tethercalc {

/// The axes that `varied` describes, each a text "path=values" about a field of the spec `base`:
///
/// | values            | meaning                                                               |
/// |-------------------|-----------------------------------------------------------------------|
/// | `40:100:5`        | 40, 45 … 100; the last value only where a step meets it               |
/// | `40,60,75`        | these; names for motors and materials, hover or forward, true or false |
/// | `all`             | all motors, conductors or insulation materials of the library         |
/// | `10..60`          | drawn between 10 and 60 with equal chance (samples only)              |
/// | `75~1.5`          | drawn from a normal distribution: mean 75, standard deviation 1.5     |
///
/// A path names a number, a motor, a material, a condition or a switch of the spec; or a number of
/// the conductor or insulation material, such as `tether.conductor.density_g_cm3`, which varies
/// that of whatever material the design has. Motor and material files are relative to the spec. In
/// a sample, lists and ranges are drawn from with equal chance.
///
/// Throws InputError with every problem of every axis: unknown or repeated fields, fields that do
/// not change the result, unreadable values, values out of the field's range, names that the
/// library lacks, distributions in a sweep that is not sampled.
[[nodiscard]] std::vector<SweepAxis> read_sweep_axes(std::span<const std::string> varied,
                                                     const DesignFile& base, bool sampled);

/// Throws InputError where some row of `space` is not allowed: a number drawn out of its range, or
/// fields in conflict, such as a converter that cuts off above the supply voltage; it names the
/// first row of each conflict. Fast where the ends of the axes are allowed together; otherwise it
/// walks a sample's draws, about ten million a second.
void check_sweep_rows(const SweepSpace& space, const DesignFile& base);

}  // namespace tethercalc
