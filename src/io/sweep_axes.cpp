#include "tethercalc/io/sweep_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "io/checked_values.hpp"
#include "io/entry_readers.hpp"
#include "tethercalc/io/library.hpp"
#include "tethercalc/io/spec_fields.hpp"

namespace tethercalc {
namespace {

/// Whole numbers up to here, and no further, are all exact in double.
constexpr std::int64_t exact_limit = std::int64_t{1} << 53;

// --- Numbers ---------------------------------------------------------------------------------

/// digits·10^exponent, the number exactly as written.
struct Decimal {
  std::int64_t digits = 0;
  int exponent = 0;
};

std::optional<Decimal> parsed_decimal(std::string_view text) {
  if (!parsed_number(text)) return std::nullopt;
  Decimal decimal;
  const std::size_t e = std::min(text.find_first_of("eE"), text.size());
  if (e < text.size()) {
    std::string_view exponent = text.substr(e + 1);
    if (exponent.starts_with('+')) exponent.remove_prefix(1);
    std::from_chars(exponent.data(), exponent.data() + exponent.size(), decimal.exponent);
  }
  bool after_point = false;
  for (const char c : text.substr(0, e)) {
    if (c == '.') after_point = true;
    if (c < '0' || c > '9') continue;
    if (decimal.digits > exact_limit / 10) return std::nullopt;
    decimal.digits = 10 * decimal.digits + (c - '0');
    if (after_point) --decimal.exponent;
  }
  if (text.starts_with('-')) decimal.digits = -decimal.digits;
  while (decimal.digits != 0 && decimal.digits % 10 == 0) {
    decimal.digits /= 10;
    ++decimal.exponent;
  }
  return decimal;
}

/// The decimal times 10^places, where that is a whole number that double represents exactly.
std::optional<std::int64_t> scaled(Decimal decimal, int places) {
  std::int64_t value = decimal.digits;
  for (int i = decimal.exponent + places; i > 0 && value != 0; --i) {
    if (std::abs(value) > exact_limit / 10) return std::nullopt;
    value *= 10;
  }
  return value;
}

// --- One axis ----------------------------------------------------------------------------------

constexpr const char* only_drawn =
    "can only be drawn, not enumerated: add --sample N, or write from:to:step";

/// Reads one "path=values".
class AxisReader {
 public:
  AxisReader(const std::string& text, const DesignFile& base, AxisUse use, Problems& problems)
      : option_((use == AxisUse::searched ? "--free " : "--vary ") + text),
        text_(text),
        base_(base),
        use_(use),
        problems_(problems) {}

  std::optional<SweepAxis> read() {
    const std::size_t equals = text_.find('=');
    if (equals == std::string_view::npos || equals == 0) {
      return refuse(use_ == AxisUse::searched
                        ? "expected PATH=lo..hi or PATH=a,b,c, such as supply.voltage_V=40..400"
                        : "expected path=values, such as supply.voltage_V=40:100:5");
    }
    const std::string_view path = text_.substr(0, equals);
    const std::string_view values = text_.substr(equals + 1);
    if (values.empty()) return refuse("no values after the \"=\"");
    const SpecField* field = find_field(path);
    if (field == nullptr) return refuse(no_such_field(path));
    switch (field->kind) {
      case FieldKind::number:
      case FieldKind::optional_number:
      case FieldKind::integer:
      case FieldKind::efficiency:
        return number_axis(*field, values);
      case FieldKind::boolean:
      case FieldKind::condition:
      case FieldKind::strength_material:
      case FieldKind::tether_model:
      case FieldKind::wind_profile:
        return word_axis(*field, values);
      case FieldKind::motor:
        return entry_axis<MotorEntry>(*field, values);
      case FieldKind::conductor:
        return entry_axis<ConductorEntry>(*field, values);
      case FieldKind::insulation_material:
        return entry_axis<InsulationEntry>(*field, values);
      case FieldKind::converter_masses:
        return refuse(use_ == AxisUse::searched ? "a search cannot free this field"
                                                : "a sweep cannot vary this field");
      default:
        return refuse("this field does not change the result");
    }
  }

 private:
  using Values = std::optional<decltype(SweepAxis::values)>;

  std::nullopt_t refuse(std::string message) {
    return problems_.refuse(option_, std::move(message));
  }

