// Reference designs held against the results recorded for them.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "tethercalc/io/input_error.hpp"
#include "tethercalc/report/text_table.hpp"
#include "tethercalc/study/reference.hpp"

namespace tethercalc {

/// The record of "design.json" is "design.expected.json" beside it: an object from a result's name
/// to `{"value": …, "relative_tolerance": …}`, or "absolute_tolerance" in the result's unit, or
/// both, of which the wider one counts. Texts and null have no tolerance. Names are those of
/// `reference_results`.
[[nodiscard]] std::filesystem::path record_path(const std::filesystem::path& spec);

/// The specs that `paths` mean: files themselves (a record means its spec), and of folders every
/// .json file that is no record, by name. Throws InputError for what does not exist, folders
/// without specs, and records without a spec.
[[nodiscard]] std::vector<std::filesystem::path> reference_specs(
    std::span<const std::string> paths);

/// A reference design and how it compares with its record.
struct ReferenceCheck {
  std::filesystem::path spec;           ///< the design's file
  std::string name;                     ///< of the design
  bool recorded = false;                ///< there is a record
  std::vector<RecordedResult> results;  ///< in the record's order
  std::vector<InputProblem> problems;   ///< of spec or record; then nothing was compared

  /// True where there is a record and nothing drifted.
  [[nodiscard]] bool passed() const;
};

/// Computes a reference design and compares it with its record. Problems of the files are part of
/// the answer, so that one bad file does not hide what the others say.
[[nodiscard]] ReferenceCheck check_reference(const std::filesystem::path& spec);

/// Brings the record of a checked design up to date, the tolerances kept: results that drifted get
/// the computed value; those within their tolerance keep the recorded one, lest they creep. Without
/// a record, makes one of the main results with a relative tolerance of 1e-6, hundred times what
/// the position of a flat optimum may be off. Returns whether anything was written. Throws
/// InputError where it cannot be written.
bool update_record(const ReferenceCheck& check);

/// One line a design, what drifted below it, and a count at the end.
[[nodiscard]] std::string check_text(std::span<const ReferenceCheck> checks, bool updated,
                                     const TextStyle& style);
/// Every recorded result of every design, for programs.
[[nodiscard]] nlohmann::ordered_json check_json(std::span<const ReferenceCheck> checks);

/// A header and one row a recorded result.
[[nodiscard]] std::string check_csv(std::span<const ReferenceCheck> checks);

/// A JUnit XML report, which CI systems read: a test case a design, a failure where it drifted or
/// has no record, an error where it could not be checked.
[[nodiscard]] std::string check_junit(std::span<const ReferenceCheck> checks);

}  // namespace tethercalc
