#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "support/random.hpp"
#include "support/random_designs.hpp"
#include "tethercalc/solve/sweep_space.hpp"

using namespace tethercalc;
using namespace tethercalc::test;

namespace {

SweepAxis mass_axis(decltype(SweepAxis::values) values) {
  return {"drone.mass_g", std::move(values),
          [](Design& design, double value) { design.drone.mass = value * unit::gram; }};
}

SweepAxis voltage_axis(decltype(SweepAxis::values) values) {
  return {"supply.voltage_V", std::move(values),
          [](Design& design, double value) { design.supply.voltage = value; }};
}

/// Choices that set mass and voltage at once, as a motor sets a whole curve.
SweepAxis choice_axis() {
  return {"drone.motor", NamedChoices{{"light", "heavy"}}, [](Design& design, double position) {
            design.drone.mass = position == 0 ? 1 : 2;
            design.supply.voltage = position == 0 ? 10 : 20;
          }};
}

std::vector<std::vector<double>> all_points(const SamplePlan& plan, std::size_t dimensions) {
  UnitPoints points(plan, dimensions);
  std::vector<std::vector<double>> all;
  for (std::uint64_t i = 0; i < plan.count; ++i) {
    all.emplace_back(dimensions);
    points.at(i, all.back());
  }
  return all;
}

/// Largest number of `points` in any of `slices` equal slices of a dimension.
std::size_t fullest_slice(const std::vector<std::vector<double>>& points, std::size_t dimension,
                          std::size_t slices) {
  std::vector<std::size_t> counts(slices);
  for (const auto& point : points) {
    REQUIRE(point[dimension] > 0);
    REQUIRE(point[dimension] < 1);
    ++counts[static_cast<std::size_t>(point[dimension] * static_cast<double>(slices))];
  }
  return *std::max_element(counts.begin(), counts.end());
}

}  // namespace