  std::optional<double> number(std::string_view text) {
    const auto value = parsed_number(text);
    if (!value) refuse(fmt::format("{} is not a number", shown(std::string(text))));
    return value;
  }

  bool allowed(const SpecField& field, double value) {
    if (field.range.contains(value)) return true;
    refuse(fmt::format("{} is not allowed: it must be {}{}", value, describe_range(field),
                       meant_in_thousands(field, value)));
    return false;
  }

  bool whole(const SpecField& field, double value) {
    if (field.kind != FieldKind::integer || value == std::floor(value)) return true;
    refuse(fmt::format("{} is not allowed: it must be a whole number", value));
    return false;
  }

  std::optional<SweepAxis> number_axis(const SpecField& field, std::string_view text) {
    Values values = text.find('~') != text.npos    ? read_normal(field, text)
                    : text.find("..") != text.npos ? read_uniform(field, text)
                    : text.find(':') != text.npos  ? read_range(field, text)
                                                   : read_list(field, text);
    if (!values) return std::nullopt;
    return SweepAxis{dot_path(field.pointer), std::move(*values),
                     [field](Design& design, double value) { set_field(design, field, value); }};
  }

  Values read_list(const SpecField& field, std::string_view text) {
    std::vector<double> list;
    bool good = true;
    for (const std::string_view part : split(text, ',')) {
      const auto value = number(part);
      good = value && allowed(field, *value) && whole(field, *value) && good;
      if (value) list.push_back(*value);
    }
    return good ? Values(std::move(list)) : std::nullopt;
  }

  Values read_range(const SpecField& field, std::string_view text) {
    const auto parts = split(text, ':');
    if (parts.size() != 3) return refuse("a range is from:to:step, such as 40:100:5");
    std::array<Decimal, 3> written;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!number(parts[i])) return std::nullopt;
      const auto decimal = parsed_decimal(parts[i]);
      if (!decimal) return too_many_digits(parts[i]);
      written[i] = *decimal;
    }
    int places = 0;
    for (const Decimal& decimal : written) places = std::max(places, -decimal.exponent);
    std::array<std::int64_t, 3> numbers{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto value = places <= 22 ? scaled(written[i], places) : std::nullopt;
      if (!value) return too_many_digits(text);
      numbers[i] = *value;
    }
    const auto [from, to, step] = numbers;
    if (step == 0 || (to > from && step < 0) || (to < from && step > 0)) {
      return refuse(
          fmt::format("steps of {} do not lead from {} to {}", parts[2], parts[0], parts[1]));
    }
    const auto count = static_cast<std::uint64_t>((to - from) / step) + 1;
    const SweepAxis axis{{}, DecimalRange{from, step, count, places}, {}};
    const double first = value_at(axis, 0);
    const double last = value_at(axis, count - 1);
    // Equal steps between whole ends need not be whole, but then the second value is not.
    const bool good = allowed(field, first) && (count == 1 || allowed(field, last)) &&
                      whole(field, first) && (count == 1 || whole(field, value_at(axis, 1)));
    return good ? Values(axis.values) : std::nullopt;
  }

  std::nullopt_t too_many_digits(std::string_view text) {
    return refuse(fmt::format("{} has more digits than can be stepped through exactly", text));
  }

  Values read_uniform(const SpecField& field, std::string_view text) {
    const std::size_t dots = text.find("..");
    const auto lo = number(text.substr(0, dots));
    const auto hi = number(text.substr(dots + 2));
    if (!lo || !hi) return std::nullopt;
    if (use_ == AxisUse::enumerated) return refuse(only_drawn);
    if (!(*lo < *hi) && !(use_ == AxisUse::searched && *lo == *hi)) {
      return refuse(fmt::format("the lower end {} must be below the upper end {}", *lo, *hi));
    }
    if (!whole(field, *lo) || !whole(field, *hi)) return std::nullopt;
    const bool lo_allowed = allowed(field, *lo);
    if (!allowed(field, *hi) || !lo_allowed) return std::nullopt;
    if (field.kind != FieldKind::integer) return Uniform{*lo, *hi};
    return UniformInteger{static_cast<std::int64_t>(*lo), static_cast<std::int64_t>(*hi)};
  }

