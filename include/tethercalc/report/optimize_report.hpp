// The answer of `optimize` for people, programs and spreadsheets, and those of its sisters
// `evaluate` and `compare`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/report/text_table.hpp"
#include "tethercalc/study/optimum.hpp"

namespace tethercalc {

/// The answer in words.
struct Answer {
  std::string headline;                ///< the cable to fly, or that none can
  std::vector<std::string> sentences;  ///< why, and what that means in flight
  std::vector<std::string> remedies;   ///< changes that help where none can: "a supply of …"
};

/// What is told of a design before any table.
[[nodiscard]] Answer answer(const DesignFile& file, const OptimumStudy& study);

/// Power, current, voltage and headroom of the optimum, a row a condition. For a feasible result.
[[nodiscard]] TitledTable condition_table(const Optimization& result);

/// `study.sizes`, with what keeps each from being usable.
[[nodiscard]] TitledTable sizes_table(const OptimumStudy& study);

/// `study.table`, the optimum emphasised.
[[nodiscard]] TitledTable power_table(const OptimumStudy& study);

/// Opens with the answer in sentences, then standard sizes and the power table; 100 columns at
/// most.
[[nodiscard]] std::string optimize_text(const DesignFile& file, const OptimumStudy& study,
                                        const TextStyle& style);

/// The result keys of `optimize`.
[[nodiscard]] nlohmann::ordered_json optimize_json(const DesignFile& file,
                                                   const OptimumStudy& study);

/// A header and one row: status, limit, area, and both operating points.
[[nodiscard]] std::string optimize_csv(const OptimumStudy& study);

/// A table a condition, and what keeps an area from being usable.
[[nodiscard]] std::string evaluate_text(const DesignFile& file, std::span<const AreaPoints> table,
                                        const TextStyle& style);
/// The key `table` of `evaluate`.
[[nodiscard]] nlohmann::ordered_json evaluate_json(const DesignFile& file,
                                                   std::span<const AreaPoints> table);
/// A header and two rows an area, hover first.
[[nodiscard]] std::string evaluate_csv(std::span<const AreaPoints> table);

/// The feasible motors of a ranking of `compare_motors`.
[[nodiscard]] TitledTable motor_table(const Design& design, std::span<const MotorOptimum> ranking);

/// The infeasible ones, each with the reason in a few words.
[[nodiscard]] std::vector<std::string> refused_motors(std::span<const MotorOptimum> ranking);

/// The ranking as a table, the infeasible motors below it with the reason.
[[nodiscard]] std::string compare_text(const DesignFile& file,
                                       std::span<const MotorOptimum> ranking,
                                       const TextStyle& style);
/// An object a motor, with its optimum as in `optimize`.
[[nodiscard]] nlohmann::ordered_json compare_json(const DesignFile& file,
                                                  std::span<const MotorOptimum> ranking);
/// A header and a row a motor, with the columns of `optimize_csv` after its id.
[[nodiscard]] std::string compare_csv(std::span<const MotorOptimum> ranking);

}  // namespace tethercalc
