// What a sweep answers: a line of text a design and, of a sample, how its results are spread and
// which inputs spread them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/report/text_table.hpp"
#include "tethercalc/study/sweep.hpp"

namespace tethercalc {

/// How rows are written.
enum class RowFormat {
  csv,        ///< RFC 4180 with plain newlines; empty where a value does not exist
  json_lines  ///< one object a line, the CSV's columns its keys; null where one does not exist
};

/// Turns outcomes into rows: the varied values by their dot paths, then `status` ("optimal",
/// "infeasible"; "feasible" for a given cable), `limited_by`, `limiting_condition`,
/// `cross_section_mm2`, the operating points as "hover." and "forward." followed by the keys of
/// `operating_point_fields`, `power_uncertainty_percent` and `drag_uncertainty_factor`, by which
/// the motors' power and the drag may be off either way where they are estimates, and `reason`.
/// Numbers are the shortest texts that read back as the same double.
class SweepRows {
 public:
  /// For rows that begin with a value of each of `axes`.
  SweepRows(std::span<const SweepAxis> axes, RowFormat format);

  /// The line of column names; empty for JSON Lines.
  [[nodiscard]] const std::string& header() const { return header_; }

  /// Appends one row, newline included.
  void append(std::string& text, const SweepRow& row) const;

 private:
  std::vector<SweepAxis> axes_;
  RowFormat format_;
  std::string header_;
  std::vector<std::string> openings_;  ///< what stands in front of each column's value
};

/// What holds for a whole sweep about `base`: its `spec_warnings`, the `ground_warning` of
/// `ground`, which `ground_contact` found in the sweep, and the first `density_warning` of some
/// rows that are spread over all of them.
[[nodiscard]] std::vector<Warning> sweep_warnings(const DesignFile& base, const SweepSpace& space,
                                                  const std::optional<GroundContact>& ground);

/// One column of records.
struct RecordColumn {
  std::string name;            ///< as in the CSV
  std::size_t characters = 0;  ///< of words: the most there can be; 0: a number
  std::size_t offset = 0;      ///< bytes from the record's beginning
};

/// Turns outcomes into records of one size, for programs that compute with them: the columns of
/// `SweepRows` but for `reason`. A number is a double, NaN where it does not exist; words are code
/// points of 4 bytes, zeros behind the last. All in the machine's byte order, nothing between.
class SweepRecords {
 public:
  /// For records that begin with a value of each of `axes`.
  explicit SweepRecords(std::span<const SweepAxis> axes);

  /// What stands in a record.
  [[nodiscard]] const std::vector<RecordColumn>& columns() const { return columns_; }

  /// Bytes of a record.
  [[nodiscard]] std::size_t size() const { return size_; }

  /// Appends one record.
  void append(std::string& bytes, const SweepRow& row) const;

 private:
  std::vector<SweepAxis> axes_;
  std::vector<RecordColumn> columns_;
  std::size_t size_ = 0;
};

/// Tables for people.
[[nodiscard]] std::string summary_text(const SweepSummary& summary, const SweepSpace& space,
                                       const TextStyle& style);
/// The same for programs, numbers in full.
[[nodiscard]] nlohmann::ordered_json summary_json(const SweepSummary& summary,
                                                  const SweepSpace& space);

}  // namespace tethercalc