  Values read_normal(const SpecField& field, std::string_view text) {
    const std::size_t tilde = text.find('~');
    const auto mean = number(text.substr(0, tilde));
    const auto deviation = number(text.substr(tilde + 1));
    if (!mean || !deviation) return std::nullopt;
    if (use_ == AxisUse::enumerated) return refuse(only_drawn);
    if (use_ == AxisUse::searched) {
      return refuse("nothing is drawn in a search: write lo..hi, from:to:step or a list");
    }
    if (!(*deviation > 0)) {
      return refuse(fmt::format("the standard deviation {} must be positive", *deviation));
    }
    if (field.kind == FieldKind::integer) {
      return refuse("whole numbers have no normal distribution: write lo..hi or a list");
    }
    return allowed(field, *mean) ? Values(Normal{*mean, *deviation}) : std::nullopt;
  }

  /// What "all" stands for, or the names in a list.
  static std::vector<std::string> names_in(std::string_view text, std::vector<std::string> all) {
    if (text == "all") return all;
    const auto parts = split(text, ',');
    return {parts.begin(), parts.end()};
  }

  std::optional<SweepAxis> word_axis(const SpecField& field, std::string_view text) {
    const auto words = field_words(field.kind);
    NamedChoices choices{names_in(text, {words.begin(), words.end()})};
    std::vector<std::size_t> chosen;
    for (std::string& name : choices.names) {
      if (const auto word = typed_word(name, words)) {
        chosen.push_back(*word);
        name = words[*word];
      } else {
        refuse(no_such_word(name, words, shown(name)));
      }
    }
    if (chosen.size() < choices.names.size()) return std::nullopt;
    return SweepAxis{dot_path(field.pointer), std::move(choices),
                     [field, chosen](Design& design, double position) {
                       set_word(design, field, chosen[static_cast<std::size_t>(position)]);
                     }};
  }

  template <class Entry>
  std::optional<SweepAxis> entry_axis(const SpecField& field, std::string_view text) {
    NamedChoices choices;
    std::vector<Entry> entries;
    if (text == "all") {
      entries = library_entries<Entry>();
      for (const Entry& entry : entries) choices.names.push_back(entry.id);
    } else {
      choices.names = names_in(text, {});
      for (const std::string& name : choices.names) {
        problems_.succeeds(
            [&] { entries.push_back(find_entry<Entry>(name, base_.load, option_)); });
      }
      if (entries.size() < choices.names.size()) return std::nullopt;
    }
    return SweepAxis{dot_path(field.pointer), std::move(choices),
                     [entries](Design& design, double position) {
                       put_entry(design, entries[static_cast<std::size_t>(position)]);
                     }};
  }

  std::string option_;
  std::string_view text_;
  const DesignFile& base_;
  AxisUse use_;
  Problems& problems_;
};

// --- All rows ------------------------------------------------------------------------------------

/// The numbers between which all values of an axis lie; all of those that stand for names.
std::vector<double> ends_of(const SweepAxis& axis) {
  if (const auto* list = std::get_if<std::vector<double>>(&axis.values)) {
    const auto [least, largest] = std::minmax_element(list->begin(), list->end());
    return {*least, *largest};
  }
  if (std::holds_alternative<Normal>(axis.values)) {
    // No draw lies further out: draws are made from numbers of 53 bits.
    return {quantile(axis, 0x1p-54), quantile(axis, 1 - 0x1p-53)};
  }
  if (const auto* uniform = std::get_if<Uniform>(&axis.values)) return {uniform->lo, uniform->hi};
  const std::uint64_t count = *value_count(axis);
  if (!std::holds_alternative<NamedChoices>(axis.values)) {
    return {value_at(axis, 0), value_at(axis, count - 1)};
  }
  std::vector<double> all;
  for (std::uint64_t i = 0; i < count; ++i) all.push_back(value_at(axis, i));
  return all;
}

/// The axes alone whose fields can be in conflict, each with all of its values or its ends only.
SweepSpace conflict_space(const SweepSpace& space, bool ends_only) {
  std::vector<SweepAxis> axes;
  for (const SweepAxis& axis : space.axes()) {
    if (!may_conflict(axis.name)) continue;
    axes.push_back(axis);
    if (ends_only) axes.back().values = ends_of(axis);
  }
  return SweepSpace(std::move(axes));
}

