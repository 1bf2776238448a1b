#include "tethercalc/report/sweep_rows.hpp"

#include <fmt/compile.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tethercalc/report/csv_cell.hpp"
#include "tethercalc/report/json_results.hpp"
#include "tethercalc/report/limit_sentences.hpp"
#include "tethercalc/report/operating_point_fields.hpp"
#include "tethercalc/report/text_table.hpp"
#include "tethercalc/solve/ordered_chunks.hpp"

namespace tethercalc {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

SweepOutcome given_cable(const Design& design) {
  SweepOutcome outcome;
  outcome.given_area = true;
  outcome.feasible = true;
  outcome.area = design.tether.cross_section.value_or(nan);
  outcome.hover = evaluate(design, outcome.area, Condition::hover);
  outcome.forward = evaluate(design, outcome.area, Condition::forward);
  const Margins margins = demand_margins(design, outcome.hover, outcome.forward);
  const DemandMargin& worst = margins.worst();
  outcome.feasible = worst.met();
  if (outcome.feasible) return outcome;
  const OperatingPoint& point =
      worst.condition == Condition::hover ? outcome.hover : outcome.forward;
  outcome.limited_by = missed_limit(design, point, worst.demand);
  outcome.limiting_condition = worst.condition;
  outcome.reason = missed_words(design, point, worst);
  return outcome;
}

// --- Cells -----------------------------------------------------------------------------------

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
    if (csv_) {
      text_ += csv_text(std::string(value));
    } else {
      text_ += value.empty() ? "null" : nlohmann::json(value).dump();
    }
  }

  /// A word without characters that would need quoting.
  void plain_word(std::string_view value) {
    text_ += *opening_++;
    if (csv_) {
      text_ += value;
    } else if (value.empty()) {
      text_ += "null";
    } else {
      text_ += '"';
      text_ += value;
      text_ += '"';
    }
  }

  /// The text between two positions once more.
  void again(std::size_t begin, std::size_t end) {
    text_ += *opening_++;
    text_.append(text_, begin, end - begin);
  }

  [[nodiscard]] std::size_t position_after_opening() const {
    return text_.size() + opening_->size();
  }
  [[nodiscard]] std::size_t position() const { return text_.size(); }

  void end() { text_ += csv_ ? "\n" : "}\n"; }

 private:
  std::string& text_;
  bool csv_;
  const std::string* opening_;
};

struct Extent {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Both points, with the numbers that they share printed once and copied: printing is what costs
/// time here, and half of the quantities depend on the cable alone.
void append_points(RowText& row, const SweepOutcome& outcome) {
  const auto fields = operating_point_fields();
  const bool exists = !std::isnan(outcome.area);
  std::vector<Extent> printed(fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    printed[i].begin = row.position_after_opening();
    row.number(exists ? practical_value(outcome.hover, fields[i]) : nan);
    printed[i].end = row.position();
  }
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const double OperatingPoint::*const member = fields[i].member;
    if (!exists || outcome.hover.*member == outcome.forward.*member) {
      row.again(printed[i].begin, printed[i].end);
    } else {
      row.number(practical_value(outcome.forward, fields[i]));
    }
  }
}

std::string_view status_word(const SweepOutcome& outcome) {
  return !outcome.feasible ? "infeasible" : outcome.given_area ? "feasible" : "optimal";
}

}  // namespace

SweepOutcome sweep_outcome(const Design& design, bool given_area) {
  if (given_area) return given_cable(design);
  const Optimization result = optimize(design);
  SweepOutcome outcome;
  outcome.feasible = result.feasible;
  outcome.limited_by = result.limited_by;
  outcome.limiting_condition = result.limiting_condition;
  outcome.area = result.area;
  outcome.hover = result.hover;
  outcome.forward = result.forward;
  if (!result.feasible) {
    outcome.area = nan;
    outcome.reason = infeasible_words(design, result);
  }
  return outcome;
}

double judged_power(const SweepOutcome& outcome, const Design& design) {
  if (std::isnan(outcome.area)) return nan;
  return design.requirements.power_at == Condition::hover ? outcome.hover.total_power
                                                          : outcome.forward.total_power;
}

SweepRows::SweepRows(std::span<const SweepAxis> axes, RowFormat format)
    : axes_(axes.begin(), axes.end()), format_(format) {
  std::vector<std::string> columns;
  for (const SweepAxis& axis : axes_) columns.push_back(axis.name);
  columns.insert(columns.end(),
                 {"status", "limited_by", "limiting_condition", "cross_section_mm2"});
  for (const char* prefix : {"hover.", "forward."}) {
    for (const OperatingPointField& field : operating_point_fields()) {
      columns.push_back(prefix + std::string(field.key));
    }
  }
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

void SweepRows::append(std::string& text, std::span<const double> values,
                       const SweepOutcome& outcome) const {
  RowText row(text, format_, openings_);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (const auto* choices = std::get_if<NamedChoices>(&axes_[i].values)) {
      row.words(choices->names[static_cast<std::size_t>(values[i])]);
    } else {
      row.number(values[i]);
    }
  }
  const bool limited = !(outcome.given_area && outcome.feasible);
  row.plain_word(status_word(outcome));
  row.plain_word(limited ? limit_name(outcome.limited_by) : "");
  row.plain_word(limited ? condition_name(outcome.limiting_condition) : "");
  row.number(outcome.area / unit::square_millimetre);
  append_points(row, outcome);
  row.words(outcome.reason);
  row.end();
}

bool varies_cross_section(const SweepSpace& space) {
  const auto axes = space.axes();
  return std::any_of(axes.begin(), axes.end(),
                     [](const SweepAxis& axis) { return axis.name == "tether.cross_section_mm2"; });
}

void compute_sweep(const SweepJob& job, const std::function<bool(const SweepChunk&)>& consume) {
  // About a millisecond of work and 100 kilobytes of text: long against the handing over, short
  // enough to stay in a core's cache.
  constexpr std::uint64_t rows_per_chunk = 256;
  const RowRange all = job.range;
  if (all.begin >= all.end) return;
  const std::uint64_t chunks = (all.end - all.begin + rows_per_chunk - 1) / rows_per_chunk;
  const bool given_area = varies_cross_section(*job.space);

  const auto make_worker = [&] {
    return [&, cursor = SweepCursor(*job.space, *job.base)](std::uint64_t index,
                                                            SweepChunk& chunk) mutable {
      chunk.range.begin = all.begin + index * rows_per_chunk;
      chunk.range.end = std::min(chunk.range.begin + rows_per_chunk, all.end);
      chunk.text.clear();
      chunk.judged.clear();
      for (std::uint64_t row = chunk.range.begin; row < chunk.range.end; ++row) {
        cursor.move_to(row);
        const SweepOutcome outcome = sweep_outcome(cursor.design(), given_area);
        chunk.judged.push_back(
            {outcome.area, judged_power(outcome, cursor.design()), outcome.feasible});
        if (row >= job.write_from) job.rows->append(chunk.text, cursor.values(), outcome);
      }
    };
  };
  compute_in_order<SweepChunk>(0, chunks, job.threads, make_worker, consume);
}

}  // namespace tethercalc
