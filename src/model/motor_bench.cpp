#include "tethercalc/model/motor_bench.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace tethercalc {
namespace {

using Pool = PooledMotorPoints;

Pool merged(Pool low, const Pool& high) {
  const auto n = static_cast<double>(low.members.size());
  const auto m = static_cast<double>(high.members.size());
  // A weighted step from one mean to the other: unlike a sum it cannot overflow.
  const double share = m / (n + m);
  low.mean.thrust += share * (high.mean.thrust - low.mean.thrust);
  low.mean.power += share * (high.mean.power - low.mean.power);
  low.members.insert(low.members.end(), high.members.begin(), high.members.end());
  return low;
}

bool rises(const MotorPoint& low, const MotorPoint& high) {
  return low.thrust < high.thrust && low.power < high.power;
}

}  // namespace

IsotonicMotorPoints isotonic_motor_points(std::span<const MotorPoint> measured) {
  for (const MotorPoint& point : measured) {
    const bool usable = std::isfinite(point.thrust) && point.thrust > 0 &&
                        std::isfinite(point.power) && point.power > 0;
    if (!usable) throw std::invalid_argument("thrust and power must be finite and positive");
  }
  std::vector<std::size_t> order(measured.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return measured[a].thrust < measured[b].thrust;
  });

  std::vector<Pool> pools;
  for (std::size_t i = 0; i < order.size();) {
    Pool pool{{order[i]}, measured[order[i]]};
    for (++i; i < order.size() && measured[order[i]].thrust == pool.mean.thrust; ++i) {
      pool = merged(std::move(pool), {{order[i]}, measured[order[i]]});
    }
    while (!pools.empty() && !rises(pools.back().mean, pool.mean)) {
      pool = merged(std::move(pools.back()), pool);
      pools.pop_back();
    }
    pools.push_back(std::move(pool));
  }

  IsotonicMotorPoints result;
  for (Pool& pool : pools) {
    result.points.push_back(pool.mean);
    if (pool.members.size() > 1) result.pooled.push_back(std::move(pool));
  }
  return result;
}

}  // namespace tethercalc
