// Seeded randomness: every run tries other cases, any run can be repeated.
#pragma once

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

/// How many of `count` logs to try where a rate is what is tested: under a sanitizer, which looks
/// at code and not at rates and makes it four times slower, a quarter of them.
constexpr int draws(int count) {
#ifdef __SANITIZE_ADDRESS__
  return count / 4;
#else
  return count;
#endif
}

/// Step through a list of cases that each stand for themselves: one, under a sanitizer four.
constexpr std::size_t stride() { return static_cast<std::size_t>(4 / draws(4)); }

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
