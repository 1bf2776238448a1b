// Rows of a sweep with cables as they hang: each by itself, whatever was computed before it.

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "support/random_designs.hpp"
#include "tethercalc/solve/optimize.hpp"
#include "tethercalc/study/sweep.hpp"

using namespace tethercalc;
using test::Random;

namespace {

/// The numbers that a row has.
std::vector<double> row_of(const Design& design) {
  const SweepOutcome outcome = sweep_outcome(design, false);
  std::vector<double> row{outcome.area()};
  for (const Condition condition : {Condition::hover, Condition::forward}) {
    const OperatingPoint& point = outcome.points.in(condition);
    row.insert(row.end(), {point.total_power, point.headroom, point.pitch, point.takeoff_mass});
  }
  return row;
}

/// The rows of the designs in this order, by a thread that has computed nothing yet.
std::vector<std::vector<double>> rows_in_new_thread(const std::vector<Design>& designs,
                                                    const std::vector<std::size_t>& order) {
  std::vector<std::vector<double>> rows(designs.size());
  std::thread([&] {
    for (const std::size_t i : order) rows[i] = row_of(designs[i]);
  }).join();
  return rows;
}

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

}  // namespace

TEST_CASE("rows that share cables of other slacks, places or winches say what each says alone") {
  struct Swept {
    const char* what;
    double lo;
    double hi;
    void (*apply)(Design&, double);
    void (*base)(Design&) = [](Design&) {};
  };
  const auto slack = [](Design& d, double x) { d.tether.slack = x; };
  const auto wind = [](Design& d, double x) { d.flight.headwind = x; };
  const auto length = [](Design& d, double x) { d.tether.length = x; };
  const auto by_reynolds_number = [](Design& d) {
    d.tether.drag_by_reynolds_number = true;
    d.tether.slack = 0.03;
  };
  const Swept all[]{{"slack", 0.01, 0.05, slack},
                    {"aside", 2, 9, [](Design& d, double x) { d.flight.horizontal_offset = x; }},
                    {"winch", 8, 14, [](Design& d, double x) { d.tether.winch_pull = x; }},
                    {"wind on a winch that holds few conductors up", 4, 6, wind,
                     [](Design& d) { d.tether.winch_pull = 3; }},
                    {"wind with drag by the Reynolds number", 0, 6, wind, by_reynolds_number},
                    {"length with drag by the Reynolds number", 15, 35, length, by_reynolds_number},
                    {"length in a wind over grass", 15, 35, length,
                     [](Design& d) {
                       d.flight.wind_profile = WindProfile::logarithmic;
                       d.flight.wind_reference_height = 10;
                       d.flight.headwind = 3;
                       d.tether.slack = 0.02;
                     }},
                    {"wind by a power law", 0, 3, wind,
                     [](Design& d) { d.flight.wind_profile = WindProfile::power_law; }}};
  const std::size_t step_between = test::leave_rates_out() ? std::size(all) - 1 : 1;
  for (std::size_t k = 0; k < std::size(all); k += step_between) {
    const Swept& swept = all[k];
    INFO(swept.what);
    Design base = test::published_design();
    base.tether.model = TetherModel::solved;
    base.requirements.thrust_headroom = 1.3;
    swept.base(base);
    const std::int64_t rows = 500;
    const auto lo = static_cast<std::int64_t>(std::lround(1e6 * swept.lo));
    const auto step = static_cast<std::int64_t>(std::lround(1e6 * (swept.hi - swept.lo))) / rows;
    const SweepSpace space({{swept.what, DecimalRange{lo, step, rows, 6}, swept.apply}});
    std::vector<std::pair<double, double>> shared;  // m², W
    const auto write = [&](std::string& text, const SweepRow& row) {
      fmt::format_to(std::back_inserter(text), "{} {}\n", row.outcome.area(),
                     judged_power(row.outcome, row.design));
    };
    SweepJob job{&space, &base, write, {0, space.rows()}, 0, {}};
    std::string whole;
    compute_sweep(job, [&](const SweepChunk& chunk) {
      whole += chunk.text;
      for (const JudgedRow& row : chunk.judged) shared.emplace_back(row.area, row.power);
      return true;
    });
    job.range = {400, space.rows()};
    std::string end;
    compute_sweep(job, [&](const SweepChunk& chunk) {
      end += chunk.text;
      return true;
    });
    CHECK(whole.ends_with(end));
    SweepCursor cursor(space, base);
    for (std::uint64_t row = 3; row < space.rows(); row += 101) {
      cursor.move_to(row);
      const SweepOutcome alone = sweep_outcome(cursor.design());
      INFO("row " << row);
      // About a minimum the power hardly depends on the area.
      CHECK(shared[row].first == Approx(alone.area()).epsilon(1e-5));
      CHECK(shared[row].second == Approx(judged_power(alone, cursor.design())).epsilon(1e-7));
    }
  }
}

TEST_CASE("a row of a sweep over a solved tether is the same whatever was computed before it") {
  test::each_random(2, [](Random& random) {
    Design base = test::published_design();
    base.tether.model = TetherModel::solved;
    base.requirements.thrust_headroom = 1.3;
    base.tether.slack = random.magnitude(5e-3, 0.1);
    if (random.chance(0.5)) base.flight.horizontal_offset = random.uniform(0, 12);
    if (random.chance(0.3)) base.flight.wind_profile = WindProfile::logarithmic;
    std::vector<Design> designs;
    std::vector<std::size_t> order;
    for (int i = 0; i < 8; ++i) {
      Design design = base;
      design.flight.headwind = random.uniform(0, 8);
      design.flight.air_density = random.uniform(0.9, 1.3);
      design.drone.mass = random.uniform(1.3, 1.8);
      if (base.flight.wind_profile == WindProfile::uniform) {
        design.tether.length = random.uniform(15, 40);
      }
      order.push_back(designs.size());
      designs.push_back(design);
    }
    const auto forward = rows_in_new_thread(designs, order);
    std::reverse(order.begin(), order.end());
    const auto backward = rows_in_new_thread(designs, order);
    for (std::size_t i = 0; i < designs.size(); ++i) {
      INFO("row " << i << " headwind " << designs[i].flight.headwind);
      CHECK(std::equal(forward[i].begin(), forward[i].end(), backward[i].begin(), same));
      CHECK(same(row_of(designs[i])[0], forward[i][0]));
      CHECK(same(optimize(designs[i]).area, forward[i][0]));
    }
  });
}
