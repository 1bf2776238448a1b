#include "tethercalc/report/sweep_figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "io/checked_values.hpp"
#include "io/closest_name.hpp"
#include "io/csv.hpp"
#include "model/constants.hpp"
#include "report/gnuplot_script.hpp"
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

/// Viridis of matplotlib (van der Walt and Smith 2015, public domain): evenly rising lightness,
/// read alike with every kind of colour vision and in print without colour.
constexpr const char* palette =
    "set palette defined (0 '#440154', 1 '#482878', 2 '#3e4a89', 3 '#31688e', 4 '#26828e', "
    "5 '#1f9e89', 6 '#35b779', 7 '#6ece58', 8 '#b5de2b', 9 '#fde725') maxcolors 64\n";

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
struct Cell {
  double x = 0;
  double y = 0;
  double value = nan;
};

std::vector<Cell> cells_of(const SweepTable& table, const Axes& axes) {
  std::map<std::pair<double, double>, double> least;  // by y, then x
  for (std::size_t i = 0; i < table.value.size(); ++i) {
    const double y = axes.y == nullptr ? 0 : axes.y->values[i];
    double& value = least.emplace(std::pair{y, axes.x->values[i]}, nan).first->second;
    value = std::fmin(value, table.value[i]);  // of a number and NaN, the number
  }
  std::vector<Cell> out;
  for (const auto& [place, value] : least) out.push_back({place.second, place.first, value});
  return out;
}

const Cell* least_of(const std::vector<Cell>& cells) {
  const Cell* least = nullptr;
  for (const Cell& cell : cells) {
    if (std::isfinite(cell.value) && (least == nullptr || cell.value < least->value)) least = &cell;
  }
  return least;
}

/// A value of a field for people; a name's number on the axis counts from 1.
std::string value_words(const SweepColumn& column, double value) {
  return column.names.empty() ? fmt::format("{:.4g}", value) : column.names[std::size_t(value)];
}

std::string least_words(const Axes& axes, const Cell& least) {
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

  [[nodiscard]] gp::Range range() const { return {edges.front(), edges.back()}; }
  [[nodiscard]] std::size_t index(double value) const {
    return std::size_t(std::lower_bound(values.begin(), values.end(), value) - values.begin());
  }
};

/// Ticks at names, numbered from 1; numbers get gnuplot's own.
std::string tics(std::string_view axis, const SweepColumn& column) {
  if (column.names.empty()) return fmt::format("set {}tics autofreq\n", axis);
  std::string list;
  for (std::size_t i = 0; i < column.names.size(); ++i) {
    list += fmt::format("{}'{}' {}", i == 0 ? "" : ", ", i + 1, i);
  }
  return fmt::format("set {}tics ({})\n", axis, list);
}

/// Explains in the legend what the numbers along an axis of names stand for.
void explain_names(gp::Plot& plot, const SweepColumn& column) {
  for (std::size_t i = 0; i < column.names.size(); ++i) {
    plot.entry({gp::LegendEntry::Sample::none, "",
                fmt::format("{} {}: {}", axis_label(column.path), i + 1, column.names[i])});
  }
}

std::string subtitle(const SweepTable& table, const Axes& axes) {
  const std::string others = others_words(table, axes);
  return axis_label(table.value_column) + (others.empty() ? "" : ", " + others);
}

std::string description_of(const SweepTable& table, const Axes& axes,
                           const std::vector<Cell>& cells) {
  std::string out =
      fmt::format("{} over {}", axis_label(table.value_column), axis_label(axes.x->path));
  if (axes.y != nullptr) out += fmt::format(" and {}", axis_label(axes.y->path));
  const std::string others = others_words(table, axes);
  if (!others.empty()) out += ", " + others;
  out += fmt::format(", from {} rows", table.value.size());
  if (const Cell* least = least_of(cells)) {
    out += fmt::format("; least {}", least_words(axes, *least));
  }
  if (table.infeasible > 0) out += fmt::format("; {} rows have no value", table.infeasible);
  return out + ".";
}

/// Curves over x: one, or one a name of y.
Figure curves_figure(const SweepTable& table, const Axes& axes, const std::vector<Cell>& cells,
                     Figure figure) {
  gp::Plot plot;
  figure.script = gp::prelude();
  const std::size_t curves = axes.y == nullptr ? 1 : axes.y->names.size();
  for (std::size_t k = 0; k < curves; ++k) {
    std::vector<Cell> own;
    for (const Cell& cell : cells) {
      if (axes.y == nullptr || cell.y == double(k)) own.push_back(cell);
    }
    const std::string name = fmt::format("curve{}", k + 1);
    figure.script += gp::data_block(name, own, {&Cell::x, &Cell::value});
    const std::string data = fmt::format("${} using 1:2", name);
    const std::string words = axes.y == nullptr ? "" : axes.y->names[k];
    const std::string dots = gp::point(gp::curve_colour(k), 7, 0.4);
    constexpr std::size_t most_marked = 40;
    if (!axes.x->names.empty()) {
      plot.points(data, dots, words);  // there is nothing between two names
    } else {
      plot.curve(data, gp::curve_line(k, 1.5), words);
      if (own.size() <= most_marked) plot.points(data, dots);
    }
  }
  if (const Cell* least = least_of(cells)) {
    plot.mark(least->x, least->value, gp::point(colour::black, 12, 1),
              "least: " + least_words(axes, *least));
  }
  explain_names(plot, *axes.x);
  figure.lines = 29 + int(plot.legend().size());
  const gp::Layout layout(figure.lines, 0.125, 0.045);
  const gp::Range values = gp::extent(gp::column(cells, &Cell::value));
  const gp::Range places = gp::extent(gp::column(cells, &Cell::x));
  figure.script += "set samples 2\n" + layout.panel(3.6, 22) + layout.heading(figure.title) +
                   layout.above(2.7, subtitle(table, axes)) +
                   layout.below(25, axis_label(axes.x->path)) +
                   layout.legend(27, 1, plot.legend()) + tics("x", *axes.x) +
                   gp::set_range("x", gp::with_margin(places, 0.03)) +
                   gp::set_range("y", gp::with_margin(values, 0.06)) + plot.text();
  return figure;
}

