#include "tethercalc/io/motor_bench.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "io/bench_header.hpp"
#include "io/closest_name.hpp"
#include "io/column_choice.hpp"
#include "io/csv.hpp"
#include "io/letters.hpp"
#include "io/motor_points.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_header_lines = 20;  // title, date and remarks above a header
constexpr std::size_t most_problems = 20;      // as for other CSV

/// What a message can show of a cell: short, UTF-8, nothing that would disturb a terminal.
std::string shown_cell(const std::string& cell) {
  std::string text = cell.substr(0, 40);
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  return as_utf8(cell.size() > 40 ? text + "…" : text);
}

std::string quoted(const std::string& cell) { return "\"" + shown_cell(cell) + "\""; }

std::vector<std::string> all_shown(const std::vector<std::string>& cells) {
  std::vector<std::string> out;
  for (const std::string& cell : cells) out.push_back(shown_cell(cell));
  return out;
}

/// The text with its comment lines emptied, so that lines keep their numbers.
std::string without_comments(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    const std::string_view content = line.substr(std::min(line.find_first_not_of(" \t"), end));
    if (!content.starts_with('#') && !content.starts_with("//")) out += line;
    if (end < text.size()) out += '\n';
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

struct Row {
  std::size_t line = 0;
  std::vector<std::string> cells;  ///< trimmed
};

/// All rows that hold anything.
std::vector<Row> rows_of(std::string_view text, const std::string& file, char separator) {
  std::vector<Row> rows;
  CsvRows csv(text, file, separator);
  std::vector<std::string> cells;
  while (csv.next(cells)) {
    for (std::string& cell : cells) cell = std::string(trimmed(cell));
    const auto holds = [](const std::string& cell) { return !cell.empty(); };
    if (std::ranges::any_of(cells, holds)) rows.push_back({csv.line(), cells});
  }
  return rows;
}

/// A --columns: what a column of this header holds.
struct NamedColumn {
  BenchColumnMeaning meaning;
  ColumnChoice choice;
};

std::vector<NamedColumn> named_columns(const std::vector<std::string>& given, Problems& problems) {
  std::vector<NamedColumn> out;
  for (const std::string& text : given) {
    auto choice = column_choice(text);
    const auto meaning = choice ? bench_column_meaning(choice->quantity) : std::nullopt;
    if (!meaning) {
      problems.add(
          "--columns",
          fmt::format("{} does not say what a column holds; allowed is QUANTITY=HEADER with "
                      "a quantity and its unit, such as thrust_g, thrust_N, thrust_lbf, "
                      "power_W, efficiency_g_per_W, voltage_V, current_A, throttle_percent",
                      quoted(text)));
      continue;
    }
    out.push_back({*meaning, std::move(*choice)});
  }
  return out;
}

/// Where a table holds what.
struct Columns {
  std::map<BenchQuantity, std::pair<std::size_t, double>> found;  ///< index and factor
  ThrottleUnit throttle_unit = ThrottleUnit::unknown;
  std::vector<std::string> problems;
  std::vector<std::string> notes;

  [[nodiscard]] bool has(BenchQuantity quantity) const { return found.count(quantity) > 0; }
  [[nodiscard]] bool gives_power() const {
    return has(BenchQuantity::power) || has(BenchQuantity::efficiency) ||
           (has(BenchQuantity::voltage) && has(BenchQuantity::current));
  }
};

Columns columns_of(const std::vector<std::string>& header, const std::vector<NamedColumn>& named) {
  Columns out;
  std::map<BenchQuantity, bool> by_name;  // a name that was given outranks what is understood
  for (const NamedColumn& column : named) {
    const auto at = chosen_column(column.choice, header);
    if (!at) continue;
    out.found[column.meaning.quantity] = {at->index, at->sign * column.meaning.factor};
    if (column.meaning.quantity == BenchQuantity::throttle) {
      out.throttle_unit = column.meaning.throttle_unit;
    }
    by_name[column.meaning.quantity] = true;
  }
  for (std::size_t i = 0; i < header.size(); ++i) {
    const auto meaning = bench_column_meaning(header[i]);
    if (!meaning || by_name[meaning->quantity]) continue;
    const auto [before, is_new] = out.found.try_emplace(meaning->quantity, i, meaning->factor);
    if (meaning->quantity == BenchQuantity::throttle) {
      if (is_new) out.throttle_unit = meaning->throttle_unit;
      continue;
    }
    if (is_new) continue;
    const std::string& first = header[before->second.first];
    if (before->second.second == meaning->factor) {
      out.problems.push_back(
          fmt::format("the columns {} and {} may both be {}; name one: --columns {}=\"…\"",
                      quoted(first), quoted(header[i]), bench_quantity_name(meaning->quantity),
                      bench_quantity_name(meaning->quantity)));
    }  // the same quantity in another unit says nothing new
  }
  return out;
}

/// A table, its header understood.
struct Table {
  std::string file;
  std::vector<std::string> header;
  std::size_t header_line = 1;
  Columns columns;
  std::vector<Row> rows;  ///< below the header
};

/// The table read with the separator and the header line that are understood best.
std::optional<Table> table_of(const LoadedText& input, const std::vector<NamedColumn>& named,
                              Problems& problems) {
  if (input.text.find('\0') != std::string::npos) {
    return problems.refuse(input.name, "is no text in UTF-8; save the table as CSV, UTF-8");
  }
  const std::string text = without_comments(input.text);
  std::optional<Table> best;
  std::size_t most = 0;
  std::optional<InputError> broken;
  for (const char separator : {',', ';', '\t'}) {
    std::vector<Row> rows;
    try {
      rows = rows_of(text, input.name, separator);
    } catch (const InputError& error) {
      if (!broken) broken = error;
      continue;
    }
    for (std::size_t i = 0; i < std::min(rows.size(), most_header_lines); ++i) {
      Columns columns = columns_of(rows[i].cells, named);
      const std::size_t score = 100 * columns.found.size() + (i == 0 ? rows[i].cells.size() : 0);
      if (best && score <= most) continue;
      most = score;
      best = Table{input.name,
                   rows[i].cells,
                   rows[i].line,
                   std::move(columns),
                   {rows.begin() + std::ptrdiff_t(i) + 1, rows.end()}};
    }
  }
  // Read with another separator, a row of broken quotes is one cell.
  if (broken && (!best || best->columns.found.empty())) {
    problems.add(broken->problems());
    return std::nullopt;
  }
  if (!best) return problems.refuse(input.name + ":1", "there is no row in the table");
  return best;
}

/// Whether any row has two cells that are written as numbers.
bool holds_numbers(const Table& table) {
  const auto is_numeric = [](const std::string& cell) {
    return cell.find_first_of("0123456789") != std::string::npos &&
           cell.find_first_not_of("0123456789.,+-eE% ") == std::string::npos;
  };
  return std::ranges::any_of(table.rows, [&](const Row& row) {
    return std::ranges::count_if(row.cells, is_numeric) >= 2;
  });
}

/// What the header lacks or says twice.
bool header_will_do(const Table& table, const std::vector<NamedColumn>& named, Problems& problems) {
  const std::string where = fmt::format("{}:{}", table.file, table.header_line);
  const std::size_t before = problems.count();
  // What is no table may be a secret, and nothing of it is shown.
  if (!holds_numbers(table)) {
    problems.add(where, "is no table of a motor: no row below its first line has two numbers");
    return false;
  }
  const std::vector<std::string> shown = all_shown(table.header);
  for (const NamedColumn& column : named) {
    const std::string& name = column.choice.header;
    if (chosen_column(column.choice, table.header)) continue;
    problems.add(where, fmt::format("there is no column {}{}; found are {}", quoted(name),
                                    did_you_mean(name, shown), fmt::join(shown, " | ")));
  }
  for (const std::string& problem : table.columns.problems) problems.add(where, problem);
  std::string missing;
  if (!table.columns.has(BenchQuantity::thrust)) {
    problems.add(where,
                 "column \"thrust_g\" is missing: no column of the header is a thrust with "
                 "its unit (g, kgf, N, lbf, oz)");
    missing = "thrust_g";
  }
  if (!table.columns.gives_power()) {
    problems.add(where,
                 "column \"power_W\" is missing: the header has no electrical power (W, kW), "
                 "no efficiency (g/W), no voltage (V) with current (A)");
    missing += missing.empty() ? "power_W" : "=\"…\",power_W";
  }
  if (!missing.empty()) {
    problems.add(where, fmt::format("found are the columns {}; say which holds what with "
                                    "`tethercalc motor FILE --columns {}=\"…\"`",
                                    fmt::join(shown, " | "), missing));
  }
  return problems.count() == before;
}

/// Whether `cell` is `value`, as text or as number.
bool is_value(const std::string& cell, const std::string& value) {
  if (cell == value) return true;
  const auto number = parsed_number(cell);
  return number && number == parsed_number(value);
}

/// The different texts of a column, in their order, and how many more there are than `most`.
std::vector<std::string> values_of(const std::vector<Row>& rows, std::size_t column) {
  std::vector<std::string> values;
  for (const Row& row : rows) {
    if (column >= row.cells.size()) continue;
    if (std::ranges::find(values, row.cells[column]) == values.end()) {
      values.push_back(row.cells[column]);
    }
  }
  return values;
}

std::string listed(std::vector<std::string> values) {
  constexpr std::size_t most = 12;
  const std::size_t all = values.size();
  values = all_shown(values);
  if (all > most) values.resize(most);
  std::string text = fmt::format("\"{}\"", fmt::join(values, "\", \""));
  if (all > most) text += fmt::format(" and {} more", all - most);
  return text;
}

/// Keeps the rows that `--where` asks for.
void select_rows(Table& table, const std::vector<std::string>& where, Problems& problems) {
  for (const std::string& text : where) {
    const std::size_t equals = text.find('=');
    const std::string column(trimmed(std::string_view(text).substr(0, equals)));
    const auto at = std::ranges::find(table.header, column);
    if (equals == std::string::npos || at == table.header.end()) {
      const std::vector<std::string> shown = all_shown(table.header);
      problems.add("--where", fmt::format("{} names no column of {}; allowed is COLUMN=VALUE with "
                                          "one of {}{}",
                                          quoted(text), table.file, fmt::join(shown, " | "),
                                          did_you_mean(column, shown)));
      continue;
    }
    const auto index = static_cast<std::size_t>(at - table.header.begin());
    const std::string value(trimmed(std::string_view(text).substr(equals + 1)));
    const std::vector<std::string> values = values_of(table.rows, index);
    std::erase_if(table.rows, [&](const Row& row) {
      return index >= row.cells.size() || !is_value(row.cells[index], value);
    });
    if (table.rows.empty()) {
      problems.add("--where", fmt::format("no row of {} has {} in column {}; there are {}{}",
                                          table.file, quoted(value), quoted(column), listed(values),
                                          did_you_mean(value, values)));
      return;
    }
  }
}

/// A curve is of one motor with one propeller at one supply.
void refuse_several(const Table& table, Problems& problems) {
  constexpr std::array<std::string_view, 7> identities{
      "motor", "propeller", "prop", "model", "motor type", "supply nominal", "nominal voltage"};
  for (std::size_t i = 0; i < table.header.size(); ++i) {
    if (std::ranges::find(identities, bench_column_words(table.header[i])) == identities.end()) {
      continue;
    }
    // Merged cells of a spreadsheet leave the rows below the first empty.
    std::vector<std::string> values = values_of(table.rows, i);
    std::erase(values, "");
    if (values.size() < 2) continue;
    problems.add(
        table.file,
        fmt::format("holds rows of {} different values in column {}, and a curve is of one: "
                    "{}; choose with `tethercalc motor FILE --where {}=VALUE`",
                    values.size(), quoted(table.header[i]), listed(values),
                    shown_cell(table.header[i])));
  }
}

/// Whether a comma in the cells that count is the decimal point of this table.
struct DecimalMark {
  bool comma = false;
  std::string problem;
};

/// Decimal commas are recognised by what cannot be thousands.
DecimalMark decimal_mark(const Table& table) {
  bool commas = false;
  bool points = false;
  bool surely_decimal = false;
  for (const auto& [quantity, column] : table.columns.found) {
    for (const Row& row : table.rows) {
      if (column.first >= row.cells.size()) continue;
      const std::string& cell = row.cells[column.first];
      const std::size_t comma = cell.find(',');
      points = points || cell.find('.') != std::string::npos;
      if (comma == std::string::npos) continue;
      commas = true;
      const std::string before = cell.substr(0, comma);
      const bool zero_before = before == "0" || before == "-0" || before.empty() || before == "-";
      surely_decimal = surely_decimal || zero_before || cell.size() - comma - 1 != 3;
    }
  }
  if (!commas) return {};
  if (points) {
    return {false,
            "numbers have commas as well as points: write them with one decimal mark and without "
            "separators of thousands"};
  }
  if (!surely_decimal) {
    return {false,
            "the commas in its numbers may separate decimals or thousands (such as 1,234): write "
            "decimals with a point, or thousands without a separator"};
  }
  return {true, ""};
}

/// A row's numbers in the units of `BenchColumnMeaning`.
struct Measured {
  MotorPoint point;
  double throttle = nan;
  double voltage = nan;
  double current = nan;
  std::size_t line = 0;
};

class RowNumbers {
 public:
  RowNumbers(const Table& table, bool decimal_comma, Problems& problems)
      : table_(table), decimal_comma_(decimal_comma), problems_(problems) {}

  std::optional<Measured> of(const Row& row) {
    faulty_ = false;
    if (row.cells.size() != table_.header.size()) {
      problems_.add(fmt::format("{}:{}", table_.file, row.line),
                    fmt::format("{} cells in the row, expected {} as in the header{}",
                                row.cells.size(), table_.header.size(),
                                row.cells.size() > table_.header.size()
                                    ? " (decimal commas need ; or tabs between cells)"
                                    : ""));
      return std::nullopt;
    }
    Measured out;
    out.line = row.line;
    const double thrust_g = number(row, BenchQuantity::thrust, true);
    const bool needs_current =
        !table_.columns.has(BenchQuantity::power) && !table_.columns.has(BenchQuantity::efficiency);
    out.voltage = number(row, BenchQuantity::voltage, needs_current);
    out.current = number(row, BenchQuantity::current, needs_current);
    out.throttle = number(row, BenchQuantity::throttle, false);
    double watts = 0;
    if (table_.columns.has(BenchQuantity::power)) {
      watts = number(row, BenchQuantity::power, true);
    } else if (table_.columns.has(BenchQuantity::efficiency)) {
      const double g_per_W = number(row, BenchQuantity::efficiency, true);
      watts = g_per_W > 0 ? thrust_g / g_per_W : 0;
    } else {
      watts = out.voltage * out.current;
    }
    out.point = {thrust_g * unit::gram_force, watts};
    if (faulty_) return std::nullopt;
    return out;
  }

 private:
  /// NaN where there is no such column, or none is needed and the cell holds none.
  double number(const Row& row, BenchQuantity quantity, bool needed) {
    if (!table_.columns.has(quantity)) return nan;
    const auto [column, factor] = table_.columns.found.at(quantity);
    std::string cell = row.cells[column];
    if (decimal_comma_) std::ranges::replace(cell, ',', '.');
    if (quantity == BenchQuantity::throttle && cell.ends_with('%'))
      cell = std::string(trimmed(std::string_view(cell).substr(0, cell.size() - 1)));
    const auto value = parsed_number(cell);
    if (value && std::abs(*value * factor) <= 1e6) return *value * factor;
    if (!needed) return nan;
    faulty_ = true;
    const std::string found = cell.empty() ? "empty" : quoted(row.cells[column]);
    problems_.add(fmt::format("{}:{}", table_.file, row.line),
                  fmt::format("{} is {}, expected {}", shown_cell(table_.header[column]), found,
                              value ? fmt::format("at most {:g} in that unit", 1e6 / factor)
                                    : "a number such as -1.25"));
    return nan;
  }

  const Table& table_;
  bool decimal_comma_;
  Problems& problems_;
  bool faulty_ = false;
};

/// How often the thrust of rows in their order passes over its range: up, down, up again. A pass
/// has three rows at least and a fifth of the range, so that neither noise nor the drop between two
/// runs is one.
std::size_t passes_of(std::span<const Measured> rows) {
  const auto [least, greatest] =
      std::ranges::minmax(rows, {}, [](const Measured& m) { return m.point.thrust; });
  const double turned = 0.2 * (greatest.point.thrust - least.point.thrust);
  std::size_t passes = 0;
  std::size_t begin = 0;
  std::size_t extreme = 0;
  int direction = 0;
  const auto count = [&](std::size_t end) { passes += end - begin >= 2 ? 1 : 0; };
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double step = rows[i].point.thrust - rows[extreme].point.thrust;
    if (direction == 0) {
      if (std::abs(step) > turned) {
        direction = step > 0 ? 1 : -1;
        extreme = i;
      }
    } else if (direction * step >= 0) {
      extreme = i;
    } else if (std::abs(step) > turned) {
      count(extreme);
      begin = extreme;
      extreme = i;
      direction = -direction;
    }
  }
  if (!rows.empty()) count(rows.size() - 1);
  return std::max<std::size_t>(passes, 1);
}

