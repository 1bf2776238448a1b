#include "tethercalc/report/sweep_report.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "io/json_document.hpp"
#include "model/constants.hpp"
#include "report/result_values.hpp"
#include "tethercalc/report/design_report.hpp"

namespace tethercalc {
namespace {

/// Appends the cells of one row.
class RowText {
 public:
  RowText(std::string& text, RowFormat format, const std::vector<std::string>& openings)
      : text_(text), csv_(format == RowFormat::csv), opening_(openings.data()) {}

  void number(double value) {
    text_ += *opening_++;
    if (std::isfinite(value)) {
      // The shortest text that reads back as the same number, as `csv_number` makes it.
      std::array<char, 32> digits{};
      char* const end = fmt::format_to(digits.data(), FMT_COMPILE("{}"), value);
      text_.append(digits.data(), static_cast<std::size_t>(end - digits.data()));
    } else if (!csv_) {
      text_ += "null";
    }
  }

  /// Empty text stands for none.
  void words(std::string_view value) {
    text_ += *opening_++;
    text_ += csv_ ? csv_text(value) : value.empty() ? "null" : json_line(value);
  }

  /// Both points, with the numbers that they share printed once and copied: printing is what costs
  /// time here, and half of the quantities depend on the cable alone.
  void points(const SweepOutcome& outcome) {
    const auto fields = operating_point_fields();
    const bool exists = !std::isnan(outcome.area());
    std::vector<std::pair<std::size_t, std::size_t>> printed;  // from where on, and how much
    printed.reserve(fields.size());
    for (const OperatingPointField& field : fields) {
      const std::size_t begin = text_.size() + opening_->size();
      number(exists ? practical_value(outcome.points.hover, field) : nan);
      printed.emplace_back(begin, text_.size() - begin);
    }
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const double OperatingPoint::*const member = fields[i].member;
      if (!exists || outcome.points.hover.*member == outcome.points.forward.*member) {
        text_ += *opening_++;
        text_.append(text_, printed[i].first, printed[i].second);
      } else {
        number(practical_value(outcome.points.forward, fields[i]));
      }
    }
  }

  void end() { text_ += csv_ ? "\n" : "}\n"; }

 private:
  std::string& text_;
  bool csv_;
  const std::string* opening_;
};

/// Why a row is infeasible; empty where it is not.
std::string reason_words(const SweepRow& row) {
  if (row.outcome.refusal) return refusal_words(row.design, *row.outcome.refusal);
  return row.outcome.given_area ? shortcoming(row.design, row.outcome.points) : "";
}

/// What stands in a row, in the order of its columns; `row` takes it as text or as bytes.
template <class Row>
void put_row(Row& row, std::span<const SweepAxis> axes, const SweepRow& swept) {
  const SweepOutcome& outcome = swept.outcome;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (const auto* choices = std::get_if<NamedChoices>(&axes[i].values)) {
      row.words(choices->names[static_cast<std::size_t>(swept.values[i])]);
    } else {
      row.number(swept.values[i]);
    }
  }
  const bool limited = !(outcome.given_area && outcome.feasible);
  row.words(status_name(outcome.feasible, outcome.given_area));
  row.words(limited ? limit_name(outcome.limited_by) : "");
  row.words(limited ? condition_name(outcome.limiting_condition) : "");
  row.number(outcome.area() / unit::square_millimetre);
  row.points(outcome);
  for (const auto& [name, value] : estimates_of(swept.design)) row.number(value.value_or(nan));
}

/// The names of what `put_row` puts.
std::vector<std::string> row_columns(std::span<const SweepAxis> axes) {
  std::vector<std::string> columns;
  for (const SweepAxis& axis : axes) columns.push_back(axis.name);
  for (NamedResult& result : optimum_results({})) columns.push_back(std::move(result.name));
  for (const auto& [name, value] : estimates_of({})) columns.emplace_back(name);
  return columns;
}

/// UTF-8 as the code points that a NumPy text holds.
std::u32string code_points(std::string_view text) {
  std::u32string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      out += char32_t{byte};
    } else if (byte >= 0xc0) {  // the first of several: what is left of it after its length
      out += static_cast<char32_t>(byte & (byte < 0xe0 ? 0x1f : byte < 0xf0 ? 0x0f : 0x07));
    } else if (!out.empty()) {
      out.back() = (out.back() << 6) | (byte & 0x3f);
    }
  }
  return out;
}

/// The most characters of any of these words.
template <class Words>
std::size_t longest(const Words& words) {
  std::size_t most = 1;
  for (const std::string_view word : words) most = std::max(most, code_points(word).size());
  return most;
}

