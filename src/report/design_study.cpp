#include "tethercalc/report/design_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "io/closest_name.hpp"
#include "solve/cable_limits.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/io/spec_writer.hpp"
#include "tethercalc/io/sweep_axes.hpp"
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

/// Turns a request into a problem.
class ProblemReader {
 public:
  ProblemReader(const DesignFile& file, const DesignRequest& request)
      : file_(file), request_(request) {
    problem.base = file.design;
  }

  DesignProblem problem;
  std::vector<SweepAxis> ranges;   ///< as problem.ranges
  std::vector<SweepAxis> choices;  ///< as problem.choices

  void read() {
    std::vector<SweepAxis> axes;
    attempt([&] { axes = read_axes(request_.free, file_, AxisUse::searched); });
    attempt([&] { read_standard(axes); });
    attempt([&] {
      problem.objective =
          candidate_quantity(request_.minimize, file_.design, "--minimize " + request_.minimize);
    });
    for (const std::string& text : request_.subject_to) attempt([&] { read_limit(text); });
    if (!problems_.empty()) throw InputError(std::move(problems_));
    if (request_.free.empty() && request_.standard.empty()) {
      throw InputError("--free", "is needed: which fields may the search change?");
    }
    // A motor or material replaces all of its numbers, which other fields may free.
    std::stable_partition(axes.begin(), axes.end(), [](const SweepAxis& axis) {
      return std::holds_alternative<NamedChoices>(axis.values);
    });
    for (const SweepAxis& axis : axes) add(axis);
    check_choices();
    free_cross_section_where_needed();
    add_lower_bound();
  }

