#include "tethercalc/report/design_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "io/closest_name.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/report/cable_report.hpp"
#include "tethercalc/report/csv_cell.hpp"
#include "tethercalc/report/json_results.hpp"
#include "tethercalc/report/operating_point_fields.hpp"

namespace tethercalc {
namespace {

using nlohmann::ordered_json;

/// A constraint closer than this to its bound, relative, binds.
constexpr double binding = 1e-6;

std::optional<double> number_of(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

std::vector<std::string> parts_of(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

/// A free field with the JSON values of its alternatives, for the ready spec.
struct FreeField {
  const SpecField* field = nullptr;
  bool is_range = false;
  std::vector<ordered_json> values;
};

/// Turns a request into a problem.
class ProblemReader {
 public:
  ProblemReader(const DesignFile& file, const DesignRequest& request)
      : file_(file), request_(request) {
    problem.base = file.design;
  }

  DesignProblem problem;
  std::vector<FreeField> range_fields;   ///< as problem.ranges
  std::vector<FreeField> choice_fields;  ///< as problem.choices

  void read() {
    for (const std::string& text : request_.free) attempt([&] { read_free(text); });
    attempt([&] { read_standard(); });
    attempt([&] {
      problem.objective =
          candidate_quantity(request_.minimize, file_.design, "--minimize " + request_.minimize);
    });
    for (const std::string& text : request_.subject_to) attempt([&] { read_limit(text); });
    if (!problems_.empty()) throw InputError(std::move(problems_));
    if (request_.free.empty() && request_.standard.empty()) {
      throw InputError("--free", "is needed: which fields may the search change?");
    }
    add_lower_bound();
  }

 private:
  template <typename Step>
  void attempt(Step step) {
    try {
      step();
    } catch (const InputError& error) {
      problems_.insert(problems_.end(), error.problems().begin(), error.problems().end());
    }
  }

  void read_free(const std::string& text) {
    const std::string where = "--free " + text;
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
      throw InputError(where,
                       "expected PATH=lo..hi or PATH=a,b,c, such as supply.voltage_V=40..400");
    }
    const std::string path = text.substr(0, equals);
    const std::string rest = text.substr(equals + 1);
    const SpecField* field = find_field(path);
    if (field == nullptr) {
      const auto closest = closest_field_path(path);
      throw InputError(where, fmt::format("no field \"{}\" in a spec{}", path,
                                          closest ? "; did you mean \"" + *closest + "\"?" : ""));
    }
    const std::size_t dots = rest.find("..");
    if (dots != std::string::npos && is_numeric(*field)) {
      return read_range(where, *field, rest.substr(0, dots), rest.substr(dots + 2));
    }
    read_choice(where, *field, rest);
  }

  void check(const std::string& where, const SpecField& field, double value) {
    Design copy = file_.design;
    try {
      set_field(copy, field, value);
    } catch (const std::invalid_argument& error) {
      throw InputError(where, error.what());
    }
  }

  void read_range(const std::string& where, const SpecField& field, const std::string& lo_text,
                  const std::string& hi_text) {
    const auto lo = number_of(lo_text);
    const auto hi = number_of(hi_text);
    if (!lo || !hi || !(*lo <= *hi)) {
      throw InputError(where, "expected two numbers, the smaller one first: lo..hi");
    }
    check(where, field, *lo);
    check(where, field, *hi);
    const SpecField* pointer = &field;
    if (field.kind == FieldKind::integer) {
      std::string list;
      for (double value = *lo; value <= *hi; ++value) list += fmt::format(",{}", value);
      return read_choice(where, field, list.substr(1));
    }
    problem.ranges.push_back({dot_path(field.pointer), {*lo, *hi}, [pointer](Design& d, double x) {
                                set_field(d, *pointer, x);
                              }});
    range_fields.push_back({pointer, true, {}});
  }

  void add_number(const std::string& where, const SpecField& field, double value, std::string label,
                  FreeChoice& choice, FreeField& values) {
    check(where, field, value);
    const SpecField* pointer = &field;
    choice.alternatives.push_back(
        {std::move(label), [pointer, value](Design& d) { set_field(d, *pointer, value); }});
    values.values.emplace_back(value);
  }

  void read_choice(const std::string& where, const SpecField& field, const std::string& list) {
    FreeChoice choice{dot_path(field.pointer), {}};
    FreeField values{&field, false, {}};
    std::vector<std::string> items = parts_of(list, ',');
    if (field.kind == FieldKind::motor && list == "all") {
      items.clear();
      for (const MotorEntry& motor : library_motors()) items.push_back(motor.id);
    }
    for (const std::string& item : items) {
      if (field.kind == FieldKind::motor) {
        const MotorCurve curve = find_motor(item, file_.folder, where).curve;
        choice.alternatives.push_back({item, [curve](Design& d) { d.drone.motor = curve; }});
        values.values.emplace_back(item);
      } else if (field.kind == FieldKind::conductor) {
        const Conductor conductor = find_conductor(item, file_.folder, where).conductor;
        choice.alternatives.push_back(
            {item, [conductor](Design& d) { d.tether.conductor = conductor; }});
        values.values.emplace_back(item);
      } else if (field.kind == FieldKind::insulation_material) {
        const InsulationEntry material = find_insulation(item, file_.folder, where);
        choice.alternatives.push_back(
            {item, [material](Design& d) { apply_material(d.tether.insulation, material); }});
        values.values.emplace_back(item);
      } else if (const auto number = number_of(item); number && is_numeric(field)) {
        add_number(where, field, *number, item, choice, values);
      } else {
        throw InputError(
            where, fmt::format("\"{}\" cannot be chosen for {}", item, dot_path(field.pointer)));
      }
    }
    problem.choices.push_back(std::move(choice));
    choice_fields.push_back(std::move(values));
  }

  static void apply_material(Insulation& insulation, const InsulationEntry& material) {
    insulation.density = material.density;
    insulation.rated_temperature_C = material.rated_temperature_C;
    insulation.thermal_conductivity = material.thermal_conductivity.value_or(0);
    insulation.breakdown_strength = material.breakdown_strength.value_or(0);
  }

  void read_standard() {
    if (request_.standard.empty()) return;
    const std::string where = "--standard " + request_.standard;
    if (request_.standard != "awg" && request_.standard != "iec") {
      throw InputError(where, "allowed are awg and iec");
    }
    const std::string name = request_.standard == "awg" ? "AWG" : "IEC 60228";
    const SpecField& field = *find_field("tether.cross_section_mm2");
    VariableRange range{0, 1000};
    for (std::size_t i = 0; i < problem.ranges.size(); ++i) {
      if (range_fields[i].field != &field) continue;
      range = problem.ranges[i].range;
      problem.ranges.erase(problem.ranges.begin() + static_cast<std::ptrdiff_t>(i));
      range_fields.erase(range_fields.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
    FreeChoice choice{dot_path(field.pointer), {}};
    FreeField values{&field, false, {}};
    for (const WireSize& size : wire_sizes()) {
      const double mm2 = size.area / unit::square_millimetre;
      if (size.standard != name || mm2 < range.lo || mm2 > range.hi) continue;
      add_number(where, field, mm2, size.name, choice, values);
    }
    if (choice.alternatives.empty()) throw InputError(where, "no size lies in the given range");
    problem.choices.push_back(std::move(choice));
    choice_fields.push_back(std::move(values));
  }

  void read_limit(const std::string& text) {
    const std::string where = "--subject-to " + text;
    const std::size_t at = text.find("<=") != std::string::npos ? text.find("<=") : text.find(">=");
    const auto bound = at == std::string::npos ? std::nullopt : number_of(text.substr(at + 2));
    if (!bound) throw InputError(where, "expected KEY<=VALUE or KEY>=VALUE");
    problem.limits.push_back({text, candidate_quantity(text.substr(0, at), file_.design, where),
                              *bound, text[at] == '<' ? 1 : -1});
  }

  /// For the supplied power: that of the drone without a tether, over a line without loss. Holds as
  /// long as only choices change the drone and the flight.
  void add_lower_bound() {
    const std::string key = request_.minimize;
    const bool power =
        key == "total_power_W" || key == "hover.total_power_W" || key == "forward.total_power_W";
    const bool ranges_spare_drone =
        std::all_of(range_fields.begin(), range_fields.end(), [](const FreeField& f) {
          return f.field->pointer == "/supply/voltage_V" ||
                 f.field->pointer.starts_with("/tether/");
        });
    if (!power || !ranges_spare_drone) return;
    const Condition condition = key.starts_with("hover")     ? Condition::hover
                                : key.starts_with("forward") ? Condition::forward
                                                             : file_.design.requirements.power_at;
    problem.lower_bound = [condition](const Design& design) {
      Design bare = design;
      bare.tether.length = 1e-6;
      bare.tether.spooled_length = 0;
      bare.tether.winch_pull = 0;
      bare.tether.ambient_temperature_C.reset();
      const double area = 1e-9;
      const OperatingPoint point = evaluate(bare, area, condition);
      return std::isfinite(point.drone_power) ? point.drone_power * (1 - 1e-6)
                                              : std::numeric_limits<double>::infinity();
    };
  }

  const DesignFile& file_;
  const DesignRequest& request_;
  std::vector<InputProblem> problems_;
};

ordered_json free_values(const ProblemReader& reader, const std::vector<std::size_t>& choice,
                         const std::vector<double>& x) {
  ordered_json values = ordered_json::object();
  for (std::size_t i = 0; i < x.size(); ++i) {
    values[dot_path(reader.range_fields[i].field->pointer)] = x[i];
  }
  for (std::size_t i = 0; i < choice.size(); ++i) {
    values[dot_path(reader.choice_fields[i].field->pointer)] =
        reader.choice_fields[i].values[choice[i]];
  }
  return values;
}

ordered_json ready_spec(const DesignFile& file, const ordered_json& values, const Candidate& best) {
  ordered_json spec = file.document;
  for (const auto& [path, value] : values.items()) {
    spec[ordered_json::json_pointer(std::string(find_field(path)->pointer))] = value;
  }
  if (std::isfinite(best.area)) {
    spec["tether"]["cross_section_mm2"] = best.area / unit::square_millimetre;
  }
  return spec;
}

/// The least objective of the chosen combination after `change`; NaN where infeasible.
template <typename Change>
double least_after(const DesignProblem& problem, const DesignAnswer& answer, Change change) {
  DesignProblem changed = problem;
  for (std::size_t i = 0; i < changed.choices.size(); ++i) {
    FreeChoice& choice = changed.choices[i];
    choice.alternatives = {choice.alternatives[answer.choice[i]]};
  }
  change(changed);
  const DesignAnswer after = search_design(changed);
  return after.feasible ? after.minimum.value : std::numeric_limits<double>::quiet_NaN();
}

void add_price(std::vector<ShadowPrice>& prices, const std::string& name, bool active, double step,
               double change, const std::string& objective) {
  if (!std::isfinite(change)) return;
  ShadowPrice price{name, active, change, step, {}};
  price.sentence =
      fmt::format("{}{}: {} by {} {} {} by {}.", name, active ? " binds" : "",
                  step > 0 ? "raising it" : "lowering it", significant(std::abs(step), 3),
                  change >= 0 ? "raises" : "lowers", objective, significant(std::abs(change), 3));
  prices.push_back(std::move(price));
}

std::vector<ShadowPrice> shadow_prices(const ProblemReader& reader, const DesignAnswer& answer,
                                       const DesignRequest& request) {
  std::vector<ShadowPrice> prices;
  const DesignProblem& problem = reader.problem;
  const double least = answer.minimum.value;
  for (std::size_t i = 0; i < problem.limits.size(); ++i) {
    const UserLimit& limit = problem.limits[i];
    const double value = limit.quantity(answer.best);
    const double scale = std::max(std::abs(limit.bound), 1e-3);
    if (std::abs(value - limit.bound) > binding * scale) continue;
    const double step = limit.sign * 0.01 * scale;
    const double after =
        least_after(problem, answer, [&](DesignProblem& p) { p.limits[i].bound += step; });
    add_price(prices, limit.name, true, step, after - least, request.minimize);
  }
  for (std::size_t i = 0; i < problem.ranges.size(); ++i) {
    const FreeRange& free = problem.ranges[i];
    const double width = free.range.hi - free.range.lo;
    if (!(width > 0)) continue;
    const bool at_lo = answer.minimum.x[i] - free.range.lo <= binding * width;
    const bool at_hi = free.range.hi - answer.minimum.x[i] <= binding * width;
    if (!at_lo && !at_hi) continue;
    const double step = (at_lo ? -0.01 : 0.01) * std::abs(answer.minimum.x[i]);
    const FieldRange& allowed = reader.range_fields[i].field->range;
    if (step == 0 || !allowed.contains(answer.minimum.x[i] + step)) continue;
    const double after = least_after(problem, answer, [&](DesignProblem& p) {
      (at_lo ? p.ranges[i].range.lo : p.ranges[i].range.hi) += step;
    });
    add_price(prices,
              fmt::format("{} at the {} end of its range", free.name, at_lo ? "low" : "high"), true,
              step, after - least, request.minimize);
  }
  const auto of_field = [&](const char* path, double step, bool active) {
    const SpecField& field = *find_field(path);
    const auto is_free = [&](const FreeField& f) { return f.field == &field; };
    if (std::any_of(reader.range_fields.begin(), reader.range_fields.end(), is_free) ||
        std::any_of(reader.choice_fields.begin(), reader.choice_fields.end(), is_free)) {
      return;
    }
    const auto value = field_value(problem.base, field);
    if (!value || !field.range.contains(*value + step)) return;
    const double after = least_after(
        problem, answer, [&](DesignProblem& p) { set_field(p.base, field, *value + step); });
    add_price(prices, path, active, step, after - least, request.minimize);
  };
  const Requirements& need = problem.base.requirements;
  const OperatingPoint& judged =
      need.headroom_at == Condition::hover ? answer.best.hover : answer.best.forward;
  const bool headroom_binds =
      !need.buffer_battery && judged.headroom <= need.thrust_headroom * (1 + binding);
  if (headroom_binds) of_field("requirements.thrust_headroom", -0.01, true);
  of_field("tether.length_m", 1, false);
  of_field("drone.mass_g", 100, false);
  of_field("supply.voltage_V", 1, false);
  return prices;
}

std::vector<FrontPoint> pareto_front(const ProblemReader& reader, const DesignFile& file,
                                     const DesignRequest& request) {
  std::vector<FrontPoint> front;
  DesignProblem problem = reader.problem;
  problem.lower_bound = nullptr;
  const CandidateQuantity first =
      candidate_quantity(request.pareto[0], file.design, "--pareto " + request.pareto[0]);
  const CandidateQuantity second =
      candidate_quantity(request.pareto[1], file.design, "--pareto " + request.pareto[1]);
  const MinimumOptions options{.seed = request.seed};
  problem.objective = first;
  const DesignAnswer best_first = search_design(problem, options);
  problem.objective = second;
  const DesignAnswer best_second = search_design(problem, options);
  if (!best_first.feasible || !best_second.feasible) return front;
  const auto add = [&](const DesignAnswer& answer) {
    const double one = first(answer.best);
    const double other = second(answer.best);
    if (!front.empty() && std::abs(front.back().second - other) <= 1e-6 * std::abs(other)) return;
    front.push_back({one, other, free_values(reader, answer.choice, answer.minimum.x)});
  };
  add(best_first);
  const double from = second(best_first.best);
  const double to = second(best_second.best);
  constexpr int points = 10;
  problem.objective = first;
  problem.limits.push_back({request.pareto[1], second, from, 1});
  for (int i = 1; i <= points; ++i) {
    problem.limits.back().bound = from + (to - from) * i / points + 1e-9 * std::abs(to);
    const DesignAnswer answer = search_design(problem, options);
    if (answer.feasible) add(answer);
  }
  return front;
}

std::string value_text(const ordered_json& value) {
  return value.is_number() ? significant(value.get<double>(), 5) : value.get<std::string>();
}

std::string confidence_text(const DesignStudy& study) {
  const Minimum& minimum = study.answer.minimum;
  const std::size_t all = study.answer.all.size();
  std::string text = fmt::format(
      "{} combinations of choices, {} of them discarded by a lower bound; {} designs "
      "evaluated.",
      all, study.answer.pruned, study.answer.evaluations);
  if (study.answer.feasible && minimum.starts > 0) {
    text += fmt::format(" {} of {} local searches of the best one end at the same optimum{}.",
                        minimum.agreeing, minimum.starts,
                        minimum.agreeing >= 2 ? "" : ": it may not be the global one");
  }
  return text;
}

}  // namespace

CandidateQuantity candidate_quantity(const std::string& key, const Design& design,
                                     const std::string& where) {
  std::string name = key;
  const Requirements& need = design.requirements;
  Condition condition = key == "headroom" ? need.headroom_at : need.power_at;
  for (const auto& [prefix, which] :
       {std::pair{"hover.", Condition::hover}, {"forward.", Condition::forward}}) {
    if (name.starts_with(prefix)) {
      name.erase(0, std::string_view(prefix).size());
      condition = which;
    }
  }
  static constexpr OperatingPointField further[] = {
      {"conductor_temperature_C", &OperatingPoint::conductor_temperature, 1},
      {"drum_temperature_C", &OperatingPoint::drum_temperature, 1},
      {"tether_tension_N", &OperatingPoint::tether_tension, 1}};
  std::vector<std::string> known;
  for (const auto fields :
       {operating_point_fields(), std::span<const OperatingPointField>(further)}) {
    for (const OperatingPointField& field : fields) {
      known.emplace_back(field.key);
      if (field.key != name) continue;
      const OperatingPointField found = field;
      return [found, condition](const Candidate& candidate) {
        return practical_value(condition == Condition::hover ? candidate.hover : candidate.forward,
                               found);
      };
    }
  }
  if (const SpecField* field = find_field(key); field != nullptr && is_numeric(*field)) {
    return [field](const Candidate& candidate) {
      return field_value(candidate.design, *field)
          .value_or(std::numeric_limits<double>::quiet_NaN());
    };
  }
  throw InputError(where, fmt::format("there is no key \"{}\"{}", key, did_you_mean(name, known)));
}

DesignStudy study_design(DesignFile file, DesignRequest request) {
  ProblemReader reader(file, request);
  reader.read();
  if (!request.pareto.empty() && request.pareto.size() != 2) {
    throw InputError("--pareto", "expected two keys, such as total_power_W,tether_mass_g");
  }
  DesignStudy study;
  study.answer = search_design(reader.problem, {.seed = request.seed});
  study.values = free_values(reader, study.answer.choice, study.answer.minimum.x);
  study.spec = ready_spec(file, study.values, study.answer.best);
  if (study.answer.feasible) study.prices = shadow_prices(reader, study.answer, request);
  if (!request.pareto.empty()) study.front = pareto_front(reader, file, request);
  study.file = std::move(file);
  study.request = std::move(request);
  return study;
}

std::string design_text(const DesignStudy& study, const TextStyle& style) {
  const DesignAnswer& answer = study.answer;
  std::string out = style.bold(study.file.name) + "\n\n";
  if (!answer.feasible) {
    out += style.bad(style.bold("No design within these fields meets every demand.")) + "\n";
    out += wrapped(fmt::format("The one that comes closest misses \"{}\" by {} %:",
                               answer.most_violated, significant(100 * answer.most_violation, 3)));
  } else {
    out += style.good(style.bold(fmt::format("Least {}: {}", study.request.minimize,
                                             significant(answer.minimum.value, 6)))) +
           "\n";
  }
  for (const auto& [path, value] : study.values.items()) {
    out += fmt::format("  {} = {}\n", path, value_text(value));
  }
  if (std::isfinite(answer.best.area)) {
    out += fmt::format("  cross-section {} mm²\n",
                       significant(answer.best.area / unit::square_millimetre, 5));
    TextTable table({{"", TextTable::Align::left},
                     {"supply W"},
                     {"lost W"},
                     {"current A"},
                     {"at drone V"},
                     {"headroom"},
                     {"tether g"}});
    for (const auto& [name, point] :
         {std::pair{"hover", &answer.best.hover}, std::pair{"forward", &answer.best.forward}}) {
      table.add({name, fixed(point->total_power, 1), fixed(point->tether_loss, 1),
                 fixed(point->current, 2), fixed(point->received_voltage, 1),
                 fixed(point->headroom, 2), fixed(point->tether_mass / unit::gram, 1)});
    }
    out += "\n" + table.text(style) + "\n";
    for (const std::string& sentence :
         cable_sentences(answer.best.design, answer.best.hover, answer.best.forward)) {
      out += wrapped(sentence);
    }
  }
  if (!study.prices.empty()) {
    out += "\n" + style.bold("What binds, and what more of it would change") + "\n";
    for (const ShadowPrice& price : study.prices) out += wrapped(price.sentence, 96, "  ");
  }
  out += "\n" + wrapped(confidence_text(study));
  if (!study.front.empty()) {
    out += "\n" + style.bold("Pareto front") + "\n";
    std::vector<TextTable::Column> columns{{study.request.pareto[0]}, {study.request.pareto[1]}};
    for (const auto& [path, value] : study.values.items()) columns.push_back({path});
    TextTable table(columns);
    for (const FrontPoint& point : study.front) {
      std::vector<std::string> cells{significant(point.first, 5), significant(point.second, 5)};
      for (const auto& [path, value] : point.values.items()) cells.push_back(value_text(value));
      table.add(cells);
    }
    out += table.text(style);
  }
  if (answer.feasible) {
    out += "\n" + style.bold("The spec") + "\n" + study.spec.dump(2) + "\n";
  }
  return out;
}

ordered_json design_json(const DesignStudy& study) {
  const DesignAnswer& answer = study.answer;
  ordered_json prices = ordered_json::array();
  for (const ShadowPrice& price : study.prices) {
    prices.push_back({{"name", price.name},
                      {"active", price.active},
                      {"step", price.step},
                      {"change", price.price},
                      {"sentence", price.sentence}});
  }
  ordered_json front = ordered_json::array();
  for (const FrontPoint& point : study.front) {
    front.push_back({{study.request.pareto[0], point.first},
                     {study.request.pareto[1], point.second},
                     {"values", point.values}});
  }
  const bool exists = std::isfinite(answer.best.area);
  ordered_json out{
      {"name", study.file.name},
      {"status", answer.feasible ? "optimal" : "infeasible"},
      {"minimize", study.request.minimize},
      {"value", answer.feasible ? number_or_null(answer.minimum.value) : ordered_json(nullptr)},
      {"free", study.values},
      {"cross_section_mm2", number_or_null(answer.best.area / unit::square_millimetre)},
      {"hover", exists ? operating_point_json(answer.best.hover) : ordered_json(nullptr)},
      {"forward", exists ? operating_point_json(answer.best.forward) : ordered_json(nullptr)},
      {"voltage_class", voltage_class_json(answer.best.design.supply.voltage)},
      {"thermal", thermal_json(answer.best.design, answer.best.hover, answer.best.forward)},
      {"cable", cable_json(answer.best.design, answer.best.hover, answer.best.forward)},
      {"prices", prices},
      {"confidence",
       {{"combinations", answer.all.size()},
        {"pruned", answer.pruned},
        {"evaluations", answer.evaluations},
        {"starts", answer.minimum.starts},
        {"agreeing", answer.minimum.agreeing},
        {"sentence", confidence_text(study)}}},
      {"pareto", front},
      {"spec", answer.feasible ? study.spec : ordered_json(nullptr)}};
  if (!answer.feasible) {
    out["most_violated"] = {{"demand", answer.most_violated},
                            {"by_percent", number_or_null(100 * answer.most_violation)}};
  }
  return out;
}

std::string design_csv(const DesignStudy& study) {
  std::string out;
  for (const auto& [path, value] : study.values.items()) out += path + ",";
  out += "feasible," + study.request.minimize + "\n";
  for (const auto& [path, value] : study.values.items()) {
    out +=
        (value.is_number() ? csv_number(value.get<double>()) : csv_text(value.get<std::string>())) +
        ",";
  }
  return out + (study.answer.feasible ? "true," : "false,") +
         csv_number(study.answer.minimum.value) + "\n";
}

}  // namespace tethercalc
