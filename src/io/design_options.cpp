#include "io/design_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>
#include <utility>

#include "io/checked_values.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/study/design.hpp"
#include "tethercalc/study/motor.hpp"

namespace tethercalc {
namespace {

/// The area of the standard size of that name, however its blank and letters are typed: "AWG 18",
/// "awg18".
std::optional<double> standard_area(std::string_view text) {
  const auto plain = [](std::string_view name) {
    std::string out;
    for (const char c : name) {
      if (c != ' ') out += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
    return out;
  };
  for (const WireSize& size : wire_sizes()) {
    if (plain(size.name) == plain(text)) return size.area;
  }
  return std::nullopt;
}

/// Options that say for one question what fields of the spec say of the design: numbers in the
/// field's unit and range.
class FieldOptions {
 public:
  FieldOptions(const Design& design, Problems& problems) : design_(design), problems_(problems) {}

  /// What `option` says in place of the field at `path`, in SI; where it is not given or not
  /// allowed, what the design says, if that says anything.
  std::optional<double> number(const char* option, std::optional<double> given, const char* path) {
    const SpecField& field = *find_field(path);
    return given && allowed(option, field, *given) ? *given * field.si_factor
                                                   : field_value_si(design_, field);
  }

  /// Likewise of a list.
  std::vector<double> numbers(const char* option, const std::vector<std::string>& texts,
                              const char* path) {
    const SpecField& field = *find_field(path);
    std::vector<double> numbers;
    for (const std::string& text : texts) {
      const auto number = parsed_number(text);
      if (!number) {
        problems_.add(option, "\"" + text + "\" is not a number");
      } else if (allowed(option, field, *number)) {
        numbers.push_back(*number * field.si_factor);
      }
    }
    if (texts.empty()) numbers.push_back(field_value_si(design_, field).value_or(0));
    return numbers;
  }

  /// Likewise of a word, in which a hyphen may stand for the underscore.
  std::size_t word(const char* option, const std::optional<std::string>& given, const char* path) {
    const SpecField& field = *find_field(path);
    if (!given) return field_word(design_, field);
    const std::span<const std::string> words = field_words(field.kind);
    if (const auto word = typed_word(*given, words)) return *word;
    problems_.add(option, no_such_word(*given, words, shown(*given)));
    return 0;
  }

 private:
  bool allowed(const char* option, const SpecField& field, double value) {
    return problems_.succeeds([&] { check_range(option, value, field); });
  }

  const Design& design_;
  Problems& problems_;
};

/// What decides how much cable is out; several where several slacks are asked for.
std::vector<PaidOut> parsed_paid_out(const CableOptions& options, const Design& design,
                                     const ShapeRequest& request, Problems& problems) {
  const int given = int(!options.slacks_percent.empty()) + int(options.length.has_value()) +
                    int(options.winch_tension.has_value());
  if (given > 1) {
    problems.add("--slack, --length, --winch-tension",
                 "one of them decides how much cable is out; give no more");
    return {};
  }
  if (options.length) {
    problems.succeeds([&] { check_range("--length", *options.length, 1e-3, 1e6, "m"); });
    return {{.length = options.length, .winch_tension = {}}};
  }
  FieldOptions fields(design, problems);
  Tether tether = design.tether;
  if (options.winch_tension && !(*options.winch_tension > 0)) {
    problems.add("--winch-tension",
                 fmt::format("has to be more than 0 N, found {}; --slack or --length decides how "
                             "much cable is out without a winch",
                             *options.winch_tension));
  } else {
    tether.winch_pull =
        fields.number("--winch-tension", options.winch_tension, "tether.winch_pull_N").value();
  }
  if (!options.slacks_percent.empty()) tether.winch_pull = 0;
  std::vector<PaidOut> out;
  for (const double slack :
       fields.numbers("--slack", options.slacks_percent, "tether.slack_percent")) {
    tether.slack = slack;
    out.push_back(paid_out_to(tether, request.height, request.offset));
  }
  return out;
}

/// m/s that blow about the drone in forward flight, or in hover where the wind grows with height,
/// as the drone's own speed does not.
double flown_wind(const Design& design, WindProfile profile) {
  const bool grows = profile != WindProfile::uniform;
  const Condition condition = grows ? Condition::hover : Condition::forward;
  return std::abs(flight_state(design, condition).airspeed);
}

std::vector<ShapeRequest> parsed_requests(const CableOptions& options, const Design& design) {
  Problems problems;
  FieldOptions fields(design, problems);
  ShapeRequest request;
  request.height = fields.number("--height", options.height, "tether.length_m").value();
  request.offset = fields.number("--offset", options.offset, "flight.horizontal_offset_m").value();
  problems.succeeds([&] { check_range("--wind-from", options.wind_from, -360, 360, "degrees"); });
  request.wind_from = options.wind_from * unit::degree;
  request.station_height =
      fields.number("--station-height", options.station_height, "flight.station_height_m").value();
  request.profile =
      static_cast<WindProfile>(fields.word("--profile", options.profile, "flight.wind_profile"));
  request.reference_height = fields.number("--reference-height", options.reference_height,
                                           "flight.wind_reference_height_m");
  request.exponent = fields.number("--exponent", options.exponent, "flight.wind_exponent").value();
  request.roughness_length =
      fields.number("--roughness", options.roughness_length, "flight.roughness_length_m").value();
  const auto needs_profile = [&](const char* option, bool given, WindProfile profile) {
    if (!given || request.profile == profile) return;
    std::string name = field_words(FieldKind::wind_profile)[static_cast<std::size_t>(profile)];
    std::ranges::replace(name, '_', '-');  // as options are written
    problems.add(option, fmt::format("says nothing without --profile {}", name));
  };
  needs_profile("--exponent", options.exponent.has_value(), WindProfile::power_law);
  needs_profile("--roughness", options.roughness_length.has_value(), WindProfile::logarithmic);
  if (options.reference_height && request.profile == WindProfile::uniform) {
    problems.add("--reference-height", "says nothing without --profile");
  }
  const double known_at =
      request.reference_height.value_or(request.station_height + request.height);
  if (const auto rough = roughness_conflict(request.profile, request.roughness_length, known_at)) {
    problems.add("--roughness", *rough);
  }
  request.axial_stiffness =
      fields.number("--stiffness", options.axial_stiffness, "tether.axial_stiffness_N");
  const std::vector<double> winds =
      options.winds.empty() ? std::vector<double>{flown_wind(design, request.profile)}
                            : fields.numbers("--wind", options.winds, "flight.airspeed_m_s");
  const std::vector<PaidOut> lengths = parsed_paid_out(options, design, request, problems);
  problems.throw_if_any();
  std::vector<ShapeRequest> requests;
  for (const double wind : winds) {
    for (const PaidOut& paid_out : lengths) {
      requests.push_back(request);
      requests.back().wind = wind;
      requests.back().paid_out = paid_out;
    }
  }
  return requests;
}

}  // namespace

std::vector<double> parsed_areas(const std::vector<std::string>& texts) {
  const SpecField& field = *find_field(cross_section_path);
  std::vector<double> areas;
  Problems problems;
  for (const std::string& text : texts) {
    if (const auto area = standard_area(text)) {
      areas.push_back(*area);
      continue;
    }
    const auto mm2 = parsed_number(text);
    if (mm2 && field.range.contains(*mm2)) {
      areas.push_back(*mm2 * field.si_factor);
      continue;
    }
    problems.add("--area-mm2",
                 fmt::format("{} is no cross-section: {}, or a standard size such as AWG18",
                             shown(text), describe_range(field)));
  }
  problems.throw_if_any();
  return areas;
}

std::vector<double> chosen_areas(std::vector<double> areas, const Design& design) {
  if (!areas.empty()) return areas;
  if (!design.tether.cross_section) {
    throw InputError("--area-mm2", "is needed: the spec sets no tether.cross_section_mm2");
  }
  return {*design.tether.cross_section};
}

std::vector<MotorEntry> chosen_motors(const std::vector<std::string>& names, const DesignFile& file,
                                      const TextLoader& load) {
  std::vector<MotorEntry> motors;
  Problems problems;
  for (const std::string& name : names) {
    if (name == "all") {
      const std::vector<MotorEntry> library = library_motors();
      motors.insert(motors.end(), library.begin(), library.end());
      if (std::ranges::find(library, file.motor.id, &MotorEntry::id) == library.end()) {
        motors.push_back(file.motor);
      }
      continue;
    }
    if (name == "alike") {
      const std::vector<MotorEntry> alike = alike_motors(library_motors(), file.motor);
      motors.insert(motors.end(), alike.begin(), alike.end());
      continue;
    }
    try {
      motors.push_back(find_motor(name, load, "--motors"));
    } catch (const InputError& error) {
      problems.add(error.problems());
    }
  }
  problems.throw_if_any();
  return motors;
}

double one_area(const std::vector<std::string>& texts, const Design& design,
                std::string_view asked) {
  const std::vector<double> areas = parsed_areas(texts);
  if (areas.size() > 1) {
    throw InputError("--area-mm2", fmt::format("{} is that of one cross-section", asked));
  }
  return chosen_areas(areas, design).front();
}

AskedShapes asked_shapes(const CableOptions& options, DesignFile file) {
  AskedShapes out{std::move(file), 0, {}};
  out.area = one_area(options.areas_mm2, out.file.design, "a shape");
  out.requests = parsed_requests(options, out.file.design);
  return out;
}

}  // namespace tethercalc