  [[nodiscard]] bool is_free(std::string_view path) const {
    const auto same = [&](const SweepAxis& axis) { return axis.name == path; };
    return std::any_of(ranges.begin(), ranges.end(), same) ||
           std::any_of(choices.begin(), choices.end(), same);
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

  void add(const SweepAxis& axis) {
    if (const auto* range = std::get_if<Uniform>(&axis.values)) {
      problem.ranges.push_back({axis.name, {range->lo, range->hi}, axis.apply});
      ranges.push_back(axis);
      return;
    }
    FreeChoice choice{axis.name, {}};
    const std::uint64_t count = *value_count(axis);
    combinations_ *= static_cast<double>(count);
    constexpr double most = 1e5;
    if (combinations_ > most) {
      throw InputError("--free", fmt::format("the lists and steps have more than {} combinations, "
                                             "each of which is searched: write lo..hi for a range",
                                             most));
    }
    for (std::uint64_t i = 0; i < count; ++i) {
      const double value = value_at(axis, i);
      choice.alternatives.push_back(
          {fmt::to_string(value), [apply = axis.apply, value](Design& d) { apply(d, value); }});
    }
    problem.choices.push_back(std::move(choice));
    choices.push_back(axis);
  }

  /// Refuses choices in conflict with each other or with the spec, whatever the ranges.
  void check_choices() const {
    std::vector<SweepAxis> at_lo = choices;
    std::vector<SweepAxis> at_hi = choices;
    for (const FreeRange& free : problem.ranges) {
      at_lo.push_back({free.name, std::vector{free.range.lo}, free.set});
      at_hi.push_back({free.name, std::vector{free.range.hi}, free.set});
    }
    try {
      check_sweep_rows(SweepSpace(std::move(at_lo)), file_);
    } catch (const InputError&) {
      check_sweep_rows(SweepSpace(std::move(at_hi)), file_, "--free");
    }
  }

  /// Sizes in which the cross-section comes take the place of its range.
  void read_standard(std::vector<SweepAxis>& axes) {
    if (request_.standard.empty()) return;
    const std::string where = "--standard " + request_.standard;
    if (request_.standard != "awg" && request_.standard != "iec") {
      throw InputError(where, "allowed are awg and iec");
    }
    const std::string name = request_.standard == "awg" ? "AWG" : "IEC 60228";
    const SpecField& field = *find_field("tether.cross_section_mm2");
    Uniform range{0, 1000};
    const auto freed = std::find_if(axes.begin(), axes.end(), [](const SweepAxis& axis) {
      return axis.name == "tether.cross_section_mm2";
    });
    if (freed != axes.end()) {
      const auto* given = std::get_if<Uniform>(&freed->values);
      if (given == nullptr) {
        throw InputError(where, freed->name + " is freed twice; --free may give it a range lo..hi");
      }
      range = *given;
      axes.erase(freed);
    }
    std::vector<double> sizes;
    for (const WireSize& size : wire_sizes()) {
      const double mm2 = size.area / unit::square_millimetre;
      if (size.standard == name && mm2 >= range.lo && mm2 <= range.hi) sizes.push_back(mm2);
    }
    if (sizes.empty()) throw InputError(where, "no size lies in the given range");
    axes.push_back({dot_path(field.pointer), std::move(sizes),
                    [&field](Design& d, double mm2) { set_field(d, field, mm2); }});
  }

  void read_limit(const std::string& text) {
    const std::string where = "--subject-to " + text;
    const std::size_t at = text.find("<=") != std::string::npos ? text.find("<=") : text.find(">=");
    const auto bound = at == std::string::npos ? std::nullopt : number_of(text.substr(at + 2));
    if (!bound) throw InputError(where, "expected KEY<=VALUE or KEY>=VALUE");
    problem.limits.push_back({text, candidate_quantity(text.substr(0, at), file_.design, where),
                              *bound, text[at] == '<' ? 1 : -1});
  }

  /// A candidate without a cross-section flies the one of least power that meets the requirements.
  /// That is the best one only where this power is what is minimised, and where no demand of the
  /// user depends on the cross-section; elsewhere it has to be searched like the free fields. Where
  /// heat and the like are demands it would do, but finding it takes a thousand evaluations.
  void free_cross_section_where_needed() {
    const SpecField& area = *find_field("tether.cross_section_mm2");
    if (file_.design.tether.cross_section || is_free(dot_path(area.pointer))) return;
    const bool at_hover = file_.design.requirements.power_at == Condition::hover;
    const std::string& key = request_.minimize;
    const bool least_power = key == "total_power_W" ||
                             key == (at_hover ? "hover.total_power_W" : "forward.total_power_W");
    const bool only_fields = std::all_of(
        request_.subject_to.begin(), request_.subject_to.end(), [](const std::string& limit) {
          return find_field(limit.substr(0, limit.find_first_of("<>"))) != nullptr;
        });
    Design some = file_.design;
    for (const FreeRange& free : problem.ranges) free.set(some, free.range.lo);
    for (const FreeChoice& choice : problem.choices) choice.alternatives.front().apply(some);
    const bool quickly_found = !has_cable_limits(some);
    if (least_power && only_fields && request_.pareto.empty() && quickly_found) return;
    // From below AWG 36 to what no drone lifts.
    add({dot_path(area.pointer), Uniform{0.01, 100},
         [&area](Design& d, double x) { set_field(d, area, x); }});
  }

  /// For the supplied power: that of the drone with the lightest and least resistive tether that
  /// the ranges leave, at the highest voltage. Holds as long as ranges change nothing but the
  /// tether and the voltage.
  void add_lower_bound() {
    const std::string key = request_.minimize;
    if (key != "total_power_W" && key != "hover.total_power_W" && key != "forward.total_power_W") {
      return;
    }
    const Condition condition = key.starts_with("hover")     ? Condition::hover
                                : key.starts_with("forward") ? Condition::forward
                                                             : file_.design.requirements.power_at;
    std::vector<std::pair<const SpecField*, double>> best_ends;
    bool area_is_free = false;
    for (const FreeRange& free : problem.ranges) {
      const SpecField* const field = find_field(free.name);
      const std::string_view pointer = field->pointer;
      const VariableRange& range = free.range;
      if (pointer == "/supply/voltage_V") {
        double highest = range.hi;
        for (const UserLimit& limit : problem.limits) {
          if (limit.name.starts_with("supply.voltage_V<=")) {
            highest = std::clamp(limit.bound, range.lo, highest);
          }
        }
        best_ends.emplace_back(field, highest);
      } else if (pointer == "/tether/cross_section_mm2") {
        area_is_free = true;
      } else if (pointer.starts_with("/tether/")) {
        best_ends.emplace_back(field, range.lo);
      } else {
        return;
      }
    }
    problem.lower_bound = [condition, best_ends, area_is_free](const Design& design) {
      constexpr double infinity = std::numeric_limits<double>::infinity();
      constexpr double rounding = 1e-9;
      Design bare = design;
      for (const auto& [field, value] : best_ends) set_field(bare, *field, value);
      // As cold as it gets. (Sun only warms, and winches only pull.)
      Tether& tether = bare.tether = without_heat(bare.tether);
      if (tether.cross_section && !area_is_free) {
        // A wall that grows with the voltage is bounded by the one for handling.
        tether.insulation.dielectric_safety_factor = 0;
        const double power = evaluate(bare, *tether.cross_section, condition).total_power;
        return std::isfinite(power) ? power * (1 - rounding) : infinity;
      }
      tether.length = 1e-6;
      tether.spooled_length = 0;
      const double power = evaluate(bare, 1e-9, condition).drone_power;
      return std::isfinite(power) ? power * (1 - 1e-6) : infinity;
    };
  }

  const DesignFile& file_;
  const DesignRequest& request_;
  double combinations_ = 1;
  std::vector<InputProblem> problems_;
};

ordered_json free_values(const ProblemReader& reader, const std::vector<std::size_t>& choice,
                         const std::vector<double>& x) {
  ordered_json values = ordered_json::object();
  for (std::size_t i = 0; i < x.size(); ++i) values[reader.ranges[i].name] = x[i];
  for (std::size_t i = 0; i < choice.size(); ++i) {
    const SweepAxis& axis = reader.choices[i];
    if (const auto* names = std::get_if<NamedChoices>(&axis.values)) {
      values[axis.name] = names->names[choice[i]];
    } else {
      values[axis.name] = value_at(axis, choice[i]);
    }
  }
  return values;
}

ordered_json ready_spec(const DesignFile& file, const ordered_json& values, const Candidate& best) {
  Design design = best.design;
  if (std::isfinite(best.area)) design.tether.cross_section = best.area;
  std::map<std::string, std::string> names;
  for (const auto& [path, value] : values.items()) {
    if (value.is_string()) names[path] = value.get<std::string>();
  }
  return spec_with(file, design, names);
}

/// Unit in which a key's name ends, as people write it; empty where it has none.
std::string unit_of_key(const std::string& key) {
  const std::string last = key.substr(key.rfind('_') + 1);
  if (last == "mm2") return "mm²";
  if (last == "deg") return "°";
  if (last == "ohm") return "Ω";
  if (last == "C") return "°C";
  if (last == "s" && key.ends_with("m_s")) return "m/s";
  for (const char* plain : {"W", "g", "A", "V", "m", "N", "mm"}) {
    if (last == plain) return last;
  }
  return "";
}

std::string quantity_words(double value, const std::string& unit) {
  return significant(value, 3) + (unit.empty() || unit == "°" ? unit : " " + unit);
}

/// "1.20 V more", "0.0100 less".
std::string step_words(double step, const std::string& unit) {
  return quantity_words(std::abs(step), unit) + (step > 0 ? " more" : " less");
}

/// The prices of one study: each the least objective after a change, less that before it.
class Prices {
 public:
  Prices(const ProblemReader& reader, const DesignAnswer& answer, const DesignRequest& request)
      : reader_(reader), answer_(answer), request_(request) {}

