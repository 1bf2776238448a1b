// Power logs that the simulation itself makes: whatever the design, a diagnosis against that design
// has nothing to say, and against another one says what the simulation then does.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <random>

#include "support/random.hpp"
#include "support/random_designs.hpp"
#include "tethercalc/diagnose/power_diagnosis.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/model/operating_point.hpp"
#include "tethercalc/model/power_line.hpp"
#include "tethercalc/model/steady_flight.hpp"
#include "tethercalc/solve/optimize.hpp"

using namespace tethercalc;

namespace {

/// The published drone on a cable of 1.09 mm², with materials of which every field may make use.
Design flown() {
  Design d = test::published_design();
  d.tether.cross_section = 1.09e-6;
  d.tether.conductor.temperature_coefficient = 0.004;
  d.tether.conductor.tensile_strength = 70e6;
  d.tether.insulation.breakdown_strength = 20e6;
  d.tether.strength_member.material = StrengthMaterial::aramid;
  d.supply.converter.rated_output_power = 900;
  return d;
}

constexpr double plateau = 75;  // s
constexpr int plateaus = 12;

double height_at(double time) {
  constexpr double heights[] = {10, 27, 18, 5, 30, 14};
  return heights[static_cast<int>(time / plateau) % 6];
}

double airspeed_at(double time) {
  constexpr double speeds[] = {0, 6, 3, 9, 8};
  return speeds[static_cast<int>(time / (plateau / 3)) % 5];
}

/// What each instrument would read, but for its noise. The cable of a design with measured heating
/// warms from a cold start.
struct Readings {
  double drone_voltage = 0;  ///< V
  double current = 0;        ///< A
  double drone_power = 0;    ///< W at the converter's input
  double bus_power = 0;      ///< W
};

Readings readings(const Design& d, const FlightState& state, double rise) {
  const double area = *d.tether.cross_section;
  const OperatingPoint point = evaluate(d, area, state);
  double resistance = point.tether_resistance;
  if (d.tether.heating.rise_per_loss > 0) {
    const double warm = state.ambient_temperature_C + rise;
    resistance = SteadyFlight(d, state).tether().resistance(conductor_radius(area), warm, warm);
  }
  Readings r;
  r.drone_power = point.drone_power;
  r.current = supplied_power(d.supply.voltage, resistance, point.drone_power) / d.supply.voltage;
  r.drone_voltage = d.supply.voltage - r.current * resistance;
  r.bus_power =
      converter_output_power(d.supply.converter, point.drone_power - d.drone.auxiliary_power);
  return r;
}

/// Where and how fast is flown at a time.
struct Course {
  double (*height)(double) = height_at;
  double (*airspeed)(double) = airspeed_at;
};

PowerLog log_of(const Design& d, unsigned seed, const Course& course = {}) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  PowerLog log;
  double rise = 0;
  for (double t = 0; t < plateau * plateaus; ++t) {
    const double ambient = 18 + 4 * t / (plateau * plateaus);
    const FlightState state = flight_state_at(d, course.height(t), course.airspeed(t), ambient);
    const Readings r = readings(d, state, rise);
    const double settled =
        settled_rise(d.tether, *d.tether.cross_section, r.current, state.airspeed);
    rise = settled + (rise - settled) * std::exp(-1 / d.tether.heating.time_constant);
    constexpr double bus_voltage = 16;
    log.time.push_back(t);
    log.height.push_back(state.deployed);
    log.airspeed.push_back(state.airspeed);
    log.ambient_temperature_C.push_back(ambient);
    log.supply_voltage.push_back(d.supply.voltage + 0.035 * normal(engine));
    log.supply_current.push_back(r.current + 0.015 * normal(engine));
    log.drone_voltage.push_back(r.drone_voltage + 0.025 * normal(engine));
    log.bus_voltage.push_back(bus_voltage + 0.01 * normal(engine));
    log.bus_current.push_back(r.bus_power / bus_voltage + 0.06 * normal(engine));
  }
  return log;
}

