#include "tethercalc/model/catenary.hpp"

#include <algorithm>
#include <cmath>

namespace tethercalc {
namespace {

/// sinh(μ)/μ − 1, to all digits for small μ.
double sinhc_less_one(double mu) {
  if (mu > 1) return std::sinh(mu) / mu - 1;
  const double square = mu * mu;
  double term = square / 6;
  double sum = term;
  for (int n = 4; term > 1e-18 * sum && n < 40; n += 2) {
    term *= square / (n * (n + 1));
    sum += term;
  }
  return sum;
}

/// μ > 0 with sinh(μ)/μ = 1 + `excess`, excess > 0.
double sinhc_inverse(double excess) {
  if (excess < 1) {
    // sinh(μ)/μ − 1 ≥ μ²/6 and convex: Newton from there falls on the root from one side.
    double mu = std::sqrt(6 * excess);
    for (int i = 0; i < 40; ++i) {
      const double value = sinhc_less_one(mu);
      const double slope =
          mu > 1e-3 ? (std::cosh(mu) - 1 - value) / mu : mu / 3 * (1 + mu * mu / 10);
      const double step = (value - excess) / slope;
      mu -= step;
      if (std::abs(step) <= 4e-16 * mu) break;
    }
    return mu;
  }
  // ln(sinh(μ)/μ) is convex with a slope below one.
  const double wanted = std::log1p(excess);
  double mu = wanted + std::log(2 * (wanted + 1));
  for (int i = 0; i < 40; ++i) {
    const double value = mu + std::log1p(-std::exp(-2 * mu)) - std::log(2 * mu);
    const double step = (value - wanted) / (1 / std::tanh(mu) - 1 / mu);
    mu -= step;
    if (std::abs(step) <= 4e-16 * mu) break;
  }
  return mu;
}

/// H = 0: two strands side by side, or one that hangs straight.
std::optional<Catenary> plumb(double z, double length, double weight,
                              std::optional<double> stiffness) {
  const double stretch = stiffness ? 1 + weight * length / (2 * *stiffness) : 1;
  // The strands' lengths a and b: (b − a)·(1 + w·L/2EA) = z.
  const double difference = z / stretch;
  if (std::abs(difference) <= length) {
    return Catenary{0, -0.5 * weight * (length - difference), 0.5 * weight * (length + difference)};
  }
  if (!stiffness) return std::nullopt;
  const double stretched = std::abs(z) - length;
  const double middle = std::copysign(*stiffness * stretched / length, z);
  return Catenary{0, middle - 0.5 * weight * length, middle + 0.5 * weight * length};
}

std::optional<Catenary> inextensible(double x, double z, double length, double weight) {
  const double distance = std::hypot(x, z);
  if (!(length > distance)) return std::nullopt;
  const double reach = std::sqrt((length - z) * (length + z));
  const double excess = (length - distance) * (length + distance) / (x * (reach + x));
  if (!(excess > 0)) return std::nullopt;
  const double mu = sinhc_inverse(excess);
  const double horizontal = weight * x / (2 * mu);
  const double sum = z / std::tanh(mu);  // (V at the start + V at the end)/w
  return Catenary{horizontal, 0.5 * weight * (sum - length), 0.5 * weight * (sum + length)};
}

/// asinh(b) − asinh(a), without cancellation where both are large and alike.
double asinh_difference(double a, double b) {
  if (a * b <= 0) return std::asinh(b) - std::asinh(a);
  return std::asinh((b - a) * (b + a) / (b * std::hypot(1, a) + a * std::hypot(1, b)));
}

struct Reach {
  double x = 0;
  double z = 0;
};

/// Where the end is, with H and V at the start.
Reach reach_of(const Catenary& c, double s, double weight, std::optional<double> stiffness) {
  if (s == 0) return {};
  const double start = c.vertical_at_start;
  const double end = start + weight * s;
  Reach reach{
      0, s * (start + end) / (std::hypot(c.horizontal, start) + std::hypot(c.horizontal, end))};
  if (c.horizontal > 0) {
    reach.x = c.horizontal / weight * asinh_difference(start / c.horizontal, end / c.horizontal);
  }
  if (stiffness) {
    reach.x += c.horizontal * s / *stiffness;
    reach.z += s * (start + end) / (2 * *stiffness);
  }
  return reach;
}

/// How the end's place changes with H and V; ∂x/∂V = ∂z/∂H.
struct Flexibility {
  double x_by_horizontal = 0;  ///< m/N
  double x_by_vertical = 0;
  double z_by_vertical = 0;
};

Flexibility flexibility(const Catenary& c, double length, double weight,
                        std::optional<double> stiffness) {
  const double h = c.horizontal;
  const double start = c.vertical_at_start;
  const double end = start + weight * length;
  const double t0 = std::hypot(h, start);
  const double t1 = std::hypot(h, end);
  const double stretch = stiffness ? length / *stiffness : 0;
  return {
      asinh_difference(start / h, end / h) / weight + (start / t0 - end / t1) / weight + stretch,
      h * (1 / t1 - 1 / t0) / weight, (end / t1 - start / t0) / weight + stretch};
}

/// From the cable that does not stretch, no tauter than a spring without weight would be by much,
/// or from that spring.
Catenary first_elastic(double x, double z, double length, double weight, double stiffness) {
  const double distance = std::hypot(x, z);
  const double all = weight * length;
  if (const auto stiff = inextensible(x, z, length * (1 + 1e-6), weight)) {
    const double most = stiffness * std::max(distance / length - 1, 0.0) + 20 * all +
                        std::cbrt(stiffness * all * all);
    const double scale =
        std::min(1.0, most / std::hypot(stiff->horizontal, stiff->vertical_at_start));
    return {scale * stiff->horizontal, scale * stiff->vertical_at_start, 0};
  }
  const double pull = std::max(stiffness * (distance / length - 1), all);
  return {pull * x / distance, pull * z / distance - 0.5 * all, 0};
}

/// Newton's method in H and V. How far the end is off is the gradient of the complementary energy
/// ∫(T + T²/2EA)ds − H·x − V·z, which is convex: a step is as long as the energy still falls at its
/// end, or rises less steeply than it fell, and so leads to the only minimum there is.
std::optional<Catenary> elastic(double x, double z, double length, double weight,
                                double stiffness) {
  Catenary c = first_elastic(x, z, length, weight, stiffness);
  const auto gradient = [&](const Catenary& tried) {
    const Reach at = reach_of(tried, length, weight, stiffness);
    return Reach{at.x - x, at.z - z};
  };
  Reach miss = gradient(c);
  for (int i = 0; i < 200; ++i) {
    const Flexibility by = flexibility(c, length, weight, stiffness);
    const double determinant =
        by.x_by_horizontal * by.z_by_vertical - by.x_by_vertical * by.x_by_vertical;
    double step_h = -(miss.x * by.z_by_vertical - miss.z * by.x_by_vertical) / determinant;
    double step_v = -(miss.z * by.x_by_horizontal - miss.x * by.x_by_vertical) / determinant;
    if (!std::isfinite(step_h) || !std::isfinite(step_v)) return std::nullopt;
    if (step_h <= -c.horizontal) {  // H stays positive
      const double part = 0.9 * c.horizontal / -step_h;
      step_h *= part;
      step_v *= part;
    }
    const double falls = miss.x * step_h + miss.z * step_v;
    Catenary next;
    Reach next_miss;
    for (double part = 1; part > 1e-9; part *= 0.5) {
      next = {c.horizontal + part * step_h, c.vertical_at_start + part * step_v, 0};
      next_miss = gradient(next);
      if (next_miss.x * step_h + next_miss.z * step_v <= -0.9 * falls) break;
    }
    const double size = std::hypot(c.horizontal, c.vertical_at_start, weight * length);
    c = next;
    miss = next_miss;
    if (std::hypot(step_h, step_v) < 1e-9 * size) break;  // whose square is left
  }
  if (!(std::hypot(miss.x, miss.z) < 1e-9 * (std::hypot(x, z) + length))) return std::nullopt;
  c.vertical_at_end = c.vertical_at_start + weight * length;
  return c;
}

}  // namespace

std::optional<Catenary> catenary(double x, double z, double length, double weight,
                                 std::optional<double> axial_stiffness) {
  if (x == 0) return plumb(z, length, weight, axial_stiffness);
  return axial_stiffness ? elastic(x, z, length, weight, *axial_stiffness)
                         : inextensible(x, z, length, weight);
}

CatenaryStiffness catenary_stiffness(const Catenary& shape, double length, double weight,
                                     std::optional<double> axial_stiffness) {
  if (shape.horizontal == 0) {
    // Along the plumb line: two strands take up what their difference gains, or one stretches.
    const bool folded = shape.vertical_at_start < 0 && shape.vertical_at_end > 0;
    const double stretch = axial_stiffness ? length / *axial_stiffness : 0;
    return {0, 0, folded ? 1 / (2 / weight + stretch) : 1 / stretch};
  }
  const Flexibility by = flexibility(shape, length, weight, axial_stiffness);
  const double determinant =
      by.x_by_horizontal * by.z_by_vertical - by.x_by_vertical * by.x_by_vertical;
  return {by.z_by_vertical / determinant, -by.x_by_vertical / determinant,
          by.x_by_horizontal / determinant};
}

CatenaryPoint catenary_point(const Catenary& shape, double s, double weight,
                             std::optional<double> axial_stiffness) {
  const Reach at = reach_of(shape, s, weight, axial_stiffness);
  return {at.x, at.z, std::hypot(shape.horizontal, shape.vertical_at_start + weight * s)};
}

}  // namespace tethercalc
