#include "tethercalc/report/sweep_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "io/checked_values.hpp"
#include "io/closest_name.hpp"
#include "io/csv.hpp"
#include "model/constants.hpp"
#include "report/figure_data.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc {
namespace {

// More would scroll the first, which is usually the cause, off the screen.
constexpr std::size_t most_problems = 20;

class Reader {
 public:
  Reader(std::string_view text, const std::string& file, const std::string& value)
      : rows_(text, file), problems_(most_problems, file) {
    table_.file = file;
    table_.value_column = value.empty() ? "forward.total_power_W" : value;
  }

  SweepTable read() {
    if (!rows_.next(table_.columns)) throw InputError(table_.file, "is empty");
    header();
    std::vector<std::string> cells;
    while (rows_.next(cells)) row(cells);
    problems_.throw_if_any();
    if (table_.value.empty()) throw InputError(table_.file, "has a header and no rows");
    return std::move(table_);
  }

 private:
  void header() {
    const auto& names = table_.columns;
    const auto status = std::ranges::find(names, "status");
    if (status == names.end()) {
      throw InputError(rows_.where(),
                       "is no header of a sweep: it has no column \"status\". A later part of a "
                       "sweep in parts (--shard) has no header; join the parts first");
    }
    if (status == names.begin()) {
      throw InputError(rows_.where(), "has no column of a varied field before \"status\"");
    }
    for (auto name = names.begin(); name != status; ++name)
      table_.varied.push_back({*name, {}, {}});
    const auto value = std::ranges::find(names, table_.value_column);
    if (value == names.end()) {
      throw InputError("--value",
                       fmt::format("\"{}\" is no column of {}{}", table_.value_column, table_.file,
                                   did_you_mean(table_.value_column, names)));
    }
    value_ = std::size_t(value - names.begin());
  }

  /// The number that a cell is; nothing, with a problem unless it is empty, where it is none.
  std::optional<double> number(const std::string& column, const std::string& cell, bool required) {
    const std::optional<double> value = parsed_number(cell);
    if (!value && (required || !cell.empty())) {
      problems_.add(rows_.where(),
                    fmt::format("{}: \"{}\" is no number", column, cell.substr(0, 40)));
    }
    return value;
  }

  void row(const std::vector<std::string>& cells) {
    if (cells.size() != table_.columns.size()) {
      return problems_.add(rows_.where(), fmt::format("has {} cells, the header has {}",
                                                      cells.size(), table_.columns.size()));
    }
    for (std::size_t c = 0; c < table_.varied.size(); ++c) varied_cell(table_.varied[c], cells[c]);
    const auto value = number(table_.value_column, cells[value_], false);
    if (!value) ++table_.infeasible;
    table_.value.push_back(value.value_or(nan));
  }

  void varied_cell(SweepColumn& column, const std::string& cell) {
    bool numbers = column.names.empty();
    if (column.values.empty()) {
      // Of fields that only sweeps know the first row tells.
      const SpecField* field = find_field(column.path);
      numbers = field != nullptr ? is_numeric(*field) : parsed_number(cell).has_value();
    }
    if (numbers) {
      return column.values.push_back(number(column.path, cell, true).value_or(0));
    }
    const auto known = std::ranges::find(column.names, cell);
    column.values.push_back(double(known - column.names.begin()));
    if (known == column.names.end()) column.names.push_back(cell);
  }

