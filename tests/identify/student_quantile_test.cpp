// Student's quantiles against a printed table.
#include <array>
#include <catch2/catch.hpp>

#include "identify/statistics.hpp"

using namespace tethercalc;

TEST_CASE("Student's quantiles are those of the printed table, and odd about one half") {
  // Degrees of freedom, probability, t: NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.2.
  constexpr std::array<std::array<double, 3>, 7> table{{{1, 0.975, 12.706},
                                                        {1, 0.999, 318.313},
                                                        {2, 0.95, 2.920},
                                                        {5, 0.975, 2.571},
                                                        {10, 0.999, 4.143},
                                                        {30, 0.90, 1.310},
                                                        {100, 0.975, 1.984}}};
  for (const auto& [degrees, p, t] : table) {
    CHECK(student_quantile(degrees, p) == Approx(t).margin(6e-4));
    CHECK(student_quantile(degrees, 1 - p) == Approx(-student_quantile(degrees, p)));
  }
  CHECK(student_quantile(7, 0.5) == 0);
}

TEST_CASE("beyond Student's quantile lies what is asked, far out in the tail as well") {
  for (const double degrees : {1.0, 3.5, 20.0, 1e6}) {
    for (const double p : {1e-12, 1e-6, 1e-3, 0.3}) {
      CHECK(student_tail(-student_quantile(degrees, p), degrees) == Approx(p).epsilon(1e-9));
    }
  }
}
