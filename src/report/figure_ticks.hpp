// Where an axis has ticks, and what stands beside them.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/report/figure.hpp"

namespace tethercalc::plot {

/// Where `value` lies along the axis, 0 at its beginning to 1 at its end.
[[nodiscard]] double along(const Axis& axis, double value);

/// U+2212 as typography has it, or the hyphen that terminals have.
enum class Minus { typographic, hyphen };

/// Multiples of 1, 2 or 5 times a power of ten within the range, at most `most` (2 or more) steps
/// of them and at least two ticks.
[[nodiscard]] std::vector<Tick> round_ticks(Range range, int most, Minus minus);

/// The ticks of `axis`, on `length` units of a drawer's own: its own ticks, or round numbers. Words
/// of which two would come nearer than `gap` are left out: those later in the axis' own ticks, or
/// all but fewer, rounder numbers. `extent_of` is how far words reach along the axis.
[[nodiscard]] std::vector<Tick> ticks_of(const Axis& axis, double length, double gap, Minus minus,
                                         const std::function<double(std::string_view)>& extent_of);

}  // namespace tethercalc::plot
