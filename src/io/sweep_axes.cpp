#include "tethercalc/io/sweep_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "io/checked_values.hpp"
#include "io/closest_name.hpp"
#include "tethercalc/io/library.hpp"
#include "tethercalc/io/spec_fields.hpp"

namespace tethercalc {
namespace {

/// Whole numbers up to here, and no further, are all exact in double.
constexpr std::int64_t exact_limit = std::int64_t{1} << 53;

// --- A quantity that can vary ---------------------------------------------------------------

/// A number of a material, which specs hold in an object of their own.
struct MaterialNumber {
  std::string_view pointer;
  double& (*access)(Design&);
};

constexpr std::array material_numbers{
    MaterialNumber{"/tether/conductor/resistivity_20C_ohm_mm2_per_m",
                   [](Design& d) -> double& { return d.tether.conductor.resistivity_20C; }},
    MaterialNumber{"/tether/conductor/temperature_coefficient_per_K",
                   [](Design& d) -> double& { return d.tether.conductor.temperature_coefficient; }},
    MaterialNumber{"/tether/conductor/density_g_cm3",
                   [](Design& d) -> double& { return d.tether.conductor.density; }},
    MaterialNumber{"/tether/insulation/material/density_g_cm3",
                   [](Design& d) -> double& { return d.tether.insulation.density; }}};

std::optional<SpecField> find_material_number(std::string_view path) {
  const std::string wanted = dot_path(path);
  for (const MaterialNumber& number : material_numbers) {
    if (dot_path(number.pointer) != wanted) continue;
    for (const auto fields : {conductor_fields(), insulation_fields()}) {
      for (SpecField field : fields) {
        if (!number.pointer.ends_with(field.pointer)) continue;
        field.pointer = number.pointer;
        field.access = number.access;
        return field;
      }
    }
  }
  return std::nullopt;
}

// --- Numbers ---------------------------------------------------------------------------------

std::optional<double> parsed_number(std::string_view text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stopped != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

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

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

// --- One axis ----------------------------------------------------------------------------------

template <typename T>
void assign(T& target, const T& value) {
  target = value;
}

/// The material changes, the wall that the spec asks for stays.
void assign(Insulation& target, const Insulation& material) {
  const double thickness = target.thickness;
  const double safety_factor = target.dielectric_safety_factor;
  target = material;
  target.thickness = thickness;
  target.dielectric_safety_factor = safety_factor;
}

/// Reads one "path=values".
class AxisReader {
 public:
  AxisReader(const std::string& text, const DesignFile& base, bool sampled, Problems& problems)
      : option_("--vary " + text),
        text_(text),
        base_(base),
        sampled_(sampled),
        problems_(problems) {}

  std::optional<SweepAxis> read() {
    const std::size_t equals = text_.find('=');
    if (equals == std::string_view::npos || equals == 0) {
      return refuse("expected path=values, such as supply.voltage_V=40:100:5");
    }
    const std::string_view path = text_.substr(0, equals);
    const std::string_view values = text_.substr(equals + 1);
    if (values.empty()) return refuse("no values after the \"=\"");
    const SpecField* field = find_field(path);
    if (const auto material = find_material_number(path)) return number_axis(*material, values);
    if (field == nullptr) {
      const auto closest = closest_field_path(path);
      return refuse(fmt::format("no field {} in a spec{}", shown(std::string(path)),
                                closest ? "; did you mean \"" + *closest + "\"?" : ""));
    }
    switch (field->kind) {
      case FieldKind::number:
      case FieldKind::optional_number:
      case FieldKind::integer:
      case FieldKind::efficiency:
        return number_axis(*field, values);
      case FieldKind::boolean:
        return switch_axis(*field, values);
      case FieldKind::condition:
        return condition_axis(*field, values);
      case FieldKind::motor:
        return entry_axis<MotorEntry, MotorCurve& (*)(Design&)>(
            *field, values, library_motors, find_motor,
            [](const MotorEntry& motor) { return motor.curve; });
      case FieldKind::conductor:
        return entry_axis<ConductorEntry, Conductor& (*)(Design&)>(
            *field, values, library_conductors, find_conductor,
            [](const ConductorEntry& entry) { return entry.conductor; });
      case FieldKind::insulation_material:
        return entry_axis<InsulationEntry, Insulation& (*)(Design&)>(
            *field, values, library_insulation, find_insulation, [](const InsulationEntry& entry) {
              Insulation material;
              material.density = entry.density;
              material.thermal_conductivity = entry.thermal_conductivity.value_or(0);
              material.rated_temperature_C = entry.rated_temperature_C;
              material.breakdown_strength = entry.breakdown_strength.value_or(0);
              return material;
            });
      case FieldKind::strength_material:
      case FieldKind::converter_masses:
        return refuse("a sweep cannot vary this field");
      default:
        return refuse("this field does not change the result");
    }
  }

 private:
  std::optional<SweepAxis> refuse(std::string message) {
    problems_.add(option_, std::move(message));
    return std::nullopt;
  }

  std::optional<double> number(std::string_view text) {
    const auto value = parsed_number(text);
    if (!value) refuse(fmt::format("{} is not a number", shown(std::string(text))));
    return value;
  }

  bool allowed(const SpecField& field, double value) {
    if (field.range.contains(value)) return true;
    refuse(fmt::format("{} is not allowed: it must be {}", value, describe_range(field)));
    return false;
  }

  bool whole(const SpecField& field, double value) {
    if (field.kind != FieldKind::integer || value == std::floor(value)) return true;
    refuse(fmt::format("{} is not allowed: it must be a whole number", value));
    return false;
  }

  std::optional<SweepAxis> number_axis(const SpecField& field, std::string_view text) {
    SweepAxis axis;
    axis.name = dot_path(field.pointer);
    axis.apply = [field](Design& design, double value) { set_field(design, field, value); };
    const bool read = text.find('~') != text.npos    ? read_normal(axis, field, text)
                      : text.find("..") != text.npos ? read_uniform(axis, field, text)
                      : text.find(':') != text.npos  ? read_range(axis, field, text)
                                                     : read_list(axis, field, text);
    if (!read) return std::nullopt;
    return axis;
  }

  bool read_list(SweepAxis& axis, const SpecField& field, std::string_view text) {
    std::vector<double> list;
    bool good = true;
    for (const std::string_view part : split(text, ',')) {
      const auto value = number(part);
      good = value && allowed(field, *value) && whole(field, *value) && good;
      if (value) list.push_back(*value);
    }
    axis.values = std::move(list);
    return good;
  }

  bool read_range(SweepAxis& axis, const SpecField& field, std::string_view text) {
    const auto parts = split(text, ':');
    if (parts.size() != 3) {
      refuse("a range is from:to:step, such as 40:100:5");
      return false;
    }
    std::array<Decimal, 3> written;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!number(parts[i])) return false;
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
      refuse(fmt::format("steps of {} do not lead from {} to {}", parts[2], parts[0], parts[1]));
      return false;
    }
    const auto count = static_cast<std::uint64_t>((to - from) / step) + 1;
    axis.values = DecimalRange{from, step, count, places};
    const double first = value_at(axis, 0);
    const double last = value_at(axis, count - 1);
    // Equal steps between whole ends need not be whole, but then the second value is not.
    return allowed(field, first) && (count == 1 || allowed(field, last)) && whole(field, first) &&
           (count == 1 || whole(field, value_at(axis, 1)));
  }

