// Flights whose recorder was not perfect: rows that are missing, and stamps that are off.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "hidden_effects/diagnosed.hpp"
#include "hidden_effects/drawn_flight.hpp"
#include "support/random.hpp"

using namespace tethercalc;
using truth::drawn_flight;
using truth::HiddenFlight;

namespace {

struct Alarms {
  int names = 0;
  std::string told;
};

/// Of flights that hide nothing, recorded as `spoil` has it.
template <typename Spoil>
Alarms alarms(int flights, Spoil spoil) {
  Alarms all;
  for (int draw = 0; draw < flights; ++draw) {
    HiddenFlight hidden = drawn_flight(draw);
    spoil(hidden, draw);
    const Diagnosis d = diagnosed(hidden);
    all.names += d.findings.empty() ? 0 : 1;
    for (const Finding& f : d.findings) all.told += f.effect + " ";
  }
  return all;
}

constexpr int flights = test::draws(40);
/// 2 % are asked for; four of 40 have a chance of 0.8 % then.
constexpr int most_alarms = 3;

}  // namespace

TEST_CASE("rows that are missing here and there, and for seconds, give nothing a name") {
  const Alarms found = alarms(flights, [](HiddenFlight& hidden, int draw) {
    hidden.lost_rows = 0.05;
    hidden.gap = draw % 2 == 0 ? 3 : 0;
  });
  INFO(found.told);
  CHECK(found.names <= most_alarms);
}

TEST_CASE("stamps that are off by milliseconds give nothing a name") {
  const Alarms found = alarms(flights, [](HiddenFlight& hidden, int draw) {
    hidden.clock_jitter = 0.015;
    constexpr int steps[] = {10, 5, 4, 2};  // 10, 20, 25 and 50 Hz
    hidden.steps_per_sample = steps[draw % 4];
  });
  INFO(found.told);
  CHECK(found.names <= most_alarms);
}

TEST_CASE("what is hidden is found and sized in spite of missing rows and stamps that are off") {
  int found = 0;
  int covered = 0;
  const int draws = test::draws(8);
  for (int draw = 0; draw < draws; ++draw) {
    HiddenFlight hidden = drawn_flight(100 + draw);
    hidden.propwash = 0.4;
    hidden.lost_rows = 0.05;
    hidden.gap = 3;
    hidden.clock_jitter = draw % 2 == 0 ? 0.015 : 0;
    const Diagnosis d = diagnosed(hidden);
    const auto propwash = std::ranges::find(d.findings, "propwash", &Finding::effect);
    if (propwash == d.findings.end()) continue;
    ++found;
    const ParameterEstimate& k = propwash->parameters.front();
    covered += k.ci95_lower <= hidden.propwash && hidden.propwash <= k.ci95_upper ? 1 : 0;
    const bool evened = std::ranges::any_of(
        d.notes, [](const Warning& w) { return w.kind == WarningKind::log_clock_jitter; });
    CHECK(evened == (hidden.clock_jitter > 0));
  }
  CHECK(found >= draws - 1);
  CHECK(covered >= found - 3);
}