/// A digit for every place, 0 for the least tenth of the range, where characters are all there is.
std::string digits(gp::Range range) {
  return fmt::format(
      "plot $cells using 1:2:($7 == $7 ? sprintf('%d', int(9.999*($7 - {0})/{1})) : '.') "
      "with labels\n",
      gp::number(range.lo), gp::number(std::max(range.hi - range.lo, 1e-300)));
}

Figure map_figure(const SweepTable& table, const Axes& axes, const std::vector<Cell>& cells,
                  Figure figure) {
  if (cells.size() > most_cells) {
    throw InputError(table.file, fmt::format("makes a map of {} cells; at most {} can be drawn",
                                             cells.size(), most_cells));
  }
  const Edges x(*axes.x);
  const Edges y(*axes.y);
  // The places of a sample do not fill their grid well enough to be cells of it.
  const bool grid = 2 * cells.size() >= x.values.size() * y.values.size();
  figure.script = gp::prelude() + "$cells << EOD\n";
  for (const Cell& cell : cells) {
    const std::size_t column = x.index(cell.x);
    const std::size_t row = y.index(cell.y);
    for (const double number :
         {cell.x, cell.y, x.edges[column], x.edges[column + 1], y.edges[row], y.edges[row + 1]}) {
      figure.script += gp::number(number) + " ";
    }
    figure.script += gp::number(cell.value) + "\n";
  }
  figure.script += "EOD\n";

  gp::Plot plot;
  plot.add(grid ? "$cells using 1:2:3:4:5:6:7 with boxxyerror fillstyle solid noborder lc palette"
                : "$cells using 1:2:7 with points pt 7 ps 0.5*dot_scale lc palette");
  const Cell* const least = least_of(cells);
  if (least != nullptr) {
    plot.mark(least->x, least->y, "lc rgb '#ffffff' pt 7 ps 1.2*dot_scale");
    plot.mark(least->x, least->y, gp::point(colour::vermilion, 7, 0.8),
              "least: " + least_words(axes, *least));
  }
  const std::string blank = gp::area("#cccccc", 1);
  if (table.infeasible > 0 && grid) {
    plot.entry({gp::LegendEntry::Sample::area, blank, "infeasible"});
  }
  explain_names(plot, *axes.x);
  explain_names(plot, *axes.y);

  figure.lines = 34 + int(plot.legend().size());
  const gp::Layout layout(figure.lines, 0.125, 0.045);
  const gp::Range values = gp::extent(gp::column(cells, &Cell::value));
  figure.script += "set samples 2\n" + layout.panel(3.6, 22) + layout.heading(figure.title) +
                   layout.above(2.7, axis_label(axes.y->path)) +
                   layout.below(25, axis_label(axes.x->path)) +
                   layout.title(27, subtitle(table, axes)) + layout.legend(32, 1, plot.legend()) +
                   layout.colour_box(28, 29) +
                   layout.note_for_characters(
                       28.2, fmt::format("0 begins at {}, 9 ends at {}", significant(values.lo, 4),
                                         significant(values.hi, 4))) +
                   palette + tics("x", *axes.x) + tics("y", *axes.y) + "set tics front\n" +
                   gp::set_range("x", x.range()) + gp::set_range("y", y.range()) +
                   gp::set_range("cb", values) + gp::set_tics("cb", values, 5);
  if (grid) {
    figure.script += fmt::format(
        "if (!characters) {{\n  set object 1 rectangle from graph 0,0 to "
        "graph 1,1 behind {}\n}}\n",
        blank);
  }
  figure.script += "if (characters) {\n  unset colorbox\n  " + digits(values) + "} else {\n  " +
                   plot.text() + "}\n";
  return figure;
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
  const std::vector<Cell> cells = cells_of(table, axes);
  if (least_of(cells) == nullptr) {
    throw InputError(table.file, fmt::format("has no row with a value of {}", table.value_column));
  }
  Figure figure{.id = "sweep",
                .title = view.title.empty() ? table.file : view.title,
                .description = description_of(table, axes, cells)};
  const bool curves = axes.y == nullptr || (axes.x->names.empty() && !axes.y->names.empty() &&
                                            axes.y->names.size() <= most_curves);
  return curves ? curves_figure(table, axes, cells, std::move(figure))
                : map_figure(table, axes, cells, std::move(figure));
}

}  // namespace tethercalc
