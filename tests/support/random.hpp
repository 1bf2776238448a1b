// Seeded randomness: every run tries other cases, any run can be repeated.
#pragma once

#include <cmath>
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

/// Calls `visit(random)` `count` times; a failure names the seed that repeats its case alone.
#define TETHERCALC_EACH_RANDOM(count, random)                                                    \
  for (unsigned case_ = 0; case_ < static_cast<unsigned>(count); ++case_)                        \
    if (::tethercalc::test::Random random(::tethercalc::test::run_seed() + case_); true)         \
      if (INFO("TETHERCALC_TEST_SEED=" << ::tethercalc::test::run_seed() << ", case " << case_); \
          true)

}  // namespace tethercalc::test
