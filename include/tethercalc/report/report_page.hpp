// One page about one design that can be mailed: HTML with its figures inside and nothing to fetch.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tethercalc/report/result_figures.hpp"
#include "tethercalc/study/rules.hpp"

namespace tethercalc {

/// What a log says about the calculation.
struct LogDiagnosis {
  std::string log;      ///< its file, without folders
  Diagnosis diagnosis;  ///< of this log
};

/// Everything on the page.
struct PageContent : DesignOverview {
  DesignFile file;                      ///< the spec
  std::optional<DragStudy> drag;        ///< that a flight of this drone shows
  std::vector<LogDiagnosis> diagnoses;  ///< in the order they are told
  std::optional<RuleStudy> rules;       ///< of the answer's cable; nothing: no such section
  std::string command;                  ///< by which the page can be made again, for a shell
};

/// The page: the answer, what to mind, figures and tables, what the logs say, the spec as used, and
/// how it was computed. Sentences, tables and numbers are those of the commands `optimize`,
/// `compare`, `drag` and `diagnose`.
///
/// The text is UTF-8, HTML and well-formed XML at once. It holds neither scripts nor references to
/// anything outside of it, and its content security policy forbids both. Whatever a name holds
/// stands there as text. The same content makes the same page, byte by byte.
[[nodiscard]] std::string report_page(const PageContent& content);

}  // namespace tethercalc
