#include "report/figure_ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tethercalc::plot {
namespace {

/// With as many decimals as numbers need that are `step` apart.
std::string number_words(double value, double step, Minus minus) {
  const double size = std::abs(value);
  const int decimals = std::max(0, -int(std::floor(std::log10(step * (1 + 1e-9)))));
  const bool plain = size < 1e6 && decimals < 6;
  std::string out = plain ? fmt::format("{:.{}f}", size, decimals) : fmt::format("{:g}", size);
  if (value < 0) out.insert(0, minus == Minus::typographic ? "\u2212" : "-");
  return out;
}

/// The least of 1, 2 and 5 times a power of ten that is not below `least`.
double round_step(double least) {
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= least * (1 - 1e-9)) return digit * power;
  }
  return 10 * power;
}

/// Powers of ten and, as `digits` has them, their multiples.
std::vector<Tick> decade_ticks(Range range, std::initializer_list<int> digits, Minus minus) {
  std::vector<Tick> out;
  const int last = int(std::floor(std::log10(range.hi)));
  for (int power = int(std::floor(std::log10(range.lo))); power <= last; ++power) {
    for (const int digit : digits) {
      const double at = digit * std::pow(10, power);
      if (at >= range.lo && at <= range.hi) out.push_back({at, number_words(at, at, minus)});
    }
  }
  return out;
}

}  // namespace

double along(const Axis& axis, double value) {
  const auto [lo, hi] = axis.range;
  return axis.logarithmic ? std::log(value / lo) / std::log(hi / lo) : (value - lo) / (hi - lo);
}

std::vector<Tick> round_ticks(Range range, int most, Minus minus) {
  // Nearer than that numbers on the axis cannot be told apart.
  const double length =
      std::max(range.hi - range.lo, 1e-9 * std::max(std::abs(range.lo), std::abs(range.hi)));
  double step = round_step(length / most);
  std::vector<Tick> out;
  // A range just longer than a step may hold one tick only, which tells no scale.
  for (int finer = 0; finer < 4 && out.size() < 2; ++finer) {
    out.clear();
    const double slack = 1e-9 * length;
    const double first = std::ceil((range.lo - slack) / step);
    const double last = std::floor((range.hi + slack) / step);
    for (double k = 0; k <= last - first; ++k) {
      const double at = first + k == 0 ? 0 : (first + k) * step;
      out.push_back({at, number_words(at, step, minus)});
    }
    step = round_step(step / 2.5);
  }
  return out;
}

std::vector<Tick> ticks_of(const Axis& axis, double length, double gap, Minus minus,
                           const std::function<double(std::string_view)>& extent_of) {
  const auto touch = [&](const Tick& a, const Tick& b) {
    const double apart = std::abs(along(axis, a.at) - along(axis, b.at)) * length;
    return apart < (extent_of(a.words) + extent_of(b.words)) / 2 + gap;
  };
  const auto any_touch = [&](const std::vector<Tick>& ticks) {
    for (std::size_t i = 1; i < ticks.size(); ++i) {
      if (touch(ticks[i - 1], ticks[i])) return true;
    }
    return false;
  };
  std::vector<Tick> out;
  if (!axis.ticks.empty()) {
    for (const Tick& tick : axis.ticks) {
      const double place = along(axis, tick.at);
      if (!(place >= -1e-9 && place <= 1 + 1e-9)) continue;
      const bool covered = std::ranges::any_of(
          out, [&](const Tick& other) { return !other.words.empty() && touch(tick, other); });
      out.push_back({tick.at, covered ? "" : tick.words});
    }
  } else if (!axis.numbers) {
    return {};
  } else {
    // On little more than a decade round numbers are nearer to each other than its digits.
    std::vector<std::vector<Tick>> choice;
    if (axis.logarithmic) {
      choice.push_back(decade_ticks(axis.range, {1, 2, 5}, minus));
      const std::vector<Tick> decades = decade_ticks(axis.range, {1}, minus);
      for (std::size_t every = 1; every < decades.size(); ++every) {
        choice.emplace_back();
        for (std::size_t k = 0; k < decades.size(); k += every) choice.back().push_back(decades[k]);
      }
    }
    for (int most = 8; most >= 2; --most) choice.push_back(round_ticks(axis.range, most, minus));
    const auto fits = [&](const std::vector<Tick>& ticks) {
      return ticks.size() >= 2 && !any_touch(ticks);
    };
    const auto chosen = std::ranges::find_if(choice, fits);
    out =
        chosen != choice.end() ? *chosen : std::vector{choice.back().front(), choice.back().back()};
  }
  if (!axis.numbers) {
    for (Tick& tick : out) tick.words.clear();
  }
  return out;
}

}  // namespace tethercalc::plot