BenchPoint mean_of(std::span<const Measured> rows) {
  BenchPoint mean;
  std::vector<std::size_t> lines;
  for (const Measured& row : rows) {
    mean.point.thrust += row.point.thrust / double(rows.size());
    mean.point.power += row.point.power / double(rows.size());
    lines.push_back(row.line);
  }
  mean.where = fmt::format("line{} {}", lines.size() > 1 ? "s" : "", fmt::join(lines, ", "));
  if (rows.size() == 1) mean.point = rows.front().point;  // to the last digit
  return mean;
}

/// Rows of one throttle; without throttles that repeat, neighbours in thrust, one a pass.
std::vector<std::vector<Measured>> grouped(std::vector<Measured> rows, std::size_t passes) {
  std::map<double, std::vector<Measured>> by_throttle;
  for (const Measured& row : rows)
    by_throttle[std::isnan(row.throttle) ? -1 : row.throttle].push_back(row);
  const bool all_have_throttle = by_throttle.count(-1) == 0;
  std::vector<std::vector<Measured>> groups;
  if (all_have_throttle && by_throttle.size() >= 2 && by_throttle.size() < rows.size()) {
    for (auto& [throttle_value, group] : by_throttle) groups.push_back(std::move(group));
    return groups;
  }
  if (passes > 1) {
    std::ranges::stable_sort(rows, {}, [](const Measured& m) { return m.point.thrust; });
  }
  for (std::size_t i = 0; i < rows.size(); i += passes) {
    const auto end = std::min(i + passes, rows.size());
    groups.emplace_back(rows.begin() + std::ptrdiff_t(i), rows.begin() + std::ptrdiff_t(end));
  }
  return groups;
}

