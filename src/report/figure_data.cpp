#include "report/figure_data.hpp"

#include <array>
#include <iterator>

#include "model/constants.hpp"

namespace tethercalc::plot {

Colour curve_colour(std::size_t index) {
  constexpr std::array colours{Colour::blue,   Colour::vermilion, Colour::green, Colour::orange,
                               Colour::purple, Colour::sky,       Colour::ink};
  return colours[index % colours.size()];
}

Dash curve_dash(std::size_t index) {
  constexpr std::array dashes{Dash::solid, Dash::dashed, Dash::dotted, Dash::dash_dotted,
                              Dash::dash_dot_dotted};
  return dashes[index % dashes.size()];
}

Range extent(std::span<const double> values) {
  Range range{1, 0};
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    range = range.lo > range.hi ? Range{value, value} : joint(range, {value, value});
  }
  return range.lo > range.hi ? Range{} : range;
}

Series outline(std::span<const double> x, std::span<const double> y, std::size_t bins) {
  Series out;
  if (x.size() < 2) return out;
  constexpr double gap = 5;  // mean steps
  const double mean_step = (x.back() - x.front()) / double(x.size() - 1);
  const double width = (x.back() - x.front()) / double(bins);
  for (std::size_t first = 0; first < x.size();) {
    std::size_t last = first;
    std::size_t least = first;
    std::size_t most = first;
    while (last + 1 < x.size() && x[last + 1] < x[first] + width &&
           x[last + 1] - x[last] <= gap * mean_step) {
      ++last;
      if (y[last] < y[least]) least = last;
      if (y[last] > y[most]) most = last;
    }
    std::vector<std::size_t> kept{first, std::min(least, most), std::max(least, most), last};
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    for (const std::size_t i : kept) {
      out.x.push_back(x[i]);
      out.y.push_back(y[i]);
    }
    if (last + 1 < x.size() && x[last + 1] - x[last] > gap * mean_step) {
      out.x.push_back(x[last]);
      out.y.push_back(nan);
    }
    first = last + 1;
  }
  return out;
}

Range bulk(std::span<const double> values, double outlying) {
  std::vector<double> sorted;
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted),
               [](double value) { return std::isfinite(value); });
  if (sorted.empty()) return {};
  std::ranges::sort(sorted);
  const auto skipped = std::size_t(outlying * double(sorted.size()));
  const Range most = with_margin({sorted[skipped], sorted[sorted.size() - 1 - skipped]}, 0.25);
  return with_margin({std::max(sorted.front(), most.lo), std::min(sorted.back(), most.hi)});
}

}  // namespace tethercalc::plot