  bool too_many_digits(std::string_view text) {
    refuse(fmt::format("{} has more digits than can be stepped through exactly", text));
    return false;
  }

  bool drawing_allowed() {
    if (!sampled_) {
      refuse("can only be drawn, not enumerated: add --sample N, or write from:to:step");
    }
    return sampled_;
  }

  bool read_uniform(SweepAxis& axis, const SpecField& field, std::string_view text) {
    const std::size_t dots = text.find("..");
    const auto lo = number(text.substr(0, dots));
    const auto hi = number(text.substr(dots + 2));
    if (!lo || !hi || !drawing_allowed()) return false;
    if (!(*lo < *hi)) {
      refuse(fmt::format("the lower end {} must be below the upper end {}", *lo, *hi));
      return false;
    }
    if (field.kind == FieldKind::integer) {
      if (!whole(field, *lo) || !whole(field, *hi)) return false;
      axis.values = UniformInteger{static_cast<std::int64_t>(*lo), static_cast<std::int64_t>(*hi)};
    } else {
      axis.values = Uniform{*lo, *hi};
    }
    const bool lo_allowed = allowed(field, *lo);
    return allowed(field, *hi) && lo_allowed;
  }

  bool read_normal(SweepAxis& axis, const SpecField& field, std::string_view text) {
    const std::size_t tilde = text.find('~');
    const auto mean = number(text.substr(0, tilde));
    const auto deviation = number(text.substr(tilde + 1));
    if (!mean || !deviation || !drawing_allowed()) return false;
    if (!(*deviation > 0)) {
      refuse(fmt::format("the standard deviation {} must be positive", *deviation));
      return false;
    }
    if (field.kind == FieldKind::integer) {
      refuse("whole numbers have no normal distribution: write lo..hi or a list");
      return false;
    }
    axis.values = Normal{*mean, *deviation};
    return allowed(field, *mean);
  }