/// Whether a table's power is its voltage times its current, where it has all three.
void check_power(const Table& table, std::span<const Measured> rows, std::vector<Warning>& notes) {
  if (!table.columns.has(BenchQuantity::power) && !table.columns.has(BenchQuantity::efficiency))
    return;
  std::vector<double> ratios;
  for (const Measured& row : rows) {
    const double product = row.voltage * row.current;
    if (product > 0 && row.point.power > 0) ratios.push_back(row.point.power / product);
  }
  if (ratios.size() < 2) return;
  std::ranges::sort(ratios);
  const double median = ratios[ratios.size() / 2];
  constexpr double agreement = 0.05;  // rounded columns of a data sheet stay within
  if (std::abs(median - 1) < agreement) return;
  notes.push_back(
      {WarningKind::motor_power_mismatch,
       fmt::format("{}: its power is {:.2f} times its voltage times current (median); the "
                   "power is taken",
                   table.file, median)});
}

double mean_voltage(std::span<const Measured> rows) {
  double sum = 0;
  for (const Measured& row : rows) sum += row.voltage;
  return rows.empty() ? nan : sum / double(rows.size());
}

/// Rows that run, those left out told in `notes`.
std::vector<Measured> running_rows(const Table& table, Problems& problems,
                                   std::vector<Warning>& notes) {
  const DecimalMark mark = decimal_mark(table);
  if (!mark.problem.empty()) {
    problems.add(table.file, mark.problem);
    return {};
  }
  if (table.rows.empty()) {
    problems.add(fmt::format("{}:{}", table.file, table.header_line),
                 "there are no rows below the header");
  }
  RowNumbers numbers(table, mark.comma, problems);
  std::vector<Measured> rows;
  std::size_t idle = 0;
  for (const Row& row : table.rows) {
    const auto measured = numbers.of(row);
    if (!measured) continue;
    if (measured->point.thrust > 0 && measured->point.power > 0) {
      rows.push_back(*measured);
      continue;
    }
    ++idle;
    notes.push_back(
        {WarningKind::motor_rows_left_out,
         fmt::format(
             "{}:{}: left out, since a running motor has thrust and power above 0, found {}",
             table.file, row.line, in_practical_units(measured->point))});
  }
  if (rows.size() < 2 && idle > 0) {
    problems.add(table.file,
                 fmt::format("{} of {} rows have no thrust or no power above 0, and a motor curve "
                             "needs 2 that have; is a sign reversed?",
                             idle, table.rows.size()));
  }
  return rows;
}

