// Sizes in which conductors are sold.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tethercalc {

/// A size in which conductors are sold.
struct WireSize {
  std::string standard;  ///< "AWG", "IEC 60228" or "VDE 0295"
  std::string name;      ///< "AWG 17", "1.5 mm²"
  double area = 0;       ///< m²
};

/// Neighbours of an area among the sizes of one standard. Both are the same where it is one of
/// them.
struct WireNeighbours {
  std::string standard;           ///< as in WireSize
  std::optional<WireSize> below;  ///< the largest not above the area
  std::optional<WireSize> above;  ///< the smallest not below it
};

/// The neighbours of `area` in m² (finite, ≥ 0) in each standard of `sizes`, which rise.
[[nodiscard]] std::vector<WireNeighbours> wire_sizes_near(std::span<const WireSize> sizes,
                                                          double area);

}  // namespace tethercalc
