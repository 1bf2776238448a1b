#include "tethercalc/report/sweep_rows.hpp"

#include <fmt/compile.h>

#include <array>
#include <cmath>

#include "model/constants.hpp"
#include "report/result_values.hpp"
#include "tethercalc/report/limit_sentences.hpp"

namespace tethercalc {
namespace {

/// The shortest text that reads back as the same number, as `csv_number` makes it.
void append_number(std::string& text, double value) {
  std::array<char, 32> digits{};
  char* const end = fmt::format_to(digits.data(), FMT_COMPILE("{}"), value);
  text.append(digits.data(), static_cast<std::size_t>(end - digits.data()));
}

/// Appends the cells of one row.
class RowText {
 public:
  RowText(std::string& text, RowFormat format, const std::vector<std::string>& openings)
      : text_(text), csv_(format == RowFormat::csv), opening_(openings.data()) {}

  void number(double value) {
    text_ += *opening_++;
    if (std::isfinite(value)) {
      append_number(text_, value);
    } else if (!csv_) {
      text_ += "null";
    }
  }

  /// Empty text stands for none.
  void words(std::string_view value) {
    text_ += *opening_++;
    text_ += csv_ ? csv_text(value) : value.empty() ? "null" : nlohmann::json(value).dump();
  }

  /// A word without characters that would need quoting.
  void plain_word(std::string_view value) {
    text_ += *opening_++;
    const bool none = !csv_ && value.empty();
    const char* const quote = csv_ || none ? "" : "\"";
    text_.append(quote).append(none ? "null" : value).append(quote);
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

std::string_view status_word(const SweepOutcome& outcome) {
  return !outcome.feasible ? "infeasible" : outcome.given_area ? "feasible" : "optimal";
}

}  // namespace

SweepRows::SweepRows(std::span<const SweepAxis> axes, RowFormat format)
    : axes_(axes.begin(), axes.end()), format_(format) {
  std::vector<std::string> columns;
  for (const SweepAxis& axis : axes_) columns.push_back(axis.name);
  for (NamedResult& result : optimum_results({})) columns.push_back(std::move(result.name));
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
  const SweepOutcome& outcome = swept.outcome;
  RowText row(text, format_, openings_);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (const auto* choices = std::get_if<NamedChoices>(&axes_[i].values)) {
      row.words(choices->names[static_cast<std::size_t>(swept.values[i])]);
    } else {
      row.number(swept.values[i]);
    }
  }
  const bool limited = !(outcome.given_area && outcome.feasible);
  row.plain_word(status_word(outcome));
  row.plain_word(limited ? limit_name(outcome.limited_by) : "");
  row.plain_word(limited ? condition_name(outcome.limiting_condition) : "");
  row.number(outcome.area() / unit::square_millimetre);
  row.points(outcome);
  row.words(reason_words(swept));
  row.end();
}

}  // namespace tethercalc
