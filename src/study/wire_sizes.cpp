#include "tethercalc/study/wire_sizes.hpp"

#include <algorithm>

namespace tethercalc {

std::vector<WireNeighbours> wire_sizes_near(std::span<const WireSize> sizes, double area) {
  std::vector<WireNeighbours> all;
  for (const WireSize& size : sizes) {
    auto near = std::find_if(all.begin(), all.end(), [&size](const WireNeighbours& neighbours) {
      return neighbours.standard == size.standard;
    });
    if (near == all.end()) near = all.insert(all.end(), {size.standard, {}, {}});
    if (size.area <= area) near->below = size;
    if (size.area >= area && !near->above) near->above = size;
  }
  return all;
}

}  // namespace tethercalc
