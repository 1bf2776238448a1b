// Whatever a design says, no area tried is better than its optimum, and evaluate agrees with it.
//
// The first four bytes are the seed of a random design; each three after that set one field of a
// spec, a number anywhere in its range or one of its words.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <span>

#include "support/random_designs.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/model/demands.hpp"
#include "tethercalc/solve/headroom.hpp"
#include "tethercalc/solve/optimize.hpp"

namespace {

using namespace tethercalc;

void require(bool holds) {
  if (!holds) std::abort();
}

/// `share` of the way along the range, by its logarithm where all of it is positive.
double along(const FieldRange& range, double share) {
  const double lo = std::max(range.min, -1e6);
  const double hi = std::min(range.max, 1e6);
  if (share == 0) return lo;
  const double least = std::max(lo, 1e-6 * hi);
  return lo >= 0 ? least * std::pow(hi / least, share) : lo + (hi - lo) * share;
}

void set_one(Design& design, const std::uint8_t* bytes) {
  const std::span<const SpecField> fields = spec_fields();
  const SpecField& field = fields[bytes[0] % fields.size()];
  // A hanging tether takes minutes where a winch hardly holds it: those are drawn in the suite.
  const std::span<const std::string> words = field_words(field.kind);
  if (!words.empty() && field.kind != FieldKind::tether_model) {
    set_word(design, field, bytes[2] % words.size());
  }
  if (!is_numeric(field)) return;
  const double share = (bytes[1] * 256 + bytes[2]) / 65535.0;
  double value = along(field.range, share);
  if (field.kind == FieldKind::integer) value = std::round(value);
  if (field.range.contains(value)) set_field(design, field, value);
}

void hold_against_areas(const Design& design) {
  const Optimization result = optimize(design);
  const Requirements& need = design.requirements;
  const BestHeadroom best = best_headroom(design, need.headroom_at);
  const SteadyFlight hover(design, Condition::hover);
  const SteadyFlight forward(design, Condition::forward);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 100; ++i) {
    const double area = 1e-10 * std::pow(1e9, i / 99.0);
    const OperatingPoint at_hover = evaluate(hover, area);
    const OperatingPoint at_forward = evaluate(forward, area);
    const bool priced_at_hover = need.power_at == Condition::hover;
    const double power = (priced_at_hover ? at_hover : at_forward).total_power;
    const OperatingPoint& judged = need.headroom_at == Condition::hover ? at_hover : at_forward;
    require(!(judged.headroom > 1e-6) || best.value >= judged.headroom * (1 - 1e-8));
    if (power < least && demand_margins(design, at_hover, at_forward).met()) least = power;
  }
  require(result.feasible || std::isinf(least));
  if (!result.feasible) return;
  const OperatingPoint at_hover = evaluate(hover, result.area);
  const OperatingPoint at_forward = evaluate(forward, result.area);
  require(demand_margins(design, at_hover, at_forward).met());
  const bool priced_at_hover = need.power_at == Condition::hover;
  require((priced_at_hover ? at_hover : at_forward).total_power <= least * (1 + 1e-7));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 4) return 0;
  unsigned seed = 0;
  for (std::size_t i = 0; i < 4; ++i) seed = seed * 256 + data[i];
  test::Random random(seed);
  Design design = test::random_extreme_design(random);
  for (std::size_t i = 4; i + 3 <= std::min<std::size_t>(size, 64); i += 3)
    set_one(design, data + i);
  if (find_conflicts(design).empty()) hold_against_areas(design);
  return 0;
}
