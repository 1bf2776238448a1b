// What tells a spike from what lasts.
#include <catch2/catch.hpp>
#include <vector>

#include "identify/statistics.hpp"

using namespace tethercalc;

TEST_CASE("a spike lies off its neighbours by its height, and a leap's sides by nothing") {
  std::vector<double> series(12, 1.0);
  series[4] = 6;
  std::vector<double> expected(12, 0.0);
  expected[4] = 5;
  CHECK(distance_from_neighbours(series, 2) == expected);

  series[4] = 1;
  for (std::size_t i = 6; i < series.size(); ++i) series[i] = -3;
  CHECK(distance_from_neighbours(series, 2) == std::vector<double>(12, 0.0));
}

TEST_CASE("at an end as many neighbours count as elsewhere, and too few say nothing") {
  CHECK(distance_from_neighbours({7, 0, 0, 0, 0, -7}, 2) == std::vector<double>{7, 0, 0, 0, 0, 7});
  CHECK(distance_from_neighbours({7, 0, 0, 0}, 2) == std::vector<double>(4, 0.0));
  CHECK(distance_from_neighbours({}, 2).empty());
}