/// Appends the bytes of one record.
class RowBytes {
 public:
  RowBytes(std::string& bytes, const std::vector<RecordColumn>& columns)
      : bytes_(bytes), column_(columns.data()) {}

  void number(double value) {
    const double finite = std::isfinite(value) ? value : nan;
    bytes_.append(reinterpret_cast<const char*>(&finite), sizeof finite);
    ++column_;
  }

  void words(std::string_view value) {
    std::u32string padded = code_points(value);
    padded.resize(column_->characters);
    bytes_.append(reinterpret_cast<const char*>(padded.data()), padded.size() * sizeof(char32_t));
    ++column_;
  }

  void points(const SweepOutcome& outcome) {
    const bool exists = !std::isnan(outcome.area());
    for (const OperatingPoint* point : {&outcome.points.hover, &outcome.points.forward}) {
      for (const OperatingPointField& field : operating_point_fields()) {
        number(exists ? practical_value(*point, field) : nan);
      }
    }
  }

 private:
  std::string& bytes_;
  const RecordColumn* column_;
};

constexpr std::array shares{0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99};

/// Half-width of a 95 % interval in standard errors of a normal distribution.
constexpr double ci95_factor = 1.96;

ordered_json estimate_json(const IndexEstimate& estimate) {
  const double half = ci95_factor * estimate.standard_error;
  return {{"value", number_or_null(estimate.value)},
          {"standard_error", number_or_null(estimate.standard_error)},
          {"ci95", {number_or_null(estimate.value - half), number_or_null(estimate.value + half)}}};
}

ordered_json sensitivity_json(const std::vector<Sensitivity>& indices, const SweepSpace& space) {
  ordered_json out = ordered_json::array();
  for (std::size_t i = 0; i < indices.size(); ++i) {
    out.push_back({{"field", space.axes()[i].name},
                   {"first_order", estimate_json(indices[i].first_order)},
                   {"total", estimate_json(indices[i].total)}});
  }
  return out;
}

ordered_json spread_json(const Spread& spread, double si_factor) {
  const auto practical = [&](double value) { return number_or_null(value / si_factor); };
  ordered_json quantiles = ordered_json::object();
  for (const double share : shares) {
    quantiles[fmt::format("{}", share)] = practical(spread.quantile(share));
  }
  return {{"mean", practical(spread.mean())},
          {"standard_deviation", practical(spread.standard_deviation())},
          {"min", practical(spread.quantile(0))},
          {"max", practical(spread.quantile(1))},
          {"quantiles", quantiles}};
}

std::string estimate_words(const IndexEstimate& estimate) {
  if (std::isnan(estimate.value)) return "-";
  return fmt::format("{} ± {}", fixed(estimate.value, 3),
                     fixed(ci95_factor * estimate.standard_error, 3));
}

std::string indices_text(const std::string& of, const std::vector<Sensitivity>& indices,
                         const SweepSpace& space, const TextStyle& style) {
  TextTable table({word_column("Share in the variance of " + of), "alone", "with interactions"});
  for (std::size_t i = 0; i < indices.size(); ++i) {
    table.add({space.axes()[i].name, estimate_words(indices[i].first_order),
               estimate_words(indices[i].total)});
  }
  return table.text(style) + "\n";
}

void add_spread(TextTable& table, const std::string& name, const Spread& spread, double si_factor) {
  std::vector<std::string> cells{name, significant(spread.mean() / si_factor, 4),
                                 significant(spread.standard_deviation() / si_factor, 3)};
  for (const double share : shares) {
    cells.push_back(significant(spread.quantile(share) / si_factor, 4));
  }
  table.add(std::move(cells));
}

}  // namespace

SweepRows::SweepRows(std::span<const SweepAxis> axes, RowFormat format)
    : axes_(axes.begin(), axes.end()), format_(format) {
  std::vector<std::string> columns = row_columns(axes_);
  columns.emplace_back("reason");
  for (const std::string& column : columns) {
    const bool first = openings_.empty();
    if (format_ == RowFormat::csv) {
      openings_.emplace_back(first ? "" : ",");
      header_ += openings_.back() + column;
    } else {
      openings_.push_back((first ? "{\"" : ",\"") + column + "\":");
    }
  }
  if (format_ == RowFormat::csv) header_ += '\n';
}

void SweepRows::append(std::string& text, const SweepRow& swept) const {
  RowText row(text, format_, openings_);
  put_row(row, axes_, swept);
  row.words(reason_words(swept));
  row.end();
}

