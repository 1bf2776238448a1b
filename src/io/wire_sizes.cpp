#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "io/embedded_files.hpp"
#include "tethercalc/io/library.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

double awg_area(int gauge) {
  const double diameter = 0.127 * std::pow(92.0, (36.0 - gauge) / 39.0) * unit::millimetre;
  return std::numbers::pi / 4 * diameter * diameter;
}

void add_metric_sizes(std::vector<WireSize>& sizes, const char* standard,
                      const nlohmann::json& areas_mm2) {
  for (const double area : areas_mm2) {
    sizes.push_back({standard, fmt::format("{} mm²", area), area * unit::square_millimetre});
  }
}

}  // namespace

std::vector<WireSize> wire_sizes() {
  const nlohmann::json tables = nlohmann::json::parse(embedded_file("wire_sizes.json"));
  std::vector<WireSize> sizes;
  const nlohmann::json& awg = tables.at("awg");
  for (int gauge = awg.at("from"); gauge <= awg.at("to").get<int>(); ++gauge) {
    sizes.push_back({"AWG", fmt::format("AWG {}", gauge), awg_area(gauge)});
  }
  add_metric_sizes(sizes, "IEC 60228", tables.at("iec60228").at("areas_mm2"));
  add_metric_sizes(sizes, "VDE 0295", tables.at("fine_strand").at("areas_mm2"));
  std::stable_sort(sizes.begin(), sizes.end(),
                   [](const WireSize& a, const WireSize& b) { return a.area < b.area; });
  return sizes;
}

}  // namespace tethercalc
