// One line of text a design: what a sweep writes.
#pragma once

#include <span>
#include <string>
#include <vector>

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
/// `operating_point_fields`, and `reason`. Numbers are the shortest texts that read back as the
/// same double.
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

}  // namespace tethercalc