  CsvRows rows_;
  SweepTable table_;
  std::size_t value_ = 0;
  Problems problems_;
};

/// The ending of a name that says its unit, and the unit; empty where it has none.
std::pair<std::string_view, const char*> unit_ending(std::string_view name) {
  // The longest ending first: "_m_s" before "_s".
  constexpr std::array<std::pair<std::string_view, const char*>, 28> units{
      {{"_ohm_mm2_per_m", "Ω mm²/m"},
       {"_ohm_mm2_m", "Ω·mm²/m"},
       {"_1_K", "1/K"},
       {"_per_K", "1/K"},
       {"_kg_m3", "kg/m³"},
       {"_g_cm3", "g/cm³"},
       {"_kg_per_kW", "kg/kW"},
       {"_g_per_W", "g/W"},
       {"_W_mK", "W/(m·K)"},
       {"_W_m2", "W/m²"},
       {"_kV_mm", "kV/mm"},
       {"_m_s2", "m/s²"},
       {"_m_s", "m/s"},
       {"_mm2", "mm²"},
       {"_m2", "m²"},
       {"_mm", "mm"},
       {"_MPa", "MPa"},
       {"_ohm", "Ω"},
       {"_percent", "%"},
       {"_deg", "°"},
       {"_in", "in"},
       {"_N", "N"},
       {"_W", "W"},
       {"_V", "V"},
       {"_A", "A"},
       {"_C", "°C"},
       {"_m", "m"},
       {"_g", "g"}}};
  for (const auto& unit : units) {
    if (name.ends_with(unit.first)) return unit;
  }
  return {"", ""};
}

constexpr std::size_t most_curves = 7;
constexpr std::size_t most_cells = 40000;

std::vector<const SweepColumn*> varying(const SweepTable& table) {
  std::vector<const SweepColumn*> out;
  for (const SweepColumn& column : table.varied) {
    if (column.distinct().size() > 1) out.push_back(&column);
  }
  if (out.empty()) {
    throw InputError(table.file, "has nothing to draw over: no field has two values");
  }
  // Numbers first, so that they become the axes.
  std::stable_partition(out.begin(), out.end(),
                        [](const SweepColumn* column) { return column->names.empty(); });
  return out;
}

const SweepColumn* wanted(const SweepTable& table, const std::string& option,
                          const std::string& path) {
  std::vector<std::string> names;
  for (const SweepColumn& column : table.varied) {
    if (column.path == path) return &column;
    names.push_back(column.path);
  }
  throw InputError(option, fmt::format("\"{}\" is no field that {} varies{}", path, table.file,
                                       did_you_mean(path, names)));
}

/// The fields along the axes; `y` is null where the value itself stands there.
struct Axes {
  const SweepColumn* x = nullptr;
  const SweepColumn* y = nullptr;
};

Axes axes_of(const SweepTable& table, const SweepView& view) {
  const std::vector<const SweepColumn*> columns = varying(table);
  Axes axes;
  if (!view.x.empty()) axes.x = wanted(table, "--x", view.x);
  if (!view.y.empty()) axes.y = wanted(table, "--y", view.y);
  if (axes.x != nullptr && axes.x == axes.y) {
    throw InputError("--y", fmt::format("\"{}\" stands along the other axis already", view.y));
  }
  for (const SweepColumn* column : columns) {
    if (column == axes.x || column == axes.y) continue;
    if (axes.x == nullptr) {
      axes.x = column;
    } else if (axes.y == nullptr) {
      axes.y = column;
    }
  }
  if (axes.x == nullptr) throw InputError("--y", "takes the only field that varies; use --x");
  return axes;
}

/// "least over supply.voltage_V": the fields that stand on no axis.
std::string others_words(const SweepTable& table, const Axes& axes) {
  std::string out;
  for (const SweepColumn* column : varying(table)) {
    if (column == axes.x || column == axes.y) continue;
    out += (out.empty() ? "least over " : ", ") + column->path;
  }
  return out;
}

/// The least value at every place.
struct Outcome {
  double x = 0;
  double y = 0;
  double value = nan;
};

std::vector<Outcome> outcomes_of(const SweepTable& table, const Axes& axes) {
  std::map<std::pair<double, double>, double> least;  // by y, then x
  for (std::size_t i = 0; i < table.value.size(); ++i) {
    const double y = axes.y == nullptr ? 0 : axes.y->values[i];
    double& value = least.emplace(std::pair{y, axes.x->values[i]}, nan).first->second;
    value = std::fmin(value, table.value[i]);  // of a number and NaN, the number
  }
  std::vector<Outcome> out;
  for (const auto& [place, value] : least) out.push_back({place.second, place.first, value});
  return out;
}

const Outcome* least_of(const std::vector<Outcome>& outcomes) {
  const Outcome* least = nullptr;
  for (const Outcome& one : outcomes) {
    if (std::isfinite(one.value) && (least == nullptr || one.value < least->value)) least = &one;
  }
  return least;
}

/// A value of a field for people; a name's number on the axis counts from 1.
std::string value_words(const SweepColumn& column, double value) {
  return column.names.empty() ? fmt::format("{:.4g}", value) : column.names[std::size_t(value)];
}

std::string least_words(const Axes& axes, const Outcome& least) {
  std::string out = significant(least.value, 4) + " at " + value_words(*axes.x, least.x);
  if (axes.y != nullptr) out += ", " + value_words(*axes.y, least.y);
  return out;
}

/// The edges of every value's cell along an axis: halfway to its neighbours.
struct Edges {
  std::vector<double> values;
  std::vector<double> edges;  ///< one more