  std::vector<ShadowPrice> all() {
    for (std::size_t i = 0; i < reader_.problem.limits.size(); ++i) add_limit(i);
    for (std::size_t i = 0; i < reader_.problem.ranges.size(); ++i) add_range_end(i);
    add_requirements();
    add_field("tether.length_m", 1, "One more metre of tether");
    add_field("drone.mass_g", 100, "100 g more on the drone");
    add_field("supply.voltage_V", 1, "One volt more of the supply");
    return std::move(prices_);
  }

 private:
  void add_limit(std::size_t i) {
    const UserLimit& limit = reader_.problem.limits[i];
    const double scale = std::max(std::abs(limit.bound), 1e-3);
    if (std::abs(limit.quantity(answer_.best) - limit.bound) > binding * scale) return;
    const double step = limit.sign * 0.01 * scale;
    const std::string key = limit.name.substr(0, limit.name.find_first_of("<>"));
    add(limit.name, limit.name + " binds", step, step_words(step, unit_of_key(key)),
        [&](DesignProblem& p) { p.limits[i].bound += step; });
  }

  void add_range_end(std::size_t i) {
    const FreeRange& free = reader_.problem.ranges[i];
    const double x = answer_.minimum.x[i];
    const double width = free.range.hi - free.range.lo;
    if (!(width > 0)) return;
    const bool at_lo = x - free.range.lo <= binding * width;
    const bool at_hi = free.range.hi - x <= binding * width;
    if (!at_lo && !at_hi) return;
    const double step = (at_lo ? -0.01 : 0.01) * std::abs(x);
    if (step == 0 || !find_field(free.name)->range.contains(x + step)) return;
    add(fmt::format("{} at the {} end of its range", free.name, at_lo ? "low" : "high"),
        fmt::format("{} is at the {} end of its range", free.name, at_lo ? "low" : "high"), step,
        step_words(step, unit_of_key(free.name)),
        [&](DesignProblem& p) { (at_lo ? p.ranges[i].range.lo : p.ranges[i].range.hi) += step; });
  }

