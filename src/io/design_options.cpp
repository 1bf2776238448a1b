#include "io/design_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>
#include <utility>

#include "io/checked_values.hpp"
#include "io/closest_name.hpp"
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

WindProfile parsed_profile(const std::string& text) {
  const std::vector<std::string> names{"uniform", "power-law", "logarithmic"};  // as in WindProfile
  const auto found = std::ranges::find(names, text);
  if (found != names.end()) return static_cast<WindProfile>(found - names.begin());
  throw InputError("--profile", "\"" + text +
                                    "\" is not a profile; allowed are uniform, power-law " +
                                    "and logarithmic" + did_you_mean(text, names));
}

/// The number in its range; `least`, with the reason among the problems, outside.
double checked(Problems& problems, const char* option, double value, double least, double most,
               const char* unit) {
  if (value >= least && value <= most) return value;
  problems.add(option, fmt::format("{:g} is out of range; allowed is {:g} to {:g} {}", value, least,
                                   most, unit));
  return least;
}

/// The numbers of a list, each in its range.
std::vector<double> checked(Problems& problems, const char* option,
                            const std::vector<std::string>& texts, double least, double most,
                            const char* unit) {
  std::vector<double> numbers;
  for (const std::string& text : texts) {
    if (const auto number = parsed_number(text)) {
      numbers.push_back(checked(problems, option, *number, least, most, unit));
    } else {
      problems.add(option, "\"" + text + "\" is not a number");
    }
  }
  return numbers;
}

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
    return {{.length = checked(problems, "--length", *options.length, 1e-3, 1e6, "m"),
             .winch_tension = {}}};
  }
  if (options.winch_tension) {
    return {{.length = {},
             .winch_tension =
                 checked(problems, "--winch-tension", *options.winch_tension, 1e-6, 1e6, "N")}};
  }
  if (given == 0) return {paid_out_to(design.tether, request.height, request.offset)};
  std::vector<PaidOut> out;
  for (const double percent :
       checked(problems, "--slack", options.slacks_percent, 1e-6, 1000, "percent")) {
    Tether tether = design.tether;
    tether.winch_pull = 0;
    tether.slack = percent / 100;
    out.push_back(paid_out_to(tether, request.height, request.offset));
  }
  return out;
}

std::vector<ShapeRequest> parsed_requests(const CableOptions& options, const Design& design) {
  Problems problems;
  ShapeRequest request;
  request.height =
      checked(problems, "--height", options.height.value_or(design.tether.length), 0.01, 1e5, "m");
  const Flight& flight = design.flight;
  request.offset =
      checked(problems, "--offset", options.offset.value_or(flight.horizontal_offset), 0, 1e5, "m");
  request.wind_from =
      checked(problems, "--wind-from", options.wind_from, -360, 360, "degrees") * unit::degree;
  request.station_height =
      checked(problems, "--station-height", options.station_height.value_or(flight.station_height),
              0, 1e5, "m");
  request.profile = flight.wind_profile;
  if (options.profile) {
    problems.succeeds([&] { request.profile = parsed_profile(*options.profile); });
  }
  request.reference_height = checked(
      problems, "--reference-height",
      options.reference_height.value_or(flight.wind_reference_height.value_or(10)), 0.1, 1e4, "m");
  request.exponent =
      checked(problems, "--exponent", options.exponent.value_or(flight.wind_exponent), 0, 1, "");
  request.roughness_length =
      checked(problems, "--roughness", options.roughness_length.value_or(flight.roughness_length),
              1e-6, 10, "m");
  if (request.roughness_length >= request.reference_height) {
    problems.add("--roughness", "has to be less than --reference-height");
  }
  request.axial_stiffness = design.tether.axial_stiffness;
  if (options.axial_stiffness) {
    request.axial_stiffness =
        checked(problems, "--stiffness", *options.axial_stiffness, 1, 1e12, "N");
  }
  std::vector<double> winds = checked(problems, "--wind", options.winds, 0, 200, "m/s");
  if (options.winds.empty()) winds = {std::abs(design.flight.airspeed)};
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
  std::vector<double> areas;
  Problems problems;
  for (const std::string& text : texts) {
    if (const auto area = standard_area(text)) {
      areas.push_back(*area);
      continue;
    }
    const std::optional<double> area = parsed_number(text);
    // Beyond these, square millimetres were surely not meant, and the physics loses its digits.
    if (!area || !(*area >= 1e-6 && *area <= 1e6)) {
      problems.add("--area-mm2",
                   "\"" + text + "\" is not a cross-section from 0.000001 to 1000000 mm², nor a " +
                       "standard size such as AWG18");
      continue;
    }
    areas.push_back(*area * unit::square_millimetre);
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