  std::optional<SweepAxis> switch_axis(const SpecField& field, std::string_view text) {
    auto* const access = std::get<bool& (*)(Design&)>(field.access);
    return chosen_axis<bool>(field, text, {{"false", false}, {"true", true}}, access);
  }

  std::optional<SweepAxis> condition_axis(const SpecField& field, std::string_view text) {
    auto* const access = std::get<Condition& (*)(Design&)>(field.access);
    return chosen_axis<Condition>(
        field, text, {{"hover", Condition::hover}, {"forward", Condition::forward}}, access);
  }

  template <class T>
  std::optional<SweepAxis> chosen_axis(const SpecField& field, std::string_view text,
                                       const std::vector<std::pair<std::string, T>>& known,
                                       T& (*access)(Design&)) {
    NamedChoices choices;
    std::vector<T> chosen;
    std::vector<std::string> names;
    for (const auto& [name, value] : known) names.push_back(name);
    bool good = true;
    for (const std::string_view part : split(text, ',')) {
      const auto found = std::find(names.begin(), names.end(), part);
      if (found == names.end()) {
        refuse(fmt::format("expected {} or {}, found {}{}", names[0], names[1],
                           shown(std::string(part)), did_you_mean(part, names)));
        good = false;
        continue;
      }
      choices.names.push_back(*found);
      chosen.push_back(known[static_cast<std::size_t>(found - names.begin())].second);
    }
    if (!good) return std::nullopt;
    return SweepAxis{dot_path(field.pointer), std::move(choices),
                     [access, chosen](Design& design, double position) {
                       access(design) = chosen[static_cast<std::size_t>(position)];
                     }};
  }

  template <class Entry, class Access, class List, class Find, class Part>
  std::optional<SweepAxis> entry_axis(const SpecField& field, std::string_view text,
                                      const List& library, const Find& find, const Part& part_of) {
    using Value = decltype(part_of(std::declval<Entry>()));
    NamedChoices choices;
    std::vector<Value> values;
    const auto add = [&](std::string name, const Entry& entry) {
      choices.names.push_back(std::move(name));
      values.push_back(part_of(entry));
    };
    const std::size_t before = problems_.count();
    if (text == "all") {
      for (const Entry& entry : library()) add(entry.id, entry);
    } else {
      for (const std::string_view name : split(text, ',')) {
        try {
          add(std::string(name), find(std::string(name), base_.folder, option_));
        } catch (const InputError& error) {
          problems_.add(error.problems());
        }
      }
    }
    if (problems_.count() > before) return std::nullopt;
    auto* const access = std::get<Access>(field.access);
    return SweepAxis{dot_path(field.pointer), std::move(choices),
                     [access, values](Design& design, double position) {
                       assign(access(design), values[static_cast<std::size_t>(position)]);
                     }};
  }

