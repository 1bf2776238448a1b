// Student's quantiles against closed forms and printed tables.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "identify/statistics.hpp"

using namespace tethercalc;

TEST_CASE("with one and two degrees of freedom Student's quantile is its closed form") {
  for (const double p : {0.001, 0.2, 0.5, 0.9, 0.975, 0.9999}) {
    CHECK(student_quantile(1, p) == Approx(std::tan(std::numbers::pi * (p - 0.5))).margin(1e-12));
    CHECK(student_quantile(2, p) == Approx((p - 0.5) * std::sqrt(2 / (p * (1 - p)))).margin(1e-12));
  }
}

TEST_CASE("Student's quantiles are those of every printed table") {
  CHECK(student_quantile(5, 0.975) == Approx(2.571).margin(5e-4));
  CHECK(student_quantile(10, 0.975) == Approx(2.228).margin(5e-4));
  CHECK(student_quantile(30, 0.975) == Approx(2.042).margin(5e-4));
  CHECK(student_quantile(5, 0.025) == Approx(-student_quantile(5, 0.975)));
}

TEST_CASE("beyond Student's quantile lies what is asked, far out in the tail as well") {
  for (const double degrees : {1.0, 3.5, 20.0, 1e6}) {
    for (const double p : {1e-12, 1e-6, 1e-3, 0.3}) {
      CHECK(student_tail(-student_quantile(degrees, p), degrees) == Approx(p).epsilon(1e-9));
    }
  }
}
