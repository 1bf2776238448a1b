#include "identify/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace tethercalc {
namespace {

// Long double takes three times as long to compile, for digits nobody sees.
using Plain = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

template <class Distribution>
double tail(const Distribution& distribution, double value) {
  return boost::math::cdf(boost::math::complement(distribution, value));
}

}  // namespace

double student_quantile(double degrees, double p) {
  return boost::math::quantile(boost::math::students_t_distribution<double, Plain>(degrees), p);
}

double student_tail(double t, double degrees) {
  if (!std::isfinite(t)) return t > 0 ? 0 : 1;
  return tail(boost::math::students_t_distribution<double, Plain>(degrees), t);
}

double fisher_tail(double f, double numerator, double denominator) {
  if (!std::isfinite(f)) return 0;
  return tail(boost::math::fisher_f_distribution<double, Plain>(numerator, denominator),
              std::max(f, 0.0));
}

double chi_squared_tail(double x, double degrees) {
  return tail(boost::math::chi_squared_distribution<double, Plain>(degrees), std::max(x, 0.0));
}

}  // namespace tethercalc
