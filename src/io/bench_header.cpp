#include "io/bench_header.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "io/letters.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

struct BenchUnit {
  std::string_view name;  ///< in lower case
  BenchQuantity quantity;
  double factor;
};

constexpr double grams_per_newton = 1 / unit::gram_force;
constexpr double grams_per_pound = 453.59237;  // international avoirdupois pound
constexpr double grams_per_ounce = grams_per_pound / 16;

// Longer names of the same ending first: "kg" ends in "g".
constexpr std::array units{
    BenchUnit{"gf per w", BenchQuantity::efficiency, 1},
    BenchUnit{"g per w", BenchQuantity::efficiency, 1},
    BenchUnit{"gf/w", BenchQuantity::efficiency, 1},
    BenchUnit{"kgf/kw", BenchQuantity::efficiency, 1},
    BenchUnit{"kg/kw", BenchQuantity::efficiency, 1},
    BenchUnit{"kgf/w", BenchQuantity::efficiency, 1000},
    BenchUnit{"kg/w", BenchQuantity::efficiency, 1000},
    BenchUnit{"g/w", BenchQuantity::efficiency, 1},
    BenchUnit{"lbf/w", BenchQuantity::efficiency, grams_per_pound},
    BenchUnit{"lb/w", BenchQuantity::efficiency, grams_per_pound},
    BenchUnit{"n/w", BenchQuantity::efficiency, grams_per_newton},
    BenchUnit{"kgf", BenchQuantity::thrust, 1000},
    BenchUnit{"kg", BenchQuantity::thrust, 1000},
    BenchUnit{"kp", BenchQuantity::thrust, 1000},
    BenchUnit{"grams", BenchQuantity::thrust, 1},
    BenchUnit{"gram", BenchQuantity::thrust, 1},
    BenchUnit{"gf", BenchQuantity::thrust, 1},
    BenchUnit{"g", BenchQuantity::thrust, 1},
    BenchUnit{"newton", BenchQuantity::thrust, grams_per_newton},
    BenchUnit{"n", BenchQuantity::thrust, grams_per_newton},
    BenchUnit{"lbf", BenchQuantity::thrust, grams_per_pound},
    BenchUnit{"lbs", BenchQuantity::thrust, grams_per_pound},
    BenchUnit{"lb", BenchQuantity::thrust, grams_per_pound},
    BenchUnit{"ozf", BenchQuantity::thrust, grams_per_ounce},
    BenchUnit{"oz", BenchQuantity::thrust, grams_per_ounce},
    BenchUnit{"kw", BenchQuantity::power, 1000},
    BenchUnit{"watts", BenchQuantity::power, 1},
    BenchUnit{"watt", BenchQuantity::power, 1},
    BenchUnit{"w", BenchQuantity::power, 1},
    BenchUnit{"mv", BenchQuantity::voltage, 1e-3},
    BenchUnit{"volts", BenchQuantity::voltage, 1},
    BenchUnit{"volt", BenchQuantity::voltage, 1},
    BenchUnit{"v", BenchQuantity::voltage, 1},
    BenchUnit{"ma", BenchQuantity::current, 1e-3},
    BenchUnit{"amps", BenchQuantity::current, 1},
    BenchUnit{"amp", BenchQuantity::current, 1},
    BenchUnit{"a", BenchQuantity::current, 1},
    BenchUnit{"percent", BenchQuantity::throttle, 1},
    BenchUnit{"%", BenchQuantity::throttle, 1},
    BenchUnit{"µs", BenchQuantity::throttle, 1},
    BenchUnit{"us", BenchQuantity::throttle, 1},
};

/// Words for a quantity, qualifiers left out.
constexpr std::array<std::pair<std::string_view, BenchQuantity>, 22> quantity_words{{
    {"thrust", BenchQuantity::thrust},         {"thrust force", BenchQuantity::thrust},
    {"pull", BenchQuantity::thrust},           {"lift", BenchQuantity::thrust},
    {"schub", BenchQuantity::thrust},          {"standschub", BenchQuantity::thrust},
    {"power", BenchQuantity::power},           {"power in", BenchQuantity::power},
    {"leistung", BenchQuantity::power},        {"efficiency", BenchQuantity::efficiency},
    {"eff", BenchQuantity::efficiency},        {"effizienz", BenchQuantity::efficiency},
    {"voltage", BenchQuantity::voltage},       {"spannung", BenchQuantity::voltage},
    {"current", BenchQuantity::current},       {"strom", BenchQuantity::current},
    {"throttle", BenchQuantity::throttle},     {"gas", BenchQuantity::throttle},
    {"esc", BenchQuantity::throttle},          {"esc signal", BenchQuantity::throttle},
    {"esc throttle", BenchQuantity::throttle}, {"pwm", BenchQuantity::throttle},
}};

