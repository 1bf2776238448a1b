// What a diagnosis keeps for pictures.
#include <catch2/catch.hpp>
#include <cmath>

#include "diagnose/flight_prediction.hpp"
#include "diagnose/log_model.hpp"
#include "support/simulated_flight.hpp"
#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/diagnose/flight_diagnosis.hpp"
#include "tethercalc/diagnose/power_log.hpp"

using namespace tethercalc;

namespace {

double rms(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!std::isfinite(a[i]) || !std::isfinite(b[i])) continue;
    sum += (a[i] - b[i]) * (a[i] - b[i]);
    ++count;
  }
  return std::sqrt(sum / count);
}

}  // namespace

TEST_CASE("every effect of the catalogue names a channel of its log") {
  FlightRecord record;
  PowerLog log;
  for (const Effect& effect : effect_catalogue()) {
    INFO(effect.id);
    const Channel channel = effect.log == LogKind::flight ? flight_channel(effect.channel, record)
                                                          : power_channel(effect.channel, log);
    CHECK_FALSE(channel.name.empty());
    CHECK_FALSE(channel.unit.empty());
  }
  CHECK_THROWS_AS(flight_channel("supply_current", record), std::invalid_argument);
}

TEST_CASE("channels are what their names say") {
  FlightRecord record;
  record.time = {0, 1, 2};
  record.tilt = {0, 0.1, -0.2};
  record.forward_speed = {1, -3, 4};
  record.down_speed = {0, 1, -1};
  const double degree = 3.141592653589793 / 180;
  const auto rate = flight_channel("tilt_rate", record).values;
  CHECK(rate[0] == Approx(0.1 / degree));
  CHECK(rate[1] == Approx(-0.1 / degree));
  CHECK(rate[2] == Approx(-0.3 / degree));
  // Leaning against the motion, and signed like the motion.
  const auto braking = flight_channel("braking", record).values;
  CHECK(std::isnan(braking[0]));
  CHECK(braking[1] == Approx(-3 * 0.1 / degree));
  CHECK(braking[2] == Approx(4 * 0.2 / degree));
  CHECK(flight_channel("sinking", record).values == std::vector<double>{0, -3, -4});
  PowerLog log;
  log.supply_current = {2, 3};
  log.height = {5, 7};
  CHECK(power_channel("current_height", log).values == std::vector<double>{10, 21});
}

TEST_CASE("the compared series has the reported errors, and a finding's trace its gain") {
  test::SimulatedFlight flight;
  flight.duration = 240;
  flight.pitch_offset = 2 * unit::degree;
  Design design;
  design.drone.mass = flight.mass;
  design.flight.air_density = flight.air_density;
  FlightDiagnosisOptions options;
  options.base = {"linear_drag", "wind"};
  const Diagnosis d = diagnose_flight(design, test::simulate(flight), options);
  REQUIRE(d.findings.size() == d.traces.size());
  REQUIRE(d.findings.size() >= 1);
  CHECK(d.findings.front().effect == "pitch_trim");
  REQUIRE(d.compared.size() == 1);
  const ComparedSeries& series = d.compared.front();
  // The reported error gives outliers less weight; without outliers that is a per cent or two.
  CHECK(rms(series.measured, series.before) == Approx(d.base.holdout_rmse).epsilon(0.05));
  CHECK(rms(series.measured, series.after) == Approx(d.extended.holdout_rmse).epsilon(0.05));
  const std::vector<double> zero(series.time.size(), 0.0);
  const FindingTrace& trace = d.traces.front();
  CHECK(trace.channel.values.size() == series.time.size());
  CHECK(rms(trace.with, zero) < 1.02 * d.extended.holdout_rmse);
  // A trim of 2 degrees is g·tan 2° = 0.34 m/s² of missing acceleration.
  CHECK(rms(trace.without, trace.with) == Approx(0.34).margin(0.06));
}