/// Root mean square of power over the curve's, less 1.
double scatter_of(const MotorCurve& curve, std::span<const Measured> rows) {
  double squares = 0;
  std::size_t count = 0;
  for (const Measured& row : rows) {
    const double expected = curve.power(row.point.thrust);
    if (!std::isfinite(expected) || !(expected > 0)) continue;  // beyond a mean of the last points
    squares += std::pow(row.point.power / expected - 1, 2);
    ++count;
  }
  return count > 0 ? std::sqrt(squares / double(count)) : 0;
}

double rounded(double value, int digits) {
  return std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr);
}

}  // namespace

MotorBench motor_from_bench(std::span<const LoadedText> tables, const MotorBenchOptions& options) {
  Problems problems(most_problems);
  MotorBench out;
  const std::vector<NamedColumn> named = named_columns(options.columns, problems);
  problems.throw_if_any();
  std::vector<Measured> rows;
  std::vector<std::string> names;
  std::set<ThrottleUnit> throttle_units;
  for (const LoadedText& input : tables) {
    names.push_back(as_utf8(input.name.substr(input.name.find_last_of('/') + 1)));
    std::optional<Table> table = table_of(input, named, problems);
    if (!table || !header_will_do(*table, named, problems)) continue;
    const std::size_t before = problems.count();
    select_rows(*table, options.where, problems);
    if (problems.count() == before) refuse_several(*table, problems);
    if (problems.count() > before) continue;
    const std::vector<Measured> own = running_rows(*table, problems, out.motor.warnings);
    check_power(*table, own, out.motor.warnings);
    throttle_units.insert(table->columns.throttle_unit);
    rows.insert(rows.end(), own.begin(), own.end());
  }
  problems.throw_if_any();

  out.rows = rows.size();
  for (const Measured& row : rows) out.throttled.push_back({row.throttle, row.point.thrust});
  if (throttle_units.size() == 1) out.throttle_unit = *throttle_units.begin();
  out.passes = passes_of(rows);
  const auto groups = grouped(rows, out.passes);
  std::vector<BenchPoint> points;
  for (const auto& group : groups) points.push_back(mean_of(group));
  MotorEntry& motor = out.motor;
  motor.id = as_utf8(file_stem(tables.front().name));
  motor.name = motor.id;
  motor.source = fmt::format("{}{}", fmt::join(names, ", "), options.where.empty() ? "" : ": ") +
                 fmt::format("{}", fmt::join(options.where, ", "));
  if (const double volts = mean_voltage(rows); volts > 0) motor.voltage_V = rounded(volts, 4);
  set_curve(motor, points, as_utf8(tables.front().name), problems);
  problems.throw_if_any();
  out.scatter = scatter_of(motor.curve, rows);
  if (groups.size() < rows.size()) {
    motor.warnings.push_back(
        {WarningKind::motor_runs_averaged,
         fmt::format(
             "{}: {} rows of repeated runs or sweeps were averaged to {} points; their power "
             "scatters by {:.1f} % around the curve (root mean square)",
             names.front(), rows.size(), groups.size(), 100 * out.scatter)});
  }
  return out;
}

