// What is asked of a design beside its spec, as typed: cross-sections, motors to compare, the place
// and air of a cable.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/study/cable_shape.hpp"

namespace tethercalc {

/// The cross-sections that were typed in mm² or as names of standard sizes, in m². Throws
/// InputError with every one that is neither.
[[nodiscard]] std::vector<double> parsed_areas(const std::vector<std::string>& texts);

/// `areas`, or else the spec's own; throws InputError where it has none.
[[nodiscard]] std::vector<double> chosen_areas(std::vector<double> areas, const Design& design);

/// The only one of them, or the spec's own, for an answer (`asked`: "an envelope") that is of one
/// cross-section. Throws InputError where there are more or none.
[[nodiscard]] double one_area(const std::vector<std::string>& texts, const Design& design,
                              std::string_view asked);

/// The motors that `--motors` names: "all" (of the library, and the spec's own where that is none
/// of them), "alike" (`alike_motors`), names of the library, or files, which `load` reads. Throws
/// InputError with every name that there is none of.
[[nodiscard]] std::vector<MotorEntry> chosen_motors(const std::vector<std::string>& names,
                                                    const DesignFile& file, const TextLoader& load);

/// The cable as typed: lengths in m, forces in N, speeds in m/s, angles in degrees. What is not
/// given is as the spec says.
struct CableOptions {
  std::vector<std::string> areas_mm2;
  std::optional<double> height;
  std::optional<double> offset;
  std::vector<std::string> winds;
  double wind_from = 0;
  std::vector<std::string> slacks_percent;
  std::optional<double> length;
  std::optional<double> winch_tension;
  std::optional<double> axial_stiffness;
  std::optional<double> station_height;
  std::optional<std::string> profile;
  std::optional<double> reference_height;
  std::optional<double> exponent;
  std::optional<double> roughness_length;
};

/// A design's cable and what is asked of it: one request a wind and slack.
struct AskedShapes {
  DesignFile file;
  double area = 0;  ///< m²
  std::vector<ShapeRequest> requests;
};

/// The shapes of the cable of `file` that `options` ask for. Throws InputError with every option
/// that is out of range, and where the cross-section is not known.
[[nodiscard]] AskedShapes asked_shapes(const CableOptions& options, DesignFile file);

}  // namespace tethercalc
