#include "tethercalc/solve/unit_points.hpp"

#include <algorithm>
#include <bit>
#include <boost/random/sobol.hpp>
#include <stdexcept>
#include <vector>

#include "solve/random_bits.hpp"

namespace tethercalc {
namespace {

/// Boost has direction numbers for 3667; far fewer than this vary in any design.
constexpr std::size_t max_dimensions = 1000;

/// A permutation of 0 … count − 1, chosen by `key`, of which any element is found on its own.
std::uint64_t permuted(std::uint64_t index, std::uint64_t count, std::uint64_t key) {
  if (count < 2) return index;
  const auto half_bits = (static_cast<unsigned>(std::bit_width(count - 1)) + 1) / 2;
  const std::uint64_t mask = (std::uint64_t{1} << half_bits) - 1;
  // Four rounds make a Feistel network a strong pseudorandom permutation (Luby and Rackoff 1988);
  // two more because the halves are small here. The network permutes fewer than 4·count numbers,
  // so the walk back into the range takes less than four steps on average.
  do {
    std::uint64_t left = index >> half_bits;
    std::uint64_t right = index & mask;
    for (std::uint64_t round = 0; round < 6; ++round) {
      const std::uint64_t next = left ^ (mixed_bits(key + round, right) & mask);
      left = right;
      right = next;
    }
    index = (left << half_bits) | right;
  } while (index >= count);
  return index;
}

}  // namespace

struct UnitPoints::Sequence {
  explicit Sequence(std::size_t dimensions) : engine(dimensions), digits(dimensions, 0) {}

  void move_to(std::uint64_t index) {
    if (index == current) return;
    if (index == 0) {
      std::ranges::fill(digits, 0);
    } else {
      // The engine leaves the zeroth point out: seeded with n, it goes on with point n + 1.
      if (current == 0 || index != current + 1) engine.seed(index - 1);
      engine.generate(digits.begin(), digits.end());
    }
    current = index;
  }

  boost::random::sobol engine;
  std::vector<std::uint64_t> digits;  ///< of point `current`, unshifted
  std::uint64_t current = 0;
};

UnitPoints::UnitPoints(const SamplePlan& plan, std::size_t dimensions)
    : plan_(plan), dimensions_(dimensions) {
  if (plan.count == 0) throw std::invalid_argument("a sample needs at least one point");
  if (dimensions == 0 || dimensions > max_dimensions) {
    throw std::invalid_argument("a sample has 1 to 1000 dimensions");
  }
  if (plan.method == SampleMethod::sobol) sequence_ = std::make_unique<Sequence>(dimensions);
}

UnitPoints::~UnitPoints() = default;
UnitPoints::UnitPoints(UnitPoints&&) noexcept = default;
UnitPoints& UnitPoints::operator=(UnitPoints&&) noexcept = default;

void UnitPoints::at(std::uint64_t index, std::span<double> point) {
  if (sequence_) {
    sequence_->move_to(index);
    for (std::size_t d = 0; d < dimensions_; ++d) {
      point[d] = unit_number(sequence_->digits[d] ^ mixed_bits(plan_.seed, d));
    }
    return;
  }
  const double count = static_cast<double>(plan_.count);
  for (std::size_t d = 0; d < dimensions_; ++d) {
    const std::uint64_t key = mixed_bits(plan_.seed, d);
    const double slice = static_cast<double>(permuted(index, plan_.count, key));
    const double within = unit_number(mixed_bits(~key, index));
    // Rounding must not carry the last slice's points to 1.
    point[d] = std::min((slice + within) / count, 1 - 0x1p-53);
  }
}

}  // namespace tethercalc
