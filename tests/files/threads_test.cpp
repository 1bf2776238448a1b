#include <atomic>
#include <catch2/catch.hpp>
#include <stdexcept>
#include <vector>

#include "support/random.hpp"
#include "tethercalc/files/threads.hpp"

using namespace tethercalc;
using namespace tethercalc::test;

namespace {

/// Takes a time that differs from chunk to chunk.
void dawdle(std::uint64_t chunk) {
  std::atomic<std::uint64_t> spins{(chunk * 7919) % 500};
  while (spins.load() > 0) spins.fetch_sub(1);
}

const auto numbering = [] {
  return [](std::uint64_t chunk, std::uint64_t& result) {
    dawdle(chunk);
    result = chunk;
  };
};

}  // namespace

TEST_CASE("results arrive in order whatever the number of threads") {
  for (const unsigned threads : {1U, 2U, 7U}) {
    std::vector<std::uint64_t> order;
    compute_in_order<std::uint64_t>(5, 1005, several_threads(threads), numbering,
                                    [&](std::uint64_t chunk) {
                                      order.push_back(chunk);
                                      return true;
                                    });
    REQUIRE(order.size() == 1000);
    for (std::uint64_t i = 0; i < 1000; ++i) REQUIRE(order[i] == i + 5);
  }
}

TEST_CASE("few results exist at a time, however slow they are taken") {
  std::atomic<std::int64_t> ahead{0};
  std::atomic<std::int64_t> most_ahead{0};
  const auto counting = [&] {
    return [&](std::uint64_t, int&) {
      const std::int64_t now = ++ahead;
      std::int64_t most = most_ahead.load();
      while (now > most && !most_ahead.compare_exchange_weak(most, now)) {
      }
    };
  };
  compute_in_order<int>(0, 300, several_threads(3), counting, [&](int) {
    dawdle(499);
    --ahead;
    return true;
  });
  CHECK(most_ahead.load() <= 4 * 3);
}

TEST_CASE("the work ends early where its results are no longer wanted") {
  std::uint64_t taken = 0;
  compute_in_order<std::uint64_t>(0, 1U << 30, several_threads(2), numbering,
                                  [&](std::uint64_t) { return ++taken < 10; });
  CHECK(taken == 10);
  compute_in_order<std::uint64_t>(3, 3, several_threads(2), numbering, [&](std::uint64_t) {
    ++taken;
    return true;
  });
  CHECK(taken == 10);
}

TEST_CASE("exceptions of workers and takers come out") {
  const auto failing = [] {
    return [](std::uint64_t chunk, int&) {
      if (chunk == 20) throw std::runtime_error("worker");
    };
  };
  CHECK_THROWS_WITH(
      compute_in_order<int>(0, 1000, several_threads(3), failing, [](int) { return true; }),
      "worker");
  CHECK_THROWS_WITH(compute_in_order<std::uint64_t>(0, 1000, several_threads(3), numbering,
                                                    [](std::uint64_t chunk) -> bool {
                                                      if (chunk == 20) {
                                                        throw std::runtime_error("taker");
                                                      }
                                                      return true;
                                                    }),
                    "taker");
}