/// Words before a quantity that leave it what it is.
constexpr std::array<std::string_view, 11> qualifiers{"electrical", "electric", "input", "static",
                                                      "measured",   "average",  "avg",   "mean",
                                                      "overall",    "total",    "dc"};

/// Blanks, and what stands for them in headers, as single blanks; none at the ends.
std::string spaced(std::string_view text) {
  constexpr std::string_view separators = " \t\r\n_:,;.-";
  std::string out;
  for (const char c : text) {
    if (separators.find(c) == std::string_view::npos) {
      out += c;
    } else if (!out.empty() && out.back() != ' ') {
      out += ' ';
    }
  }
  if (out.ends_with(' ')) out.pop_back();
  return out;
}

/// A header's cell taken apart.
struct HeaderParts {
  std::string words;  ///< in lower case, single blanks between
  std::string unit;   ///< likewise; empty where there is none
};

const BenchUnit* unit_at_end(const std::string& text) {
  const auto found = std::ranges::find_if(units, [&](const BenchUnit& unit) {
    return text == unit.name || text.ends_with(" " + std::string(unit.name));
  });
  return found == units.end() ? nullptr : &*found;
}

HeaderParts parts_of(std::string_view header) {
  const std::string text = lower_case(header);
  const std::size_t open = text.find_last_of("([");
  if (open != std::string::npos) {
    const std::size_t close = text.find_first_of(")]", open);
    return {spaced(std::string_view(text).substr(0, open)),
            spaced(std::string_view(text).substr(
                open + 1, close == std::string::npos ? std::string::npos : close - open - 1))};
  }
  std::string all = spaced(text);
  const BenchUnit* unit = unit_at_end(all);
  if (unit == nullptr) {
    // "Thrust/g"
    const std::size_t slash = all.find('/');
    if (slash == std::string::npos) return {all, ""};
    return {spaced(all.substr(0, slash)), spaced(all.substr(slash + 1))};
  }
  std::string before = spaced(all.substr(0, all.size() - unit->name.size()));
  if (before.ends_with('/')) before = spaced(before.substr(0, before.size() - 1));  // "Thrust / g"
  return {before, std::string(unit->name)};
}

std::string without_qualifiers(std::string text) {
  for (bool found = true; found;) {
    found = false;
    for (const std::string_view qualifier : qualifiers) {
      const std::string first = std::string(qualifier) + " ";
      if (!text.starts_with(first)) continue;
      text.erase(0, first.size());
      found = true;
    }
  }
  return text;
}

ThrottleUnit throttle_unit_of(std::string_view unit) {
  if (unit == "percent" || unit == "%") return ThrottleUnit::percent;
  return unit == "us" || unit == "µs" ? ThrottleUnit::microseconds : ThrottleUnit::unknown;
}

}  // namespace

std::optional<BenchColumnMeaning> bench_column_meaning(std::string_view header) {
  const HeaderParts parts = parts_of(header);
  const auto unit = std::ranges::find(units, parts.unit, &BenchUnit::name);
  const std::string name = without_qualifiers(parts.words);
  if (name.empty()) {  // "Watts": the unit says it all, where it is spelt out
    const bool spelt_out =
        parts.unit.size() >= 3 && unit != units.end() &&
        (unit->quantity == BenchQuantity::power || unit->quantity == BenchQuantity::voltage ||
         unit->quantity == BenchQuantity::current);
    return spelt_out ? std::optional(
                           BenchColumnMeaning{unit->quantity, unit->factor, ThrottleUnit::unknown})
                     : std::nullopt;
  }
  const auto word =
      std::ranges::find(quantity_words, name, &std::pair<std::string_view, BenchQuantity>::first);
  if (word == quantity_words.end()) return std::nullopt;
  // A throttle may be in any unit: mostly it only tells which rows belong together.
  if (word->second == BenchQuantity::throttle) {
    return BenchColumnMeaning{BenchQuantity::throttle, 1, throttle_unit_of(parts.unit)};
  }
  if (unit == units.end() || unit->quantity != word->second) return std::nullopt;
  return BenchColumnMeaning{unit->quantity, unit->factor, ThrottleUnit::unknown};
}

std::string bench_column_words(std::string_view header) { return parts_of(header).words; }

std::string_view bench_quantity_name(BenchQuantity quantity) {
  constexpr std::array<std::string_view, 6> names{"thrust_g",  "power_W",   "efficiency_g_per_W",
                                                  "voltage_V", "current_A", "throttle_percent"};
  return names[static_cast<std::size_t>(quantity)];
}

}  // namespace tethercalc