  explicit Edges(const SweepColumn& column) : values(column.distinct()) {
    for (std::size_t i = 0; i + 1 < values.size(); ++i) {
      edges.push_back((values[i] + values[i + 1]) / 2);
    }
    const double first = values.size() > 1 ? values[1] - values[0] : 1;
    const double last = values.size() > 1 ? values.back() - values[values.size() - 2] : 1;
    edges.insert(edges.begin(), values.front() - first / 2);
    edges.push_back(values.back() + last / 2);
  }

  [[nodiscard]] plot::Range range() const { return {edges.front(), edges.back()}; }
  /// The cell of a value.
  [[nodiscard]] plot::Range around(double value) const {
    const auto at = std::lower_bound(values.begin(), values.end(), value) - values.begin();
    return {edges[std::size_t(at)], edges[std::size_t(at) + 1]};
  }
};

/// The axis of a field: names stand as numbers from 1, numbers as themselves.
plot::Axis axis_over(const SweepColumn& column, plot::Range range) {
  plot::Axis axis{.label = axis_label(column.path), .range = range};
  for (std::size_t i = 0; i < column.names.size(); ++i) {
    axis.ticks.push_back({double(i), std::to_string(i + 1)});
  }
  return axis;
}

/// What the numbers along an axis of names stand for.
void explain_names(plot::Panel& panel, const SweepColumn& column) {
  for (std::size_t i = 0; i < column.names.size(); ++i) {
    panel.key.push_back(fmt::format("{} {}: {}", axis_label(column.path), i + 1, column.names[i]));
  }
}

std::string subtitle(const SweepTable& table, const Axes& axes) {
  const std::string others = others_words(table, axes);
  return axis_label(table.value_column) + (others.empty() ? "" : ", " + others);
}

std::string description_of(const SweepTable& table, const Axes& axes,
                           const std::vector<Outcome>& outcomes) {
  std::string out =
      fmt::format("{} over {}", axis_label(table.value_column), axis_label(axes.x->path));
  if (axes.y != nullptr) out += fmt::format(" and {}", axis_label(axes.y->path));
  const std::string others = others_words(table, axes);
  if (!others.empty()) out += ", " + others;
  out += fmt::format(", from {} rows", table.value.size());
  if (const Outcome* least = least_of(outcomes)) {
    out += fmt::format("; least {}", least_words(axes, *least));
  }
  if (table.infeasible > 0) out += fmt::format("; {} rows have no value", table.infeasible);
  return out + ".";
}

plot::Points least_mark(const Axes& axes, const Outcome& least, double y) {
  return {.x = {least.x},
          .y = {y},
          .mark = plot::Mark::diamond,
          .colour = plot::Colour::vermilion,
          .words = "least: " + least_words(axes, least)};
}

/// Curves over x: one, or one a name of y.
plot::Panel curves_panel(const SweepTable& table, const Axes& axes,
                         const std::vector<Outcome>& outcomes) {
  const plot::Range places = plot::extent(plot::column(outcomes, &Outcome::x));
  const plot::Range values = plot::extent(plot::column(outcomes, &Outcome::value));
  plot::Panel panel{.x = axis_over(*axes.x, plot::with_margin(places, 0.03)),
                    .y = {.label = subtitle(table, axes), .range = plot::with_margin(values, 0.06)},
                    .lines = 18.5};
  const std::size_t curves = axes.y == nullptr ? 1 : axes.y->names.size();
  for (std::size_t k = 0; k < curves; ++k) {
    std::vector<Outcome> own;
    for (const Outcome& one : outcomes) {
      if (axes.y == nullptr || one.y == double(k)) own.push_back(one);
    }
    const std::string words = axes.y == nullptr ? "" : axes.y->names[k];
    const bool names = !axes.x->names.empty();  // there is nothing between two of them
    plot::Points points{.x = plot::column(own, &Outcome::x),
                        .y = plot::column(own, &Outcome::value),
                        .mark = plot::Mark::dot,
                        .colour = plot::curve_colour(k),
                        .words = names ? words : "",
                        .sizes = std::vector<double>(own.size(), 0.7)};
    if (!names) {
      panel.layers.push_back(plot::Curve{.x = points.x,
                                         .y = points.y,
                                         .colour = points.colour,
                                         .dash = plot::curve_dash(k),
                                         .width = 1.5,
                                         .words = words});
    }
    constexpr std::size_t most_marked = 40;
    if (names || own.size() <= most_marked) panel.layers.push_back(std::move(points));
  }
  const Outcome& least = *least_of(outcomes);
  panel.layers.push_back(least_mark(axes, least, least.value));
  explain_names(panel, *axes.x);
  return panel;
}

plot::Panel map_panel(const SweepTable& table, const Axes& axes,
                      const std::vector<Outcome>& outcomes) {
  if (outcomes.size() > most_cells) {
    throw InputError(table.file, fmt::format("makes a map of {} cells; at most {} can be drawn",
                                             outcomes.size(), most_cells));
  }
  const Edges x(*axes.x);
  const Edges y(*axes.y);
  plot::Range values = plot::extent(plot::column(outcomes, &Outcome::value));
  if (!(values.lo < values.hi)) values = plot::with_margin(values);
  plot::Panel panel{.x = axis_over(*axes.x, x.range()),
                    .y = axis_over(*axes.y, y.range()),
                    .lines = 18.5,
                    .scale = plot::ColourScale{.label = subtitle(table, axes), .range = values}};
  // The places of a sample do not fill their grid well enough to be cells of it.
  const bool grid = 2 * outcomes.size() >= x.values.size() * y.values.size();
  if (grid) {
    plot::Cells cells{.words_of_grey = table.infeasible > 0 ? "infeasible" : ""};
    for (const Outcome& one : outcomes) {
      cells.cells.push_back({x.around(one.x), y.around(one.y), one.value});
    }
    panel.layers.push_back(std::move(cells));
  } else {
    panel.layers.push_back(plot::Points{.x = plot::column(outcomes, &Outcome::x),
                                        .y = plot::column(outcomes, &Outcome::y),
                                        .values = plot::column(outcomes, &Outcome::value)});
  }
  const Outcome& least = *least_of(outcomes);
  panel.layers.push_back(least_mark(axes, least, least.y));
  explain_names(panel, *axes.x);
  explain_names(panel, *axes.y);
  return panel;
}

}  // namespace

