#include "tethercalc/files/effect_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <muParser.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <utility>

#include "files/input_files.hpp"
#include "io/checked_values.hpp"
#include "io/closest_name.hpp"

namespace tethercalc {
namespace {

constexpr SpecField field(std::string_view pointer, FieldKind kind, std::string_view help,
                          std::string_view default_json = "") {
  SpecField described;
  described.pointer = pointer;
  described.kind = kind;
  described.help = help;
  described.default_json = default_json;
  return described;
}

constexpr std::array effect_fields{
    field("/id", FieldKind::text, "Name in results."),
    field("/title", FieldKind::text, "What a person calls it."),
    field("/mechanism", FieldKind::text, "One sentence."),
    field("/to_separate", FieldKind::text, "What would tell it from its like.", "\"\""),
    field("/force_N", FieldKind::text, "Formula of a force forward.", "\"\""),
    field("/power_W", FieldKind::text, "Formula of a power at the bus.", "\"\""),
    field("/parameters", FieldKind::motor_points, "List of objects."),
};

constexpr std::array parameter_fields{
    field("/name", FieldKind::text, "As in the formula."),
    field("/lower", FieldKind::number, "Least value there can be."),
    field("/upper", FieldKind::number, "Greatest value there can be."),
    field("/unit", FieldKind::text, "As printed.", "\"1\""),
    field("/neutral", FieldKind::number, "Value that changes nothing.", "0"),
    field("/scale", FieldKind::optional_number, "A change that matters.", "null"),
};

/// A formula over channels and parameters, whose values it holds.
class Formula {
 public:
  Formula(const std::string& text, std::span<const FormulaChannel> channels,
          const std::vector<EffectParameter>& parameters)
      : values_(channels.size() + parameters.size()) {
    std::size_t k = 0;
    for (const FormulaChannel& channel : channels) {
      parser_.DefineVar(std::string(channel.name), &values_[k++]);
    }
    for (const EffectParameter& p : parameters) parser_.DefineVar(p.name, &values_[k++]);
    parser_.SetExpr(text);
  }
  Formula(const Formula&) = delete;
  Formula& operator=(const Formula&) = delete;

  double at(std::span<const double> channels, std::span<const double> parameters) {
    std::copy(channels.begin(), channels.end(), values_.begin());
    std::copy(parameters.begin(), parameters.end(),
              values_.begin() + static_cast<std::ptrdiff_t>(channels.size()));
    return parser_.Eval();
  }
  /// Names in the formula that are neither channels nor parameters.
  [[nodiscard]] std::vector<std::string> unknown_names() {
    std::vector<std::string> unknown;
    for (const auto& [name, variable] : parser_.GetUsedVar()) {
      if (variable == nullptr) unknown.push_back(name);
    }
    return unknown;
  }

