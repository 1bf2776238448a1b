#include "tethercalc/report/result_figures.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "report/figure_data.hpp"
#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/report/diagnosis_report.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc {
namespace {

using plot::Colour;

constexpr std::size_t most_dots_a_plot = 250;  // a plot and series

/// Columns of equal length without the rows in which any value is missing.
using Table = std::vector<std::vector<double>>;

Table complete_rows(const std::vector<std::span<const double>>& columns) {
  Table out(columns.size());
  for (std::size_t i = 0; i < columns.front().size(); ++i) {
    const bool complete = std::all_of(columns.begin(), columns.end(),
                                      [i](const auto& c) { return std::isfinite(c[i]); });
    for (std::size_t c = 0; complete && c < columns.size(); ++c) out[c].push_back(columns[c][i]);
  }
  return out;
}

Table thinned(const Table& rows) {
  const std::size_t step = plot::thinning(rows.front().size(), most_dots_a_plot);
  Table kept(rows.size());
  for (std::size_t c = 0; c < rows.size(); ++c) {
    for (std::size_t i = 0; i < rows[c].size(); i += step) kept[c].push_back(rows[c][i]);
  }
  return kept;
}

/// Means over equal stretches of the first column within `range`, where there are a few samples.
Table binned(const Table& rows, plot::Range range) {
  constexpr std::size_t bins = 24;
  constexpr std::size_t fewest = 4;
  std::vector<std::size_t> count(bins);
  Table sums(rows.size(), std::vector<double>(bins));
  for (std::size_t i = 0; i < rows.front().size(); ++i) {
    const double place = (rows[0][i] - range.lo) / (range.hi - range.lo);
    if (!(place >= 0 && place < 1)) continue;
    const auto bin = std::size_t(place * bins);
    ++count[bin];
    for (std::size_t c = 0; c < rows.size(); ++c) sums[c][bin] += rows[c][i];
  }
  Table out(rows.size());
  for (std::size_t b = 0; b < bins; ++b) {
    if (count[b] < fewest) continue;
    for (std::size_t c = 0; c < rows.size(); ++c) out[c].push_back(sums[c][b] / double(count[b]));
  }
  return out;
}

/// Held-out errors of a compared quantity before and after, in words.
struct Errors {
  std::string before;
  std::string after;
};

/// Root mean square, without samples that are left out.
double error_of(const std::vector<double>& measured, const std::vector<double>& predicted) {
  double sum = 0;
  double count = 0;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (!std::isfinite(predicted[i])) continue;
    sum += (measured[i] - predicted[i]) * (measured[i] - predicted[i]);
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

Errors errors_of(const Diagnosis& d, std::size_t series) {
  const auto words = [](double value, const std::string& unit) {
    return significant(value, 3) + " " + unit;
  };
  if (d.kind == LogKind::power && series < d.further.size()) {
    const HoldoutComparison& c = d.further[series];
    return {words(c.base_rmse, c.unit), words(c.extended_rmse, c.unit)};
  }
  const ComparedSeries& s = d.compared[series];
  return {words(error_of(s.measured, s.before), s.unit),
          words(error_of(s.measured, s.after), s.unit)};
}

/// Predicted against measured, before and after side by side.
std::array<plot::Panel, 2> compared_panels(const Diagnosis& d, std::size_t k) {
  const ComparedSeries& series = d.compared[k];
  const Table rows = complete_rows({series.measured, series.before, series.after});
  const Table shown = thinned(rows);
  const plot::Range measured = plot::bulk(rows[0]);
  const plot::Range predicted = plot::joint(plot::bulk(rows[1]), plot::bulk(rows[2]));
  const Errors errors = errors_of(d, k);
  const auto panel = [&](bool after) {
    return plot::Panel{
        .x = {.label = fmt::format("measured ({})", series.unit), .range = measured},
        .y = {.range = plot::joint(measured, predicted)},
        .remark = after ? "after: " + errors.after : "before: " + errors.before,
        .lines = 11,
        .beside = after,
        .layers = {
            plot::Curve{
                .x = {measured.lo, measured.hi}, .y = {measured.lo, measured.hi}, .width = 0.8},
            plot::Points{.x = shown[0],
                         .y = shown[after ? 2 : 1],
                         .mark = plot::Mark::speck,
                         .colour = after ? Colour::blue : Colour::vermilion}}};
  };
  std::array panels{panel(false), panel(true)};
  panels[0].y.label = fmt::format("{}, predicted ({})", series.quantity, series.unit);
  return panels;
}

/// What is left without and with a finding, against its channel.
plot::Panel finding_panel(const Diagnosis& d, std::size_t k) {
  const FindingTrace& trace = d.traces[k];
  const ComparedSeries& series = d.compared[trace.series];
  const Table rows = complete_rows({trace.channel.values, trace.without, trace.with});
  const Table shown = thinned(rows);
  const plot::Range x = plot::bulk(rows[0]);
  const Table means = binned(rows, x);
  const auto dots = [&](std::size_t c, plot::Mark mark, Colour colour, const std::string& words) {
    return plot::Points{
        .x = shown[0], .y = shown[c], .mark = mark, .colour = colour, .words = words};
  };
  const auto line = [&](std::size_t c, plot::Dash dash, Colour colour, const std::string& words) {
    return plot::Curve{
        .x = means[0], .y = means[c], .colour = colour, .dash = dash, .width = 2, .words = words};
  };
  return {
      .title = d.findings[k].title,
      .x = {.label = fmt::format("{} ({})", trace.channel.name, trace.channel.unit), .range = x},
      .y = {.label = fmt::format("measured less predicted ({})", series.unit),
            .range = plot::joint(plot::bulk(rows[1]), plot::bulk(rows[2]))},
      .lines = 9.5,
      .layers = {plot::zero_line(), dots(1, plot::Mark::cross, Colour::orange, "without it"),
                 dots(2, plot::Mark::speck, Colour::sky, "with it"),
                 line(1, plot::Dash::solid, Colour::vermilion, "means without it"),
                 line(2, plot::Dash::dashed, Colour::blue, "means with it")}};
}

/// One origin of the error.
struct Origin {
  std::string words;
  double percent = 0;
  Colour colour = Colour::ink;
};

/// Findings in the order of the chain, then what has no name.
std::vector<Origin> origins(const Diagnosis& d) {
  constexpr std::array<std::string_view, 5> chain{"supply", "tether", "converter", "motors",
                                                  "airframe"};
  constexpr std::array colours{Colour::purple, Colour::vermilion, Colour::orange, Colour::blue,
                               Colour::green};
  std::vector<Origin> out;
  for (std::size_t s = 0; s < chain.size(); ++s) {
    for (std::size_t k = 0; k < d.findings.size() && k < d.budget.findings.size(); ++k) {
      if (d.findings[k].stage != chain[s]) continue;
      out.push_back({d.findings[k].stage + ": " + in_words(d.findings[k].effect),
                     d.budget.findings[k], colours[s]});
    }
  }
  out.push_back({"unexplained", d.budget.unexplained, Colour::ink});
  out.push_back({rest_words(d.unexplained), d.budget.noise, Colour::grey});
  return out;
}

plot::Bars budget_bars(const Diagnosis& d) {
  plot::Bars out{.title = "Origins of the squared error before, by stage"};
  for (const Origin& origin : origins(d)) {
    out.bars.push_back({.words = origin.words,
                        .share = origin.percent / 100,
                        .number = fixed(origin.percent, 1) + " %",
                        .colour = origin.colour});
  }
  return out;
}

/// One line an effect, in the order of the five verdicts.
std::vector<std::string> verdicts(const Diagnosis& d) {
  std::vector<std::string> out;
  const auto tell = [&out](const std::string& effect, std::size_t flight,
                           const std::string& verdict) {
    const std::string where = flight == 0 ? "" : fmt::format(" (flight {})", flight);
    out.push_back(in_words(effect) + where + ": " + verdict);
  };
  for (const Finding& f : d.findings) {
    tell(f.effect, f.flight,
         fmt::format("found, {} ± {} %", fixed(f.gain_percent, 1), fixed(f.gain_se_percent, 1)));
    for (const std::string& rival : f.indistinguishable_from) {
      tell(rival, 0, "would explain as well as " + in_words(f.effect));
    }
  }
  for (const Suspected& s : d.suspected) {
    tell(
        s.effect, s.flight,
        fmt::format("suspected, {} ± {} %", fixed(s.gain_percent, 1), fixed(s.gain_se_percent, 1)));
  }
  const RuledOut* before = nullptr;  // of several sizes the first is told
  for (const RuledOut& r : d.ruled_out) {
    const bool same = before && before->effect == r.effect && before->flight == r.flight;
    before = &r;
    if (same) continue;
    tell(r.effect, r.flight,
         fmt::format("ruled out beyond {}{}", significant(r.bound, 2),
                     r.unit == "1" ? "" : " " + r.unit));
  }
  for (const NotTestable& n : d.not_testable) tell(n.effect, n.flight, "not testable");
  for (const NotIdentifiable& n : d.not_identifiable) {
    tell(n.effect, n.flight, "not identifiable");
  }
  return out;
}

std::string description_of(const std::string& name, const Diagnosis& d) {
  std::string out = fmt::format("Diagnosis of {}: predicted over measured ", name);
  for (std::size_t k = 0; k < d.compared.size(); ++k) {
    const Errors errors = errors_of(d, k);
    out += fmt::format("{}{}, off by {} before and {} after", k == 0 ? "" : "; ",
                       d.compared[k].quantity, errors.before, errors.after);
  }
  out += ". Squared error by origin: ";
  for (const Origin& origin : origins(d)) {
    out += fmt::format("{} {} %, ", origin.words, fixed(origin.percent, 1));
  }
  out.resize(out.size() - 2);
  return fmt::format("{}. Verdicts: {}.", out, fmt::join(verdicts(d), ", "));
}

}  // namespace

Figure diagnosis_figure(const std::string& name, const Diagnosis& diagnosis) {
  if (diagnosis.compared.empty()) {
    throw std::invalid_argument(diagnosis.notes.empty() ? "nothing in this log can be compared"
                                                        : diagnosis.notes.back().sentence);
  }
  Figure figure{.id = "diagnosis",
                .title = "Diagnosis of " + name,
                .heading = name,
                .description = description_of(name, diagnosis)};
  for (std::size_t k = 0; k < diagnosis.compared.size(); ++k) {
    for (plot::Panel& panel : compared_panels(diagnosis, k)) {
      figure.parts.emplace_back(std::move(panel));
    }
  }
  for (std::size_t k = 0; k < diagnosis.traces.size(); ++k) {
    figure.parts.emplace_back(finding_panel(diagnosis, k));
  }
  figure.parts.emplace_back(budget_bars(diagnosis));
  figure.parts.emplace_back(plot::Lines{.title = "Verdicts", .texts = verdicts(diagnosis)});
  return figure;
}

}  // namespace tethercalc
