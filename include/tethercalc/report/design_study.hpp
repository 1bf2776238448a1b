// The answer of `design`: the best whole design among those that free fields allow.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/report/text_table.hpp"
#include "tethercalc/solve/design_search.hpp"

namespace tethercalc {

/// What the user asks for, as written.
struct DesignRequest {
  std::vector<std::string> free;           ///< "PATH=lo..hi" or "PATH=a,b,c"
  std::string minimize = "total_power_W";  ///< a key, see `candidate_quantity`
  std::vector<std::string> subject_to;     ///< "KEY<=VALUE" or "KEY>=VALUE"
  std::string standard;                    ///< "awg", "iec" or "": sizes the cross-section comes in
  std::vector<std::string> pareto;         ///< two keys, or none
  std::uint64_t seed = 1;                  ///< of the points from which searches start
};

/// What one more of something costs at the optimum, everything else free to adapt.
struct ShadowPrice {
  std::string name;      ///< "supply.voltage_V <= 60", "tether.length_m"
  bool active = false;   ///< a demand or range that binds; otherwise a field of the spec
  double price = 0;      ///< change of the objective; NaN where no design is left
  double step = 1;       ///< for this change of it, in its unit
  std::string sentence;  ///< the same in words
};

/// One point of a Pareto front.
struct FrontPoint {
  double first = 0;               ///< the first key, which was minimised
  double second = 0;              ///< the second key, which was bounded
  nlohmann::ordered_json values;  ///< of the free fields, by path
};

/// Everything `design` says.
struct DesignStudy {
  DesignFile file;                  ///< what was asked about
  DesignRequest request;            ///< what was asked
  DesignAnswer answer;              ///< the best design
  nlohmann::ordered_json values;    ///< of the free fields at the optimum, by path
  nlohmann::ordered_json spec;      ///< ready to be flown: the file with these values
  std::vector<ShadowPrice> prices;  ///< what binds first; empty where infeasible
  std::vector<FrontPoint> front;    ///< by falling second key; empty where none was asked for
};

/// The number of a candidate that `key` names, in its practical unit: a key of an operating point,
/// `conductor_temperature_C`, `drum_temperature_C` or `tether_tension_N`, with "hover." or
/// "forward." before it or in the condition in which power is minimised (headroom: in which it is
/// demanded); or the path of a numeric field. Throws InputError with the closest key where there is
/// none.
[[nodiscard]] CandidateQuantity candidate_quantity(const std::string& key, const Design& design,
                                                   const std::string& where);

/// Throws InputError, with all problems, for what the request has wrong.
[[nodiscard]] DesignStudy study_design(DesignFile file, DesignRequest request);

/// Opens with the answer, then what binds, how sure it is, the front and the spec.
[[nodiscard]] std::string design_text(const DesignStudy& study, const TextStyle& style);
/// The same for programs.
[[nodiscard]] nlohmann::ordered_json design_json(const DesignStudy& study);

/// A header and one row: the free fields, whether the design is feasible, and the objective.
[[nodiscard]] std::string design_csv(const DesignStudy& study);

}  // namespace tethercalc