/// With all else at once the line may be too weak, or the cable too warm.
bool can_fly(const Design& d) {
  for (double t = 0; t < plateau * plateaus; t += plateau / 3) {
    const FlightState state = flight_state_at(d, height_at(t), airspeed_at(t), 22);
    if (!(evaluate(d, *d.tether.cross_section, state).total_power > 0)) return false;
  }
  return true;
}

/// Values for fields that are zero or not set in the design, in the field's unit.
double value_off_neutral(const SpecField& field, const Design& d) {
  static const std::map<std::string, double, std::less<>> values{
      {"/drone/drag/fore_aft_asymmetry", 0.2},
      {"/drone/translational_lift/induced_share", 0.2},
      {"/drone/reserve_battery/specific_energy_Wh_kg", 150},
      {"/drone/motor_air_density_kg_m3", 1.1},
      {"/tether/spooled_length_m", 20},
      {"/tether/insulation/dielectric_safety_factor", 400},
      {"/tether/contact_resistance_ohm", 0.3},
      {"/tether/ambient_temperature_C", 20},
      {"/tether/heating/rise_K_m_per_W", 15},
      {"/tether/heating/wind_cooling_sqrt_s_per_m", 0.2},
      {"/tether/sun_W_m2", 500},
      {"/tether/inclination_deg", 80},
      {"/tether/cover/mass_g_m", 3},
      {"/tether/cover/width_mm", 1},
      {"/tether/drum/layers", 2},
      {"/tether/drum/derating", 0.6},
      {"/tether/drum/core_diameter_mm", 200},
      {"/tether/drum/width_mm", 200},
      {"/tether/drum/package_conductivity_W_mK", 0.2},
      {"/tether/strength_member/cross_section_mm2", 1},
      {"/tether/vibration_amplitude", 0.1},
      {"/tether/winch_pull_N", 2},
      {"/supply/converter/losses/fixed_W", 12},
      {"/supply/converter/losses/square_per_W", 1e-4},
      {"/supply/converter/max_input_voltage_V", 100},
      {"/supply/converter/specific_mass_kg_per_kW", 0.4},
      {"/supply/converter/fixed_ratio", 0.25},
      {"/supply/converter/min_output_voltage_V", 10},
      {"/tether/axial_stiffness_N", 20000},
      {"/flight/headwind_m_s", 3},
      {"/flight/horizontal_offset_m", 5},
      {"/flight/station_height_m", 3},
      {"/flight/wind_reference_height_m", 10},
      {"/requirements/strength_safety_factor", 5}};
  if (const auto given = values.find(field.pointer); given != values.end()) return given->second;
  const double now = field_value(d, field).value_or(0);
  INFO(field.pointer << " is zero in the design: give it a value above");
  REQUIRE(now != 0);
  return field.kind == FieldKind::integer ? now + 1 : now * 1.07;
}

/// Those that hold a number or a choice.
std::vector<const SpecField*> changeable_fields() {
  std::vector<const SpecField*> fields;
  for (const SpecField& field : spec_fields()) {
    if (is_numeric(field) || !field_words(field.kind).empty()) fields.push_back(&field);
  }
  return fields;
}

/// Puts another value into the field.
void change(Design& design, const SpecField& field) {
  if (is_numeric(field)) return set_field(design, field, value_off_neutral(field, design));
  set_word(design, field, (field_word(design, field) + 1) % field_words(field.kind).size());
}

/// Some choices are of a tether that hangs only.
void hang_where_asked_for(Design& design) {
  const bool asked = design.tether.drag_by_reynolds_number || design.flight.horizontal_offset > 0;
  if (asked) design.tether.model = TetherModel::solved;
}

std::string told(const Diagnosis& d) {
  std::string text;
  for (const Finding& f : d.findings) text += f.effect + " ";
  return d.unexplained.detected ? text + d.unexplained.shape : text;
}

/// A name is found by chance in at most one log of fifty; twice running in none.
void check_nothing_is_found(const Design& design, unsigned seed) {
  std::string first;
  for (const unsigned attempt : {0U, 1U}) {
    const Diagnosis d = diagnose_power(design, log_of(design, seed + attempt)).diagnosis;
    if (d.findings.empty() && !d.unexplained.detected) return;
    if (attempt == 0) first = told(d);
    if (attempt == 1) FAIL_CHECK("found " << first << " and then " << told(d));
  }
}