  /// The requirements of the design that bind.
  void add_requirements() {
    const Design& best = answer_.best.design;
    const Requirements& need = best.requirements;
    const bool in_hover = need.headroom_at == Condition::hover;
    const OperatingPoint& judged = in_hover ? answer_.best.hover : answer_.best.forward;
    if (!need.buffer_battery && judged.headroom <= need.thrust_headroom * (1 + binding)) {
      add_requirement("requirements.thrust_headroom",
                      fmt::format("The thrust headroom of {} in {}", fixed(need.thrust_headroom, 2),
                                  in_hover ? "hover" : "forward flight"),
                      -0.01, "", [](Design& d) { d.requirements.thrust_headroom -= 0.01; });
    }
    const double pitch =
        std::max(std::abs(answer_.best.hover.pitch), std::abs(answer_.best.forward.pitch));
    if (pitch >= need.max_pitch * (1 - binding)) {
      add_requirement(
          "requirements.max_pitch_deg",
          fmt::format("The largest tilt of {}°", significant(need.max_pitch / unit::degree, 3)), 1,
          "°", [](Design& d) { d.requirements.max_pitch += unit::degree; });
    }
    if (binds("conductor_temperature") || binds("drum_temperature")) {
      add_requirement("tether.insulation.material.rated_temperature_C",
                      fmt::format("The insulation's rated {} °C",
                                  significant(*best.tether.insulation.rated_temperature_C, 3)),
                      1, "°C", [](Design& d) { *d.tether.insulation.rated_temperature_C += 1; });
    }
    if (binds("tether_strength")) {
      const double step = -0.01 * need.strength_safety_factor;
      add_requirement("requirements.strength_safety_factor",
                      fmt::format("The tether's strength of {} times its tension",
                                  significant(need.strength_safety_factor, 3)),
                      step, "", [=](Design& d) { d.requirements.strength_safety_factor += step; });
    }
    if (binds("converter_rating")) {
      const double step = 0.01 * *best.supply.converter.rated_output_power;
      add_requirement("supply.converter.rated_output_W",
                      fmt::format("The converter's rated {} W",
                                  significant(*best.supply.converter.rated_output_power, 4)),
                      step, "W",
                      [=](Design& d) { *d.supply.converter.rated_output_power += step; });
    }
    if (binds("input_voltage") && best.supply.converter.max_input_voltage) {
      const double step = 0.01 * *best.supply.converter.max_input_voltage;
      add_requirement("supply.converter.max_input_voltage_V",
                      fmt::format("The converter's highest input of {} V",
                                  significant(*best.supply.converter.max_input_voltage, 4)),
                      step, "V", [=](Design& d) { *d.supply.converter.max_input_voltage += step; });
    }
  }

  /// Whether a demand of that name is met with nothing to spare, in either condition.
  [[nodiscard]] bool binds(std::string_view demand) const {
    const std::vector<DemandState> states = demand_states(answer_.best, {});
    return std::any_of(states.begin(), states.end(), [&](const DemandState& state) {
      return state.name.starts_with(demand) && state.violation > -binding;
    });
  }

  template <typename Change>
  void add_requirement(const std::string& name, const std::string& subject, double step,
                       const std::string& unit, Change change) {
    if (reader_.is_free(name)) return;
    add(name, subject + " binds", step, step_words(step, unit), [&](DesignProblem& p) {
      p.choices.push_back({name, {{name, change}}});
    });
  }

  void add_field(const char* path, double step, const char* subject) {
    const SpecField& field = *find_field(path);
    const auto value = field_value(reader_.problem.base, field);
    if (reader_.is_free(path) || !value || !field.range.contains(*value + step)) return;
    add(path, "", step, subject, [&](DesignProblem& p) {
      p.choices.push_back({path, {{path, [&](Design& d) { set_field(d, field, *value + step); }}}});
    });
  }