TEST_CASE("decimal ranges hold the numbers one would write") {
  const SweepAxis axis = mass_axis(DecimalRange{-3, 1, 10, 1});
  const double written[] = {-0.3, -0.2, -0.1, 0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  for (std::uint64_t i = 0; i < 10; ++i) CHECK(value_at(axis, i) == written[i]);
}

TEST_CASE("rows are the Cartesian product with the last axis fastest") {
  const SweepSpace space(
      {voltage_axis(std::vector<double>{40, 60}), mass_axis(DecimalRange{1000, 500, 3, 0})});
  REQUIRE(space.rows() == 6);
  SweepCursor cursor(space, published_design());
  std::vector<double> seen;
  for (std::uint64_t row = 0; row < 6; ++row) {
    cursor.move_to(row);
    CHECK(cursor.design().supply.voltage == cursor.values()[0]);
    CHECK(cursor.design().drone.mass == cursor.values()[1] * unit::gram);
    seen.insert(seen.end(), cursor.values().begin(), cursor.values().end());
  }
  CHECK(seen == std::vector<double>{40, 1000, 40, 1500, 40, 2000, 60, 1000, 60, 1500, 60, 2000});
}

TEST_CASE("a row's design does not depend on the rows visited before") {
  const std::vector<SweepAxis> axes{voltage_axis(std::vector<double>{40, 60, 80}), choice_axis(),
                                    mass_axis(DecimalRange{1000, 500, 4, 0})};
  const SweepSpace enumerated(axes);
  const SweepSpace drawn(axes, {100, SampleMethod::sobol, run_seed()});
  for (const SweepSpace* space : {&enumerated, &drawn}) {
    SweepCursor walked(*space, published_design());
    each_random(200, [&](Random& random) {
      const auto row =
          static_cast<std::uint64_t>(random.integer(0, static_cast<int>(space->rows()) - 1));
      walked.move_to(row);
      SweepCursor fresh(*space, published_design());
      fresh.move_to(row);
      CHECK(walked.design().drone.mass == fresh.design().drone.mass);
      CHECK(walked.design().supply.voltage == fresh.design().supply.voltage);
      // Numbers win over the choice that would set them too.
      CHECK(fresh.design().supply.voltage == fresh.values()[0]);
      CHECK(fresh.design().drone.mass == fresh.values()[2] * unit::gram);
    });
  }
}

TEST_CASE("shards follow each other and differ by one row at most") {
  each_random(200, [&](Random& random) {
    const auto rows = static_cast<std::uint64_t>(random.magnitude(1, 1e12)) - 1;
    const auto parts = static_cast<std::uint64_t>(random.integer(1, 50));
    std::uint64_t end = 0;
    for (std::uint64_t part = 1; part <= parts; ++part) {
      const RowRange range = shard_rows(rows, part, parts);
      CHECK(range.begin == end);
      CHECK(range.end - range.begin >= rows / parts);
      CHECK(range.end - range.begin <= rows / parts + 1);
      end = range.end;
    }
    CHECK(end == rows);
  });
  CHECK_THROWS_AS(shard_rows(10, 0, 3), std::invalid_argument);
  CHECK_THROWS_AS(shard_rows(10, 4, 3), std::invalid_argument);
}

TEST_CASE("a product too large to count is refused") {
  const SweepAxis large = mass_axis(DecimalRange{0, 1, std::uint64_t{1} << 40, 0});
  CHECK_THROWS_AS(SweepSpace({large, large}), std::invalid_argument);
  CHECK_THROWS_AS(SweepSpace({mass_axis(Uniform{1, 2})}), std::invalid_argument);
}

TEST_CASE("points can be drawn in any order") {
  for (const SampleMethod method : {SampleMethod::sobol, SampleMethod::latin_hypercube}) {
    const SamplePlan plan{300, method, run_seed()};
    const auto in_order = all_points(plan, 5);
    UnitPoints points(plan, 5);
    std::vector<double> point(5);
    each_random(300, [&](Random& random) {
      const int index = random.integer(0, 299);
      points.at(static_cast<std::uint64_t>(index), point);
      CHECK(point == in_order[static_cast<std::size_t>(index)]);
    });
  }
}

TEST_CASE("unshifted Sobol points are the published sequence") {
  // Bratley and Fox 1988, two dimensions, from the zeroth point on; a digital shift moves every
  // point by the same exclusive or, so differences of two seeds' first points cancel it.
  const double expected[][2] = {{0, 0},         {0.5, 0.5},     {0.75, 0.25},   {0.25, 0.75},
                                {0.375, 0.375}, {0.875, 0.875}, {0.625, 0.125}, {0.125, 0.625}};
  const auto points = all_points({8, SampleMethod::sobol, run_seed()}, 2);
  const auto digits = [](double u) { return static_cast<std::uint64_t>(u * 0x1p52); };
  for (std::size_t d = 0; d < 2; ++d) {
    for (std::size_t i = 0; i < 8; ++i) {
      const auto unshifted = digits(points[i][d]) ^ digits(points[0][d]);
      CHECK(static_cast<double>(unshifted) * 0x1p-52 == expected[i][d]);
    }
  }
}

TEST_CASE("every slice of a dimension holds its share of points") {
  const std::uint64_t seed = run_seed();
  const auto sobol = all_points({1024, SampleMethod::sobol, seed}, 6);
  const auto hypercube = all_points({777, SampleMethod::latin_hypercube, seed}, 6);
  for (std::size_t d = 0; d < 6; ++d) {
    CHECK(fullest_slice(sobol, d, 1024) == 1);
    CHECK(fullest_slice(hypercube, d, 777) == 1);
  }
}

TEST_CASE("seeds and dimensions draw different points") {
  for (const SampleMethod method : {SampleMethod::sobol, SampleMethod::latin_hypercube}) {
    const auto one = all_points({64, method, 1}, 2);
    const auto two = all_points({64, method, 2}, 2);
    CHECK(one != two);
    const auto same = std::count_if(one.begin(), one.end(),
                                    [](const auto& point) { return point[0] == point[1]; });
    CHECK(same == 0);
  }
}

TEST_CASE("draws follow their distributions") {
  // The median and the normal distribution's 97.5 % quantile, 1.959964 standard deviations (any
  // table of it).
  const SweepAxis normal = voltage_axis(Normal{75, 1.5});
  CHECK(quantile(normal, 0.5) == Approx(75).epsilon(1e-15));
  CHECK(quantile(normal, 0.975) == Approx(75 + 1.5 * 1.959964).epsilon(1e-7));
  const SweepAxis uniform = voltage_axis(Uniform{10, 60});
  CHECK(quantile(uniform, 0.5) == 35);
  CHECK(quantile(uniform, 1e-300) == 10);

  const SweepAxis whole = voltage_axis(UniformInteger{4, 8});
  std::vector<int> counts(9);
  for (int i = 0; i < 1000; ++i) {
    ++counts[static_cast<std::size_t>(quantile(whole, (i + 0.5) / 1000))];
  }
  for (std::size_t value = 4; value <= 8; ++value) CHECK(counts[value] == 200);
}