/// Every third field, one at a time.
void check_fields(std::size_t remainder) {
  const auto fields = changeable_fields();
  for (std::size_t f = remainder; f < fields.size(); f += 3 * test::stride()) {
    Design design = flown();
    change(design, *fields[f]);
    hang_where_asked_for(design);
    INFO(fields[f]->pointer << ", TETHERCALC_TEST_SEED=" << test::run_seed());
    check_nothing_is_found(design, test::run_seed() + 10 * static_cast<unsigned>(f));
  }
}

void set(Design& design, const char* path, double value) {
  set_field(design, *find_field(path), value);
}

double mean(const std::vector<double>& values, std::size_t first, std::size_t last) {
  double sum = 0;
  for (std::size_t i = first; i < last; ++i) sum += values[i];
  return sum / static_cast<double>(last - first);
}

}  // namespace

TEST_CASE("a log of the simulation shows nothing, whichever field is off neutral, first third") {
  check_fields(0);
}

TEST_CASE("a log of the simulation shows nothing, whichever field is off neutral, second third") {
  check_fields(1);
}

TEST_CASE("a log of the simulation shows nothing, whichever field is off neutral, last third") {
  check_fields(2);
}

TEST_CASE("a log of the simulation shows nothing with any set of fields off neutral") {
  test::each_random(test::draws(12), [](test::Random& random) {
    Design design = flown();
    std::string changed;
    for (const SpecField* field : changeable_fields()) {
      if (!random.chance(0.5)) continue;
      change(design, *field);
      changed += std::string(field->pointer) + " ";
    }
    hang_where_asked_for(design);
    INFO(changed);
    if (!can_fly(design)) return;
    check_nothing_is_found(design, static_cast<unsigned>(random.integer(0, 1 << 30)));
  });
}

TEST_CASE("the extended design does what the diagnosis predicted") {
  struct Case {
    const char* name;
    void (*change)(Design&);
  };
  const std::vector<Case> cases{
      {"resistivity", [](Design& d) { d.tether.conductor.resistivity_20C *= 1.15; }},
      {"contacts", [](Design& d) { set(d, "tether.contact_resistance_ohm", 0.4); }},
      {"drum", [](Design& d) { set(d, "tether.spooled_length_m", 20); }},
      {"heat",
       [](Design& d) {
         set(d, "tether.heating.rise_K_m_per_W", 25);
         set(d, "tether.heating.time_constant_s", 6);
       }},
      {"converter",
       [](Design& d) {
         set(d, "supply.converter.losses.fixed_W", 20);
         set(d, "supply.converter.losses.square_per_W", 1.5e-4);
       }},
      {"auxiliaries", [](Design& d) { set(d, "drone.auxiliary_power_W", 35); }},
      {"mass", [](Design& d) { set(d, "drone.mass_g", 1910); }},
      {"motors", [](Design& d) { set(d, "drone.motor_power_factor", 1.1); }},
      {"lift", [](Design& d) { set(d, "drone.translational_lift.induced_share", 0.3); }},
      {"tether drag", [](Design& d) { set(d, "tether.drag_coefficient", 2); }},
      {"airframe drag",
       [](Design& d) {
         d.drone.drag.front_area *= 1.5;
         d.drone.drag.top_area *= 1.5;
       }},
      {"both", [](Design& d) {
         set(d, "tether.contact_resistance_ohm", 0.4);
         set(d, "drone.mass_g", 1910);
       }}};
  for (const bool warm : {false, true}) {
    for (std::size_t k = warm ? 1 : 0; k < cases.size(); k += test::stride()) {
      const Case& c = cases[k];
      Design spec = flown();
      if (warm) spec.tether.ambient_temperature_C = 20;
      Design truth = spec;
      c.change(truth);
      const PowerLog log = log_of(truth, test::run_seed());
      const PowerDiagnosis found = diagnose_power(spec, log);
      INFO(c.name << ": " << told(found.diagnosis) << "TETHERCALC_TEST_SEED=" << test::run_seed());
      REQUIRE_FALSE(found.diagnosis.findings.empty());
      REQUIRE(found.diagnosis.compared.size() == 3);
      for (std::size_t first = 0; first < log.time.size(); first += 25) {
        // The last 5 s at one height and airspeed: the cable's heat has settled, nothing moves.
        const std::size_t i = first + 20;
        const std::size_t last = first + 25;
        const FlightState state = flight_state_at(found.extended, log.height[i], log.airspeed[i],
                                                  mean(log.ambient_temperature_C, i, last));
        const OperatingPoint point =
            evaluate(found.extended, *found.extended.tether.cross_section, state);
        const double predicted[] = {
            found.extended.supply.voltage - point.received_voltage, point.drone_power,
            converter_output_power(found.extended.supply.converter,
                                   point.drone_power - found.extended.drone.auxiliary_power)};
        for (std::size_t channel = 0; channel < 3; ++channel) {
          // A prediction starts from what was measured before it, five noisy samples: 0.2 % of the
          // bus power, 0.1 % of the current.
          const auto& after = found.diagnosis.compared[channel].after;
          INFO(found.diagnosis.compared[channel].quantity << " at " << log.time[i] << " s");
          CHECK(mean(after, i, last) == Approx(predicted[channel]).epsilon(0.01));
        }
      }
    }
  }
}

