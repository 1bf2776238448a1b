#include "tethercalc/report/result_figures.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "report/gnuplot_script.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc {
namespace {

constexpr std::size_t most_dots = 250;  // a plot and series
constexpr double dot_width = 0.008;     // of the frame

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

std::string thinned_block(std::string_view name, const Table& rows) {
  const std::size_t step = gp::thinning(rows.front().size(), most_dots);
  Table kept(rows.size());
  gp::Columns columns;
  for (std::size_t c = 0; c < rows.size(); ++c) {
    for (std::size_t i = 0; i < rows[c].size(); i += step) kept[c].push_back(rows[c][i]);
    columns.emplace_back(kept[c]);
  }
  return gp::data_block(name, columns);
}

/// Means over equal stretches of the first column within `range`, where there are a few samples.
Table binned(const Table& rows, gp::Range range) {
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
  if (d.kind == "power" && series < d.further.size()) {
    const HoldoutComparison& c = d.further[series];
    return {words(c.base_rmse, c.unit), words(c.extended_rmse, c.unit)};
  }
  const ComparedSeries& s = d.compared[series];
  return {words(error_of(s.measured, s.before), s.unit),
          words(error_of(s.measured, s.after), s.unit)};
}

constexpr double compared_lines = 18;
constexpr double finding_lines = 19;

/// Predicted against measured, before and after side by side.
std::string compared_panels(const gp::Layout& layout, double top, const Diagnosis& d, std::size_t k,
                            const std::string& name_of_log) {
  const ComparedSeries& series = d.compared[k];
  const Table rows = complete_rows({series.measured, series.before, series.after});
  const std::string name = fmt::format("compared{}", k + 1);
  const gp::Range measured = gp::bulk(rows[0]);
  const gp::Range range = gp::joint(measured, gp::joint(gp::bulk(rows[1]), gp::bulk(rows[2])));
  const Errors errors = errors_of(d, k);
  std::string out = thinned_block(name, rows) + gp::set_range("x", measured) +
                    gp::set_range("y", range) + gp::set_tics("x", measured, 5) +
                    "unset xzeroaxis\nset format x '%g'\n";
  for (const bool after : {false, true}) {
    const gp::Layout column = layout.column(after);
    gp::Plot plot;
    plot.dots("$" + name, 1, after ? 3 : 2, dot_width * (measured.hi - measured.lo),
              after ? colour::blue : colour::vermilion);
    plot.curve("x", gp::line(colour::black, 1, 0.8));
    out += column.panel(top + 2.6, top + 13.5) + column.legend(0, 1, {});
    out += column.above(top + 1.6, after ? "after: " + errors.after : "before: " + errors.before);
    if (!after) {
      if (k == 0) out += layout.heading(name_of_log);
      out += layout.title(top, fmt::format("{}, predicted ({})", series.quantity, series.unit));
    }
    out += column.below(top + 16, fmt::format("measured ({})", series.unit));
    out += std::string("set format y ") + (after ? "''" : "'%g'") + "\n" + plot.text();
  }
  return out;
}

/// What is left without and with a finding, against its channel.
std::string finding_panel(const gp::Layout& layout, double top, const Diagnosis& d, std::size_t k) {
  const FindingTrace& trace = d.traces[k];
  const ComparedSeries& series = d.compared[trace.series];
  const Table rows = complete_rows({trace.channel.values, trace.without, trace.with});
  const std::string name = fmt::format("finding{}", k + 1);
  const gp::Range x = gp::bulk(rows[0]);
  const Table means = binned(rows, x);
  const double size = dot_width / 2 * (x.hi - x.lo);
  gp::Plot plot;
  plot.dots("$" + name, 1, 2, size, colour::orange, "without it", 1);
  plot.dots("$" + name, 1, 3, size, colour::sky, "with it", 1);
  plot.curve("$means" + name + " using 1:2", gp::line(colour::vermilion, 1, 2), "means without it");
  plot.curve("$means" + name + " using 1:3", gp::line(colour::blue, 2, 2), "means with it");
  std::string out =
      thinned_block(name, rows) + gp::data_block("means" + name, {means[0], means[1], means[2]});
  out +=
      gp::set_range("x", x) + gp::set_range("y", gp::joint(gp::bulk(rows[1]), gp::bulk(rows[2])));
  out += "set xtics autofreq\n" + std::string(gp::zero_line) +
         "set format x '%g'\nset format y '%g'\n";
  out += layout.panel(top + 2, top + 11.5);
  out += layout.title(top, d.findings[k].title);
  out += layout.above(top + 1.1, fmt::format("measured less predicted ({})", series.unit));
  out += layout.below(top + 14, fmt::format("{} ({})", trace.channel.name, trace.channel.unit));
  out += layout.legend(top + 15.2, 2, plot.legend());
  return out + plot.text();
}

/// One origin of the error.
struct Origin {
  std::string words;
  double percent = 0;
  std::string_view colour;
};

/// Findings in the order of the chain, then what has no name.
std::vector<Origin> origins(const Diagnosis& d) {
  constexpr std::array<std::string_view, 5> chain{"supply", "tether", "converter", "motors",
                                                  "airframe"};
  constexpr std::array colours{colour::purple, colour::vermilion, colour::orange, colour::blue,
                               colour::green};
  std::vector<Origin> out;
  for (std::size_t s = 0; s < chain.size(); ++s) {
    for (std::size_t k = 0; k < d.findings.size() && k < d.budget.findings.size(); ++k) {
      if (d.findings[k].stage != chain[s]) continue;
      out.push_back(
          {d.findings[k].stage + ": " + d.findings[k].effect, d.budget.findings[k], colours[s]});
    }
  }
  out.push_back({"unexplained", d.budget.unexplained, colour::black});
  out.push_back({"noise", d.budget.noise, colour::grey});
  return out;
}

constexpr double lines_of_a_bar = 2.2;

/// Horizontal bars, each below its words.
std::string budget_panel(const gp::Layout& layout, double top, const Diagnosis& d) {
  const std::vector<Origin> bars = origins(d);
  const double bottom = top + 1.2 + lines_of_a_bar * double(bars.size());
  std::string out = layout.panel(top + 1.2, bottom) + layout.legend(0, 1, {});
  out += layout.title(top, "Origins of the squared error before, by stage");
  out += layout.below(bottom + 2.4, "share (%)");
  out += gp::set_range("x", {0, 100}) + gp::set_range("y", {-double(bars.size()), 0});
  out += "unset ytics\nset xtics autofreq\nunset xzeroaxis\nset border 1\n";
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const double y = -double(i);
    const double percent = std::clamp(bars[i].percent, 0.0, 100.0);
    out += fmt::format(
        "set object {} rectangle from 0,{} to {},{} fc rgb '{}' fillstyle solid 0.8 noborder\n"
        "set label {} {} at 0,{} left\nset label {} '{} %' at 100,{} right\n",
        i + 1, gp::number(y - 0.9), gp::number(percent), gp::number(y - 0.58), bars[i].colour,
        2 * i + 1, gnuplot_text(bars[i].words, 45), gp::number(y - 0.3), 2 * i + 2,
        fixed(bars[i].percent, 1), gp::number(y - 0.3));
  }
  return out + "plot NaN\n";
}