SweepRecords::SweepRecords(std::span<const SweepAxis> axes) : axes_(axes.begin(), axes.end()) {
  for (const std::string& name : row_columns(axes)) columns_.push_back({name, 0, 0});
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (const auto* choices = std::get_if<NamedChoices>(&axes_[i].values)) {
      columns_[i].characters = longest(choices->names);
    }
  }
  std::vector<std::string_view> limits;
  for (std::size_t i = 0; i < limit_count; ++i) {
    limits.push_back(limit_name(static_cast<Limit>(i)));
  }
  RecordColumn* words = &columns_[axes_.size()];  // the first three results
  words[0].characters = longest(design_status_names());
  words[1].characters = longest(limits);
  words[2].characters =
      longest(std::array{condition_name(Condition::hover), condition_name(Condition::forward)});
  for (RecordColumn& column : columns_) {
    column.offset = size_;
    size_ += column.characters > 0 ? column.characters * sizeof(char32_t) : sizeof(double);
  }
}

void SweepRecords::append(std::string& bytes, const SweepRow& swept) const {
  RowBytes row(bytes, columns_);
  put_row(row, axes_, swept);
}

std::string summary_text(const SweepSummary& summary, const SweepSpace& space,
                         const TextStyle& style) {
  const double share = static_cast<double>(summary.infeasible) / static_cast<double>(summary.draws);
  std::string out = fmt::format("{} draws, {} infeasible ({} %)\n\n", summary.draws,
                                summary.infeasible, significant(100 * share, 3));
  std::vector<TextTable::Column> columns{word_column("Feasible draws"), "mean", "std dev"};
  for (const double p : shares) columns.push_back(fmt::format("{} %", 100 * p));
  TextTable spread(std::move(columns));
  add_spread(spread, "cross-section mm²", summary.area, unit::square_millimetre);
  add_spread(spread, "total power W", summary.power, 1);
  out += spread.text(style) + "\n";

  const SweepSensitivity& sensitivity = summary.sensitivity;
  out += indices_text("the cross-section", sensitivity.area, space, style);
  out += indices_text("the total power", sensitivity.power, space, style);
  if (!sensitivity.feasible.empty()) {
    out += indices_text("feasibility", sensitivity.feasible, space, style);
  }
  out += wrapped(
      fmt::format("Sobol indices, first order (alone) and total (with interactions), with 95 % "
                  "confidence, from {} designs.",
                  sensitivity.evaluations));
  if (sensitivity.incomplete > 0) {
    out +=
        wrapped(fmt::format("{} of {} points were infeasible in part and left out for area and "
                            "power, whose indices hold for the rest.",
                            sensitivity.incomplete, sensitivity.points));
  }
  return out;
}

ordered_json summary_json(const SweepSummary& summary, const SweepSpace& space) {
  const SweepSensitivity& sensitivity = summary.sensitivity;
  ordered_json indices = {{"points", sensitivity.points},
                          {"evaluations", sensitivity.evaluations},
                          {"incomplete_points", sensitivity.incomplete},
                          {"cross_section_mm2", sensitivity_json(sensitivity.area, space)},
                          {"total_power_W", sensitivity_json(sensitivity.power, space)},
                          {"feasible", sensitivity_json(sensitivity.feasible, space)}};
  const SamplePlan& plan = *space.sample();
  return {{"draws", summary.draws},
          {"method", plan.method == SampleMethod::sobol ? "sobol" : "lhs"},
          {"seed", plan.seed},
          {"infeasible", summary.infeasible},
          {"infeasible_share",
           static_cast<double>(summary.infeasible) / static_cast<double>(summary.draws)},
          {"cross_section_mm2", spread_json(summary.area, unit::square_millimetre)},
          {"total_power_W", spread_json(summary.power, 1)},
          {"sensitivity", indices}};
}

std::vector<Warning> sweep_warnings(const DesignFile& base, const SweepSpace& space,
                                    const std::optional<GroundContact>& ground) {
  constexpr std::uint64_t looked_at = 32;
  std::vector<Warning> warnings = spec_warnings(base);
  if (ground) warnings.push_back(ground_warning(*ground, "in some rows: "));
  if (density_warning(base.design) || space.rows() == 0) return warnings;
  SweepCursor cursor(space, base.design);
  for (const std::uint64_t row : spread_rows(space.rows(), looked_at)) {
    cursor.move_to(row);
    if (auto density = density_warning(cursor.design())) {
      warnings.push_back(std::move(*density));
      break;
    }
  }
  return warnings;
}

}  // namespace tethercalc