  std::string option_;
  std::string_view text_;
  const DesignFile& base_;
  bool sampled_;
  Problems& problems_;
};

// --- All rows ------------------------------------------------------------------------------------

/// The numbers between which all values of an axis lie.
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
  const std::uint64_t last = *value_count(axis) - 1;
  return {value_at(axis, 0), value_at(axis, last)};
}

/// True where the ends of the axes, each with each, make designs that are allowed. Conflicts exist
/// only between fields of the supply, and only between numbers; within the ends of those nothing
/// else can go wrong.
bool ends_are_allowed(const SweepSpace& space, const Design& base) {
  std::vector<const SweepAxis*> supply;
  for (const SweepAxis& axis : space.axes()) {
    if (axis.name.starts_with("supply.")) {
      supply.push_back(&axis);
    } else if (std::holds_alternative<Normal>(axis.values)) {
      Design design = base;
      try {
        for (const double end : ends_of(axis)) axis.apply(design, end);
      } catch (const std::invalid_argument&) {
        return false;
      }
    }
  }
  for (std::size_t corner = 0; corner < (std::size_t{1} << supply.size()); ++corner) {
    Design design = base;
    try {
      for (std::size_t i = 0; i < supply.size(); ++i) {
        supply[i]->apply(design, ends_of(*supply[i])[(corner >> i) & 1]);
      }
    } catch (const std::invalid_argument&) {
      return false;
    }
    if (!find_conflicts(design).empty()) return false;
  }
  return true;
}

/// The space of the supply's axes alone, whose rows are the only ones of a product that can be in
/// conflict.
SweepSpace supply_space(const SweepSpace& space) {
  std::vector<SweepAxis> supply;
  for (const SweepAxis& axis : space.axes()) {
    if (axis.name.starts_with("supply.")) supply.push_back(axis);
  }
  return SweepSpace(std::move(supply));
}

/// Throws where a row of `space` is not allowed.
void walk(const SweepSpace& space, const Design& base) {
  std::uint64_t row = 0;
  const auto refuse = [&](const std::string& message) {
    throw InputError({{"--vary", space.sample() ? fmt::format("draw {} of {}: {}", row + 1,
                                                              space.rows(), message)
                                                : message}});
  };
  try {
    SweepCursor cursor(space, base);
    for (; row < space.rows(); ++row) {
      cursor.move_to(row);
      const auto conflicts = find_conflicts(cursor.design());
      if (!conflicts.empty()) refuse(conflicts.front().message);
    }
  } catch (const std::invalid_argument& error) {
    refuse(error.what());
  }
}

}  // namespace

std::vector<SweepAxis> read_sweep_axes(std::span<const std::string> varied, const DesignFile& base,
                                       bool sampled) {
  Problems problems;
  std::vector<SweepAxis> axes;
  for (const std::string& text : varied) {
    auto axis = AxisReader(text, base, sampled, problems).read();
    if (!axis) continue;
    const bool repeated = std::any_of(
        axes.begin(), axes.end(), [&](const SweepAxis& other) { return other.name == axis->name; });
    if (repeated) problems.add("--vary " + text, axis->name + " is varied twice");
    axes.push_back(std::move(*axis));
  }
  problems.throw_if_any();
  return axes;
}

void check_sweep_rows(const SweepSpace& space, const DesignFile& base) {
  if (ends_are_allowed(space, base.design)) return;
  walk(space.sample() ? space : supply_space(space), base.design);
}

}  // namespace tethercalc
