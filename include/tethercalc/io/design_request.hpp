// What a user asks of a whole design, as written, and the question that it is.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/study/design.hpp"

namespace tethercalc {

/// What the user asks for, as written.
struct DesignRequest {
  std::vector<std::string> free;           ///< see `read_axes`
  std::string minimize = "total_power_W";  ///< a key, see `candidate_quantity`
  std::vector<std::string> subject_to;     ///< "KEY<=VALUE" or "KEY>=VALUE"
  std::string standard;                    ///< "awg", "iec" or "": sizes the cross-section comes in
  std::vector<std::string> pareto;         ///< two keys, or none
  std::uint64_t seed = 1;                  ///< of the points from which searches start
};

/// The number of a candidate that `key` names, in its practical unit: a key of an operating point,
/// `conductor_temperature_C`, `drum_temperature_C` or `tether_tension_N`, with "hover." or
/// "forward." before it or in the condition in which power is minimised (headroom: in which it is
/// demanded); or the path of a numeric field. Throws InputError with the closest key where there is
/// none.
[[nodiscard]] CandidateQuantity candidate_quantity(const std::string& key,
                                                   const std::string& where);

/// The question that `request` puts to the design of `file`. Throws InputError with all problems.
[[nodiscard]] DesignQuestion read_design_request(const DesignFile& file,
                                                 const DesignRequest& request);

}  // namespace tethercalc
