#include "tethercalc/solve/interval.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "support/random.hpp"

using namespace tethercalc;

namespace {

IntervalSet random_set(test::Random& random) {
  IntervalSet set;
  double at = 0;
  for (int i = random.integer(0, 5); i > 0; --i) {
    const double lo = at + random.integer(0, 3);
    at = lo + random.integer(0, 3);
    append(set, {lo, at});
  }
  if (random.chance(0.2)) append(set, {at + 1, std::numeric_limits<double>::infinity()});
  return set;
}

void check_disjoint_and_rising(const IntervalSet& set) {
  for (std::size_t i = 0; i < set.size(); ++i) {
    CHECK(set[i].lo <= set[i].hi);
    if (i > 0) CHECK(set[i].lo > set[i - 1].hi);
  }
}

}  // namespace

TEST_CASE("an interval holds its ends") {
  CHECK(Interval{1, 2}.contains(1));
  CHECK(Interval{1, 2}.contains(2));
  CHECK_FALSE(Interval{1, 2}.contains(2.0001));
  CHECK_FALSE(contains(IntervalSet{}, 1));
  CHECK(contains({{1, 2}, {4, std::numeric_limits<double>::infinity()}}, 1e300));
}

TEST_CASE("appending joins intervals that touch") {
  IntervalSet set;
  append(set, {1, 2});
  append(set, {2, 3});
  append(set, {4, 5});
  REQUIRE(set.size() == 2);
  CHECK(set[0].lo == 1);
  CHECK(set[0].hi == 3);
}

TEST_CASE("an intersection holds exactly what both sets hold, whichever comes first") {
  test::each_random(500, [](test::Random& random) {
    const IntervalSet a = random_set(random);
    const IntervalSet b = random_set(random);
    const IntervalSet both = intersection(a, b);
    const IntervalSet other = intersection(b, a);
    check_disjoint_and_rising(both);
    for (double x = -0.5; x < 40; x += 0.5) {
      CHECK(contains(both, x) == (contains(a, x) && contains(b, x)));
      CHECK(contains(other, x) == contains(both, x));
    }
  });
}

TEST_CASE("a set is its own intersection, with itself and with everything") {
  test::each_random(100, [](test::Random& random) {
    const IntervalSet a = random_set(random);
    const IntervalSet everything{{0, std::numeric_limits<double>::infinity()}};
    for (const IntervalSet& same : {intersection(a, a), intersection(a, everything)}) {
      REQUIRE(same.size() == a.size());
      for (std::size_t i = 0; i < a.size(); ++i) {
        CHECK(same[i].lo == a[i].lo);
        CHECK(same[i].hi == a[i].hi);
      }
    }
  });
}
