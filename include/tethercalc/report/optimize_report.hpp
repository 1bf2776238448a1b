// The answer of `optimize` for people, programs and spreadsheets, and those of its sisters
// `evaluate` and `compare`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/io/library.hpp"
#include "tethercalc/report/text_table.hpp"
#include "tethercalc/solve/headroom.hpp"
#include "tethercalc/solve/optimize.hpp"
#include "tethercalc/solve/remedies.hpp"

namespace tethercalc {

/// One cross-section in both flight conditions.
struct AreaPoints {
  double area = 0;         ///< m²
  OperatingPoint hover;    ///< in hover
  OperatingPoint forward;  ///< in forward flight
};

/// A conductor that can be bought, or the one the spec names.
struct SizePoints {
  std::string name;   ///< "AWG 17"
  AreaPoints points;  ///< what it would give
};

/// Everything `optimize` says about a design.
struct OptimizeStudy {
  DesignFile file;                ///< the spec
  Optimization result;            ///< the optimum, or what stands in its way
  BestHeadroom best_headroom;     ///< at `requirements.headroom_at`
  std::vector<SizePoints> sizes;  ///< neighbours of the optimum in each standard, by rising area
  std::vector<AreaPoints> table;  ///< by rising area; holds optimum, minimum and feasible edges
  std::vector<Remedy> remedies;   ///< for an infeasible design
};

/// Optimises the design and evaluates what is told beside the optimum.
[[nodiscard]] OptimizeStudy study(DesignFile file);

/// Both conditions at each of `areas` (m², > 0).
[[nodiscard]] std::vector<AreaPoints> evaluate_areas(const Design& design,
                                                     std::span<const double> areas);

/// Why a point cannot be used in this design, in words; empty where it can.
[[nodiscard]] std::string shortcoming(const Design& design, const AreaPoints& points);

/// The answer in words.
struct Answer {
  std::string headline;                ///< the cable to fly, or that none can
  std::vector<std::string> sentences;  ///< why, and what that means in flight
  std::vector<std::string> remedies;   ///< changes that help where none can: "a supply of …"
};

/// What is told of a design before any table.
[[nodiscard]] Answer answer(const OptimizeStudy& study);

/// Power, current, voltage and headroom of the optimum, a row a condition. For a feasible result.
[[nodiscard]] TitledTable condition_table(const OptimizeStudy& study);

/// `study.sizes`, with what keeps each from being usable.
[[nodiscard]] TitledTable sizes_table(const OptimizeStudy& study);

/// `study.table`, the optimum emphasised.
[[nodiscard]] TitledTable power_table(const OptimizeStudy& study);

/// Everything about steady flight in one condition, a row an area.
[[nodiscard]] TitledTable operating_table(const Design& design, Condition condition,
                                          std::span<const AreaPoints> areas);

/// Opens with the answer in sentences, then standard sizes and the power table; 100 columns at
/// most.
[[nodiscard]] std::string optimize_text(const OptimizeStudy& study, const TextStyle& style);
/// The result keys of `optimize`.
[[nodiscard]] nlohmann::ordered_json optimize_json(const OptimizeStudy& study);

/// A header and one row: status, limit, area, and both operating points.
[[nodiscard]] std::string optimize_csv(const OptimizeStudy& study);

/// A table a condition, and what keeps an area from being usable.
[[nodiscard]] std::string evaluate_text(const DesignFile& file, std::span<const AreaPoints> table,
                                        const TextStyle& style);
/// The key `table` of `evaluate`.
[[nodiscard]] nlohmann::ordered_json evaluate_json(const DesignFile& file,
                                                   std::span<const AreaPoints> table);
/// A header and two rows an area, hover first.
[[nodiscard]] std::string evaluate_csv(std::span<const AreaPoints> table);

/// One motor's best tether.
struct MotorOptimum {
  MotorEntry motor;            ///< from the library or a file
  Design design;               ///< the design with this motor
  Optimization result;         ///< its optimum
  BestHeadroom best_headroom;  ///< at `requirements.headroom_at`
};

/// The design with each of `motors` in turn, feasible ones first by rising power, infeasible ones
/// last by falling best headroom.
[[nodiscard]] std::vector<MotorOptimum> compare_motors(const Design& design,
                                                       std::vector<MotorEntry> motors);
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