std::vector<ThrottledThrust> throttled_thrust(const MotorBench& bench, const std::string& file,
                                              const PulseRange& pulses) {
  const bool has_throttle = std::ranges::any_of(
      bench.throttled, [](const MotorBench::Row& row) { return std::isfinite(row.throttle); });
  if (!has_throttle) {
    throw InputError(file,
                     "has no column of the throttle, from which --parameters is fitted; say "
                     "which is: --columns throttle_percent=HEADER or throttle_us=HEADER");
  }
  if (bench.throttle_unit == ThrottleUnit::unknown) {
    throw InputError(file,
                     "does not say what its throttle is counted in; say it: --columns "
                     "throttle_percent=HEADER or throttle_us=HEADER");
  }
  const bool is_pulse = bench.throttle_unit == ThrottleUnit::microseconds;
  std::vector<ThrottledThrust> out;
  for (const MotorBench::Row& row : bench.throttled) {
    const double output = is_pulse ? (row.throttle - pulses.least) / (pulses.most - pulses.least)
                                   : row.throttle / 100;
    out.push_back({output, row.thrust});
  }
  return out;
}

nlohmann::ordered_json motor_document(const MotorEntry& motor) {
  constexpr int digits = 6;  // of a measurement that has three
  nlohmann::ordered_json out;
  out["id"] = motor.id;
  out["name"] = motor.name;
  if (!motor.source.empty()) out["source"] = motor.source;
  if (motor.voltage_V) out["voltage_V"] = *motor.voltage_V;
  if (motor.propeller_in) out["propeller_in"] = *motor.propeller_in;
  if (motor.curve.measured_in()) out["measured_air_density_kg_m3"] = *motor.curve.measured_in();
  out["points"] = nlohmann::ordered_json::array();
  for (const MotorPoint& point : motor.curve.vertices().subspan(1)) {
    out["points"].push_back({{"thrust_g", rounded(point.thrust / unit::gram_force, digits)},
                             {"power_W", rounded(point.power, digits)}});
  }
  return out;
}

}  // namespace tethercalc
