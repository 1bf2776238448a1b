// Seeded randomness: every run tries other cases, any run can be repeated.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <random>
#include <string>

namespace tethercalc::test {

/// Seed of this run: the environment's TETHERCALC_TEST_SEED, else a fresh one.
inline unsigned run_seed() {
  static const unsigned seed = [] {
    const char* given = std::getenv("TETHERCALC_TEST_SEED");
    return given ? static_cast<unsigned>(std::stoul(given)) : std::random_device{}();
  }();
  return seed;
}

/// One case of so many is tried under a sanitizer, which looks at code and not at rates and makes
/// it four to ten times slower.
#ifdef TETHERCALC_SANITIZED
constexpr std::size_t stride() { return 20; }
#else
constexpr std::size_t stride() { return 1; }
#endif

/// Whether a test of nothing but rates is left out: under a sanitizer, where other tests fly the
/// code that it flies.
constexpr bool leave_rates_out() { return stride() > 1; }

/// How many of `count` ≥ 1 to try where a rate is what is tested.
constexpr int draws(int count) { return std::max(1, count / static_cast<int>(stride())); }

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double uniform(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(engine_);
  }
  /// Uniform in the logarithm; 0 < lo < hi.
  double magnitude(double lo, double hi) { return std::exp(uniform(std::log(lo), std::log(hi))); }
  int integer(int lo, int hi) { return std::uniform_int_distribution<int>(lo, hi)(engine_); }
  bool chance(double probability) { return uniform(0, 1) < probability; }

 private:
  std::mt19937 engine_;
};

/// Calls `visit(random)` `count` times; a failure names the seed with which it is the first case.
template <typename Visit>
void each_random(int count, Visit visit) {
  for (unsigned i = 0; i < static_cast<unsigned>(count); ++i) {
    INFO("TETHERCALC_TEST_SEED=" << run_seed() + i);
    Random random(run_seed() + i);
    visit(random);
  }
}

}  // namespace tethercalc::test