std::vector<double> SweepColumn::distinct() const {
  std::vector<double> out = values;
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

SweepTable parse_sweep_csv(std::string_view text, const std::string& file,
                           const std::string& value) {
  return Reader(text, file, value).read();
}

std::string unit_of(std::string_view name) {
  if (const SpecField* field = find_field(name)) return std::string(field->unit);
  return unit_ending(name).second;
}

std::string axis_label(std::string_view name) {
  const std::string unit = unit_of(name);
  if (!unit.empty()) name.remove_suffix(unit_ending(name).first.size());
  std::string out(name);
  std::ranges::replace_if(
      out, [](char c) { return c == '.' || c == '_'; }, ' ');
  return unit.empty() ? out : fmt::format("{} ({})", out, unit);
}

Figure sweep_figure(const SweepTable& table, const SweepView& view) {
  const Axes axes = axes_of(table, view);
  const std::vector<Outcome> outcomes = outcomes_of(table, axes);
  if (least_of(outcomes) == nullptr) {
    throw InputError(table.file, fmt::format("has no row with a value of {}", table.value_column));
  }
  const bool curves = axes.y == nullptr || (axes.x->names.empty() && !axes.y->names.empty() &&
                                            axes.y->names.size() <= most_curves);
  return {
      .id = "sweep",
      .title = view.title.empty() ? table.file : view.title,
      .description = description_of(table, axes, outcomes),
      .parts = {curves ? curves_panel(table, axes, outcomes) : map_panel(table, axes, outcomes)}};
}

}  // namespace tethercalc
