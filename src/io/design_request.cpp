#include "tethercalc/io/design_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "io/checked_values.hpp"
#include "io/closest_name.hpp"
#include "model/constants.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/io/sweep_axes.hpp"
#include "tethercalc/study/results.hpp"

namespace tethercalc {
namespace {

/// Refuses more combinations of choices than can be searched, and choices in conflict with each
/// other or with the spec: anywhere in a range, or in all of a range of the supply's, whose
/// conflicts make a design infeasible, which the search leaves.
void check_choices(const std::vector<SweepAxis>& free, const DesignFile& file) {
  std::vector<SweepAxis> at_lo = free;
  std::vector<SweepAxis> at_hi = free;
  double combinations = 1;
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (const auto* range = std::get_if<Uniform>(&free[i].values)) {
      const bool left = free[i].name.starts_with("supply.");
      at_lo[i].values = left ? std::vector{range->lo} : std::vector{range->lo, range->hi};
      at_hi[i].values = left ? std::vector{range->hi} : std::vector{range->lo, range->hi};
    } else {
      combinations *= static_cast<double>(value_count(free[i]).value());
    }
  }
  constexpr double most = 1e5;
  if (combinations > most) {
    throw InputError("--free", fmt::format("the lists and steps have more than {} combinations, "
                                           "each of which is searched: write lo..hi for a range",
                                           most));
  }
  try {
    check_sweep_rows(SweepSpace(std::move(at_lo)), file);
  } catch (const InputError&) {
    check_sweep_rows(SweepSpace(std::move(at_hi)), file, "--free");
  }
}

/// Turns a request into a question.
class RequestReader {
 public:
  RequestReader(const DesignFile& file, const DesignRequest& request)
      : file_(file), request_(request) {}

  DesignQuestion read() {
    DesignProblem& problem = question_.problem;
    problem.base = file_.design;
    problems_.succeeds([&] { problem.free = read_axes(request_.free, file_, AxisUse::searched); });
    problems_.succeeds([&] { read_standard(problem.free); });
    problems_.succeeds([&] {
      problem.objective = candidate_quantity(request_.minimize, "--minimize " + request_.minimize);
    });
    for (const std::string& text : request_.subject_to)
      problems_.succeeds([&] { read_limit(text); });
    problems_.succeeds([&] { read_front(); });
    problems_.throw_if_any();
    if (problem.free.empty()) {
      throw InputError("--free", "is needed: which fields may the search change?");
    }
    check_choices(problem.free, file_);
    question_.search.seed = request_.seed;
    return std::move(question_);
  }

 private:
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
    const auto freed = std::ranges::find(axes, "tether.cross_section_mm2", &SweepAxis::name);
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
    const auto bound = at == std::string::npos ? std::nullopt : parsed_number(text.substr(at + 2));
    if (!bound) throw InputError(where, "expected KEY<=VALUE or KEY>=VALUE");
    question_.problem.limits.push_back(
        {text, candidate_quantity(text.substr(0, at), where), *bound, text[at] == '<' ? 1 : -1});
  }

  void read_front() {
    if (request_.pareto.empty()) return;
    if (request_.pareto.size() != 2) {
      throw InputError("--pareto", "expected two keys, such as total_power_W,tether_mass_g");
    }
    const auto quantity = [](const std::string& key) {
      return candidate_quantity(key, "--pareto " + key);
    };
    question_.front = {quantity(request_.pareto[0]), quantity(request_.pareto[1])};
  }

  const DesignFile& file_;
  const DesignRequest& request_;
  DesignQuestion question_;
  Problems problems_;
};

}  // namespace

CandidateQuantity candidate_quantity(const std::string& key, const std::string& where) {
  std::string name = key;
  PointQuantity quantity;
  for (const auto& [prefix, which] :
       {std::pair{"hover.", Condition::hover}, {"forward.", Condition::forward}}) {
    if (name.starts_with(prefix)) {
      name.erase(0, std::string_view(prefix).size());
      quantity.condition = which;
    }
  }
  // The cross-section that a candidate flies, which its fields need not hold.
  if (name == cross_section_path) name = "cross_section_mm2";
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
      quantity.member = field.member;
      quantity.si_factor = field.si_factor;
      return quantity;
    }
  }
  if (const SpecField* field = find_field(key); field != nullptr && is_numeric(*field)) {
    return [field](const Design& design) { return field_value(design, *field).value_or(nan); };
  }
  throw InputError(where, fmt::format("there is no key \"{}\"{}", key, did_you_mean(name, known)));
}

DesignQuestion read_design_request(const DesignFile& file, const DesignRequest& request) {
  return RequestReader(file, request).read();
}

}  // namespace tethercalc
