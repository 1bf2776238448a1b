// What a sampled sweep says as a whole: how its results are spread, and which inputs spread them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tethercalc/report/text_table.hpp"
#include "tethercalc/study/sweep.hpp"

namespace tethercalc {

/// Tables for people.
[[nodiscard]] std::string summary_text(const SweepSummary& summary, const SweepSpace& space,
                                       const TextStyle& style);
/// The same for programs, numbers in full.
[[nodiscard]] nlohmann::ordered_json summary_json(const SweepSummary& summary,
                                                  const SweepSpace& space);

}  // namespace tethercalc