TEST_CASE("measured heating moves the optimum also where the air has a temperature") {
  Design spec = flown();
  spec.tether.ambient_temperature_C = 20;
  Design truth = spec;
  truth.tether.heating = {60, 30, 0.1};
  const PowerDiagnosis found = diagnose_power(spec, log_of(truth, test::run_seed()));
  INFO(told(found.diagnosis) << "TETHERCALC_TEST_SEED=" << test::run_seed());
  REQUIRE_FALSE(found.diagnosis.findings.empty());
  CHECK(found.diagnosis.findings.front().effect == "conductor_heating");
  const Optimization before = optimize(spec);
  const Optimization after = optimize(found.extended);
  const Optimization known = optimize(truth);
  REQUIRE(before.feasible);
  REQUIRE(after.feasible);
  CHECK(after.area > 1.01 * before.area);
  CHECK(after.area == Approx(known.area).epsilon(0.01));
  CHECK(after.forward.total_power == Approx(known.forward.total_power).epsilon(0.002));
}

TEST_CASE("clocks that agree are left alone where channels are as noisy as what they show") {
  // Every minute to another height by 1 m/s, every 40 s to another airspeed.
  const Course course{[](double t) {
                        constexpr double heights[] = {12, 27, 8, 22, 5, 18};
                        const int k = static_cast<int>(t / 60);
                        const double from = heights[(k + 5) % 6];
                        const double way = heights[k % 6] - from;
                        const double gone = std::min(std::fmod(t, 60.0), std::abs(way));
                        return from + std::copysign(gone, way);
                      },
                      [](double t) {
                        constexpr double speeds[] = {1, 6, 3, 8, 4};
                        const int k = static_cast<int>(t / 40);
                        const double to = speeds[k % 5];
                        return to + (speeds[(k + 4) % 5] - to) * std::exp(-std::fmod(t, 40.0) / 10);
                      }};
  for (unsigned i = 0; i < 6; ++i) {
    PowerLog log = log_of(flown(), test::run_seed() + i, course);
    test::Random random(test::run_seed() + i);
    for (std::size_t k = 0; k < log.time.size(); ++k) {
      log.height[k] += random.uniform(-0.17, 0.17);
      log.airspeed[k] += random.uniform(-0.25, 0.25);
      log.drone_voltage[k] += random.uniform(-0.08, 0.08);
    }
    const Diagnosis diagnosis = diagnose_power(flown(), log).diagnosis;
    CHECK(std::ranges::none_of(
        diagnosis.notes, [](const Warning& note) { return note.kind == WarningKind::log_lag; }));
  }
}
