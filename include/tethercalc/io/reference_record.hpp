// Records of reference designs: the results that a design had, held against those it has now.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/study/results.hpp"

namespace tethercalc {

/// A reference design and how it compares with its record.
struct ReferenceCheck {
  std::string spec;                     ///< the design's file
  std::string name;                     ///< of the design
  bool recorded = false;                ///< there is a record
  std::vector<RecordedResult> results;  ///< in the record's order
  std::vector<InputProblem> problems;   ///< of spec or record; then nothing was compared

  /// True where there is a record and nothing drifted.
  [[nodiscard]] bool passed() const;
};

/// Compares the `results` of the design of `file`, which messages call `spec`, with its record: an
/// object from a result's name to `{"value": …, "relative_tolerance": …}`, or "absolute_tolerance"
/// in the result's unit, or both, of which the wider one counts. Texts and null have no tolerance.
/// Names are those of `reference_results`. Problems of the record are part of
/// the answer, so that one bad file does not hide what the others say.
[[nodiscard]] ReferenceCheck check_reference(std::string spec, const DesignFile& file,
                                             const std::vector<NamedResult>& results,
                                             const std::optional<LoadedText>& record);

/// The record of a design that was checked without problems, brought up to date, the tolerances
/// kept: results that drifted get the computed value; those within their tolerance keep the
/// recorded one, lest they creep. Without an old record, one of the main results with a relative
/// tolerance of 1e-6, hundred times what the position of a flat optimum may be off.
[[nodiscard]] std::string updated_record(const ReferenceCheck& check,
                                         const std::optional<LoadedText>& old);

}  // namespace tethercalc