 private:
  mu::Parser parser_;
  std::vector<double> values_;
};

std::vector<std::string> names_of(std::span<const FormulaChannel> channels,
                                  const std::vector<EffectParameter>& parameters) {
  std::vector<std::string> names;
  for (const FormulaChannel& channel : channels) names.emplace_back(channel.name);
  for (const EffectParameter& p : parameters) names.push_back(p.name);
  return names;
}

/// A name that a formula can hold and that means nothing else there.
bool is_name(const std::string& text) {
  constexpr std::string_view letters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  return !text.empty() && text.find_first_not_of(letters) == std::string::npos &&
         !(text[0] >= '0' && text[0] <= '9');
}

std::optional<EffectParameter> read_parameter(const JsonPlace& place, Problems& problems) {
  const std::size_t before = problems.count();
  const std::vector<JsonPlace> at = field_places(place, parameter_fields, problems);
  const auto number = [&](std::size_t field) {
    return checked_number(at[field], parameter_fields[field], problems);
  };
  EffectParameter p;
  p.name = checked_text(at[0], problems);
  const auto lower = number(1);
  const auto upper = number(2);
  p.unit = at[3].given() ? checked_text(at[3], problems) : "1";
  p.neutral = number(4).value_or(0);
  const auto scale = number(5);
  if (problems.count() > before) return std::nullopt;
  if (!is_name(p.name)) {
    return problems.refuse(at[0].where(), fmt::format("\"{}\" is no name that a formula can hold; "
                                                      "allowed are letters, digits and _",
                                                      p.name));
  }
  p.lower = *lower;
  p.upper = *upper;
  p.scale = scale.value_or((p.upper - p.lower) / 100);
  return p;
}

std::vector<EffectParameter> read_parameters(const JsonPlace& list, LogKind kind,
                                             Problems& problems) {
  std::vector<EffectParameter> parameters;
  if (!list.given()) return parameters;
  if (!list.value->is_array()) {
    problems.add(list.where(), "expected a list of objects, found " + type_name(*list.value));
    return parameters;
  }
  for (std::size_t i = 0; i < list.value->size(); ++i) {
    auto p = read_parameter(list.element(i), problems);
    if (!p) continue;
    const std::vector<std::string> taken = names_of(formula_channels(kind), parameters);
    if (std::find(taken.begin(), taken.end(), p->name) != taken.end()) {
      problems.add(
          list.element(i).where(),
          fmt::format("\"{}\" is the name of a channel, or of another parameter", p->name));
      continue;
    }
    parameters.push_back(std::move(*p));
  }
  return parameters;
}

/// Whether the formula sets a name to a value, where it may have meant to compare.
bool assigns(const std::string& formula) {
  for (std::size_t i = formula.find('='); i != std::string::npos; i = formula.find('=', i + 1)) {
    if (formula.substr(i).starts_with("==")) {
      ++i;
    } else if (i == 0 || std::string_view("<>!").find(formula[i - 1]) == std::string_view::npos) {
      return true;
    }
  }
  return false;
}

/// The formula as something to call; nothing, with the reason among the problems, where it is none.
decltype(Hypothesis::formula) read_formula(const JsonPlace& place, const Hypothesis& hypothesis,
                                           Problems& problems) {
  const auto channels = formula_channels(hypothesis.log);
  if (assigns(hypothesis.words)) {
    problems.add(place.where(),
                 fmt::format("\"{}\" sets a value with =; to compare write ==", hypothesis.words));
    return {};
  }
  try {
    const auto formula =
        std::make_shared<Formula>(hypothesis.words, channels, hypothesis.parameters);
    const std::vector<std::string> known = names_of(channels, hypothesis.parameters);
    for (const std::string& name : formula->unknown_names()) {
      problems.add(place.where(),
                   fmt::format("\"{}\" is neither a channel nor a parameter, which are {}{}", name,
                               fmt::join(known, ", "), did_you_mean(name, known)));
      return {};
    }
    return [formula](std::span<const double> at, std::span<const double> parameters) {
      return formula->at(at, parameters);
    };
  } catch (const mu::Parser::exception_type& error) {
    problems.add(place.where(),
                 fmt::format("\"{}\" is no formula: {}", hypothesis.words, error.GetMsg()));
    return {};
  }
}

std::optional<Effect> read_effect(const JsonPlace& object, Problems& problems) {
  const std::size_t before = problems.count();
  const std::vector<JsonPlace> at = field_places(object, effect_fields, problems);
  if (problems.count() > before) return std::nullopt;
  Hypothesis hypothesis{.id = checked_text(at[0], problems),
                        .title = checked_text(at[1], problems),
                        .mechanism = checked_text(at[2], problems),
                        .to_separate = checked_text(at[3], problems)};
  if (at[4].given() == at[5].given()) {
    return problems.refuse(object.where(),
                           "needs one formula: force_N of a flight, or power_W of a power log");
  }
  hypothesis.log = at[4].given() ? LogKind::flight : LogKind::power;
  const JsonPlace& formula = at[4].given() ? at[4] : at[5];
  hypothesis.words = checked_text(formula, problems);
  if (!is_name(hypothesis.id)) {
    problems.add(at[0].where(),
                 fmt::format("\"{}\" is no id; allowed are letters, digits and _", hypothesis.id));
  }
  hypothesis.parameters = read_parameters(at[6], hypothesis.log, problems);
  if (problems.count() > before) return std::nullopt;
  hypothesis.formula = read_formula(formula, hypothesis, problems);
  if (!hypothesis.formula) return std::nullopt;
  try {
    return effect_of(hypothesis);
  } catch (const std::invalid_argument& error) {
    return problems.refuse(object.where(), error.what());
  } catch (const mu::Parser::exception_type& error) {
    return problems.refuse(
        formula.where(), fmt::format("\"{}\" is no formula: {}", hypothesis.words, error.GetMsg()));
  }
}

}  // namespace

std::vector<Effect> read_effects(const std::string& path) {
  const LoadedText file = read_text_file(path);
  const JsonDocument document = parse_json(file.text, file.name);
  Problems problems;
  problems.add(document.problems);
  const JsonPlace root{&document, &document.root, ""};
  std::vector<Effect> effects;
  const auto add = [&](const JsonPlace& object) {
    auto effect = read_effect(object, problems);
    if (!effect) return;
    const bool again = std::any_of(effects.begin(), effects.end(),
                                   [&](const Effect& other) { return other.id == effect->id; });
    if (again) {
      problems.add(object.where(), fmt::format("\"{}\" is the id of another effect", effect->id));
    } else {
      effects.push_back(std::move(*effect));
    }
  };
  if (root.value->is_array()) {
    if (root.value->empty()) problems.add(root.where(), "holds no effect");
    for (std::size_t i = 0; i < root.value->size(); ++i) add(root.element(i));
  } else {
    add(root);
  }
  problems.throw_if_any();
  return effects;
}

std::vector<Effect> read_effect_files(std::span<const std::string> paths) {
  std::vector<Effect> effects;
  for (const std::string& path : paths) {
    for (Effect& effect : read_effects(path)) {
      const auto same = std::find_if(effects.begin(), effects.end(),
                                     [&](const Effect& other) { return other.id == effect.id; });
      if (same != effects.end()) {
        throw InputError(path, fmt::format("\"{}\" is an effect of another file, too", effect.id));
      }
      effects.push_back(std::move(effect));
    }
  }
  return effects;
}

}  // namespace tethercalc