/// The fields in conflict somewhere in `space`, each with the first row's message; an axis's
/// refusal of a value stands under the empty name and ends the search. It ends as well when there
/// are `most`, or after `most_rows`.
std::map<std::string, std::string> conflicts_in(const SweepSpace& space, const Design& base,
                                                std::size_t most, std::uint64_t most_rows) {
  std::map<std::string, std::string> found;
  const std::uint64_t rows = std::min(space.rows(), most_rows);
  std::uint64_t row = 0;
  const auto told = [&](const std::string& message) {
    return space.sample() ? fmt::format("draw {} of {}: {}", row + 1, space.rows(), message)
                          : message;
  };
  try {
    SweepCursor cursor(space, base);
    for (; row < rows && found.size() < most; ++row) {
      cursor.move_to(row);
      for (const FieldConflict& conflict : find_conflicts(cursor.design())) {
        found.try_emplace(std::string(conflict.pointer), told(conflict.message));
      }
    }
  } catch (const std::invalid_argument& error) {
    found.try_emplace("", told(error.what()));
  }
  return found;
}

/// True where no draw from a normal axis can be a value that its field does not take.
bool normal_ends_are_allowed(const SweepSpace& space, Design design) {
  try {
    for (const SweepAxis& axis : space.axes()) {
      if (!std::holds_alternative<Normal>(axis.values)) continue;
      for (const double end : ends_of(axis)) axis.apply(design, end);
    }
  } catch (const std::invalid_argument&) {
    return false;
  }
  return true;
}

}  // namespace

std::vector<SweepAxis> read_axes(std::span<const std::string> texts, const DesignFile& base,
                                 AxisUse use) {
  Problems problems;
  std::vector<SweepAxis> axes;
  for (const std::string& text : texts) {
    auto axis = AxisReader(text, base, use, problems).read();
    if (!axis) continue;
    const bool repeated = std::ranges::count(axes, axis->name, &SweepAxis::name) > 0;
    const auto [option, verb] =
        use == AxisUse::searched ? std::pair{"--free ", "freed"} : std::pair{"--vary ", "varied"};
    if (repeated) problems.add(option + text, fmt::format("{} is {} twice", axis->name, verb));
    axes.push_back(std::move(*axis));
  }
  problems.throw_if_any();
  return axes;
}

void check_sweep_rows(const SweepSpace& space, const DesignFile& base, const std::string& option) {
  constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
  // Few draws of many axes are looked through sooner than the ends, each with each.
  const SweepSpace ends = conflict_space(space, true);
  const bool by_draws = space.sample() && ends.rows() > space.rows();
  std::map<std::string, std::string> at_ends;
  if (!by_draws) at_ends = conflicts_in(ends, base.design, all, all);
  std::size_t fields = at_ends.size();
  if (by_draws || !normal_ends_are_allowed(space, base.design)) fields = all;
  if (fields == 0) return;
  // An end is a row of the sweep, but no draw of a sample. The first row is told where it comes
  // soon.
  constexpr std::uint64_t soon = 1'000'000;
  auto found = space.sample()
                   ? conflicts_in(space, base.design, fields, all)
                   : conflicts_in(conflict_space(space, false), base.design, fields, soon);
  if (found.empty() && !space.sample()) found = at_ends;
  Problems problems;
  for (const auto& [field, message] : found) problems.add(option, message);
  problems.throw_if_any();
}

SampleMethod sample_method(const std::string& method) {
  if (method.empty() || method == "sobol") return SampleMethod::sobol;
  if (method == "lhs") return SampleMethod::latin_hypercube;
  throw InputError("--method",
                   fmt::format("\"{}\" is no way of sampling; allowed are sobol and lhs", method));
}

SweepSpace read_sweep_space(std::span<const std::string> texts, const DesignFile& base,
                            const std::optional<SampleRequest>& sample) {
  std::vector<SweepAxis> axes =
      read_axes(texts, base, sample ? AxisUse::sampled : AxisUse::enumerated);
  try {
    SweepSpace space =
        sample ? SweepSpace(std::move(axes),
                            SamplePlan{sample->draws, sample_method(sample->method), sample->seed})
               : SweepSpace(std::move(axes));
    check_sweep_rows(space, base);
    return space;
  } catch (const std::invalid_argument& error) {
    throw InputError("--vary", error.what());
  }
}

}  // namespace tethercalc