  /// `binding_words`: empty for a field that nothing holds; `subject`: what would cost or save.
  template <typename Change>
  void add(const std::string& name, const std::string& binding_words, double step,
           const std::string& subject, Change change) {
    const double least = answer_.minimum.value;
    const double change_of_least = least_after(change) - least;
    const bool active = !binding_words.empty();
    ShadowPrice price{name, active, change_of_least, step, {}};
    // What two searches may differ by.
    constexpr double noise = 1e-9;
    if (!std::isfinite(change_of_least)) {
      price.sentence = fmt::format("{}{}{} would leave no design that meets every demand.",
                                   binding_words, active ? ": " : "", subject);
    } else if (std::abs(change_of_least) <= noise * std::abs(least)) {
      if (!active) return;
      price.price = 0;
      price.sentence =
          binding_words +
          ", but moving it alone would change nothing: something else binds there too.";
    } else {
      price.sentence = fmt::format("{}{}{} would {}.", binding_words, active ? ": " : "", subject,
                                   effect_words(change_of_least));
    }
    prices_.push_back(std::move(price));
  }

  [[nodiscard]] std::string effect_words(double change) const {
    const std::string& key = request_.minimize;
    const std::string unit = unit_of_key(key);
    const std::string amount = quantity_words(std::abs(change), unit);
    if (unit.empty())
      return fmt::format("{} {} by {}", change > 0 ? "raise" : "lower", key, amount);
    return fmt::format("{} {}", change > 0 ? "cost" : "save", amount);
  }

  /// The least objective of the chosen combination after `change`; NaN where infeasible.
  template <typename Change>
  double least_after(Change change) const {
    DesignProblem changed = reader_.problem;
    for (std::size_t i = 0; i < changed.choices.size(); ++i) {
      FreeChoice& choice = changed.choices[i];
      choice.alternatives = {choice.alternatives[answer_.choice[i]]};
    }
    change(changed);
    const DesignAnswer after = search_design(changed, {.seed = request_.seed});
    return after.feasible ? after.minimum.value : std::numeric_limits<double>::quiet_NaN();
  }

  const ProblemReader& reader_;
  const DesignAnswer& answer_;
  const DesignRequest& request_;
  std::vector<ShadowPrice> prices_;
};

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

std::string missed_words(const DesignAnswer& answer) {
  std::string words;
  for (const DemandState& demand : answer.missed) {
    words += fmt::format("{}\"{}\" by {} %", words.empty() ? "" : ", ", demand.name,
                         significant(100 * demand.violation, 3));
  }
  return words;
}

std::string confidence_text(const DesignStudy& study) {
  const Minimum& minimum = study.answer.minimum;
  const std::size_t all = study.answer.all.size();
  std::string text;
  if (all > 1) {
    text = fmt::format("Of {} combinations of choices a lower bound ruled out {}; ", all,
                       study.answer.pruned == 0 ? "none" : fmt::to_string(study.answer.pruned));
  }
  text += fmt::format("{} design{} evaluated.", study.answer.evaluations,
                      study.answer.evaluations == 1 ? " was" : "s were");
  if (minimum.starts == 0) return text + " Nothing was left to search: the answer is exact.";
  if (!study.answer.feasible) {
    return text + " None of them meets every demand; the search then went for the least violation.";
  }
  return text + fmt::format(" {} of {} searches{} lead to the same optimum{}.", minimum.agreeing,
                            minimum.starts, all > 1 ? " in the best combination" : "",
                            minimum.agreeing >= 2 ? "" : ": there may be a better one elsewhere");
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
  if (study.answer.feasible) study.prices = Prices(reader, study.answer, request).all();
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
    out += wrapped("The one that comes closest misses " + missed_words(answer) + ":");
  } else {
    out += style.good(style.bold(fmt::format("Least {}: {}", study.request.minimize,
                                             significant(answer.minimum.value, 6)))) +
           "\n";
  }
  for (const auto& [path, value] : study.values.items()) {
    out += fmt::format("  {} = {}\n", path, value_text(value));
  }
  if (std::isfinite(answer.best.area)) {
    if (!study.values.contains("tether.cross_section_mm2")) {
      out += fmt::format("  cross-section {} mm²\n",
                         significant(answer.best.area / unit::square_millimetre, 5));
    }
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
                      {"change", number_or_null(price.price)},
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
    ordered_json missed = ordered_json::array();
    for (const DemandState& demand : answer.missed) {
      missed.push_back(
          {{"demand", demand.name}, {"by_percent", number_or_null(100 * demand.violation)}});
    }
    out["missed"] = missed;
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