/// One line an effect, in the order of the five verdicts.
std::vector<std::string> verdicts(const Diagnosis& d) {
  std::vector<std::string> out;
  const auto tell = [&out](const std::string& effect, std::size_t flight,
                           const std::string& verdict) {
    const std::string where = flight == 0 ? "" : fmt::format(" (flight {})", flight);
    out.push_back(effect + where + ": " + verdict);
  };
  for (const Finding& f : d.findings) {
    tell(f.effect, f.flight,
         fmt::format("found, {} ± {} %", fixed(f.gain_percent, 1), fixed(f.gain_se_percent, 1)));
    for (const std::string& rival : f.indistinguishable_from) {
      tell(rival, 0, "would explain as well as " + f.effect);
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

constexpr double lines_of_a_verdict = 1.1;

std::string verdict_panel(const gp::Layout& layout, double top,
                          const std::vector<std::string>& lines) {
  const auto count = double(lines.size());
  std::string out = layout.panel(top + 1, top + 1 + lines_of_a_verdict * count);
  out += layout.legend(0, 1, {}) + layout.title(top, "Verdicts");
  out += gp::set_range("x", {0, 1}) + gp::set_range("y", {-count, 0});
  out += "unset xtics\nunset border\n";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    out += fmt::format("set label {} {} at 0,{} left\n", 5000 + i, gnuplot_text(lines[i], 54),
                       gp::number(-double(i) - 0.5));
  }
  return out + "plot NaN\n";
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
                                                        : diagnosis.notes.back());
  }
  const double budget_lines = 5 + lines_of_a_bar * double(origins(diagnosis).size());
  const std::vector<std::string> told = verdicts(diagnosis);
  const double lines = 2.6 + compared_lines * double(diagnosis.compared.size()) +
                       finding_lines * double(diagnosis.traces.size()) + budget_lines + 2 +
                       lines_of_a_verdict * double(told.size());
  Figure figure{.id = "diagnosis",
                .title = "Diagnosis of " + name,
                .description = description_of(name, diagnosis),
                .lines = int(std::ceil(lines)),
                .script = gp::prelude() + "set samples 2\nset multiplot\n"};
  const gp::Layout layout(figure.lines, 0.115);
  double top = 2.6;
  for (std::size_t k = 0; k < diagnosis.compared.size(); ++k) {
    figure.script += compared_panels(layout, top, diagnosis, k, name);
    top += compared_lines;
  }
  for (std::size_t k = 0; k < diagnosis.traces.size(); ++k) {
    figure.script += finding_panel(layout, top, diagnosis, k);
    top += finding_lines;
  }
  const gp::Layout bars(figure.lines, 0.01);
  figure.script += budget_panel(bars, top, diagnosis);
  figure.script += verdict_panel(bars, top + budget_lines, told) + "unset multiplot\n";
  return figure;
}

}  // namespace tethercalc
