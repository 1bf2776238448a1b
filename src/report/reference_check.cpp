#include "tethercalc/report/reference_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "io/json_document.hpp"
#include "report/characters.hpp"
#include "report/result_values.hpp"

namespace tethercalc {
namespace {

/// Number, text or null as people read it.
std::string value_words(const ResultValue& value) {
  if (const auto* word = std::get_if<std::string>(&value)) return *word;
  return value.index() == 0 ? "none" : json_line(result_json(value));
}

std::string drift_words(const RecordedResult& result) {
  if (!result.difference) return "";
  const double recorded = std::get<double>(result.recorded);
  std::string words = fmt::format("{:+.3g}", *result.difference);
  if (recorded != 0) words += fmt::format(" ({:+.3g} %)", 100 * *result.difference / recorded);
  return words + fmt::format(", allowed ±{:.3g}", result.tolerance);
}

/// What is wrong with a design that did not pass: its problems or, where there are none, what
/// drifted.
std::vector<std::string> complaints(const ReferenceCheck& check, bool updated) {
  std::vector<std::string> lines;
  for (const InputProblem& problem : check.problems) {
    lines.push_back(problem.where + ": " + problem.message);
  }
  if (!lines.empty()) return lines;
  if (!check.recorded) return {updated ? "had no record" : "no record; --update makes one"};
  for (const RecordedResult& result : check.results) {
    if (!result.drifted) continue;
    const std::string words = drift_words(result);
    lines.push_back(fmt::format("{}: recorded {}, now {}{}{}", result.name,
                                value_words(result.recorded), value_words(result.computed),
                                words.empty() ? "" : ": ", words));
  }
  return lines;
}

constexpr std::array<std::string_view, 4> status_names{"ok", "drifted", "unrecorded", "error"};

std::string_view status_of(const ReferenceCheck& check) {
  return !check.problems.empty() ? status_names[3]
         : !check.recorded       ? status_names[2]
         : check.passed()        ? status_names[0]
                                 : status_names[1];
}

/// In an attribute, where XML readers would make spaces of line breaks.
std::string attribute_text(std::string_view text) {
  std::string out;
  for (const char c : markup_text(text))
    out += c == '\n' ? std::string("&#10;") : std::string(1, c);
  return out;
}

std::size_t count_status(std::span<const ReferenceCheck> checks, std::string_view status) {
  return static_cast<std::size_t>(std::ranges::count(checks, status, status_of));
}

}  // namespace

std::span<const std::string_view> check_status_names() { return status_names; }

std::string check_text(std::span<const ReferenceCheck> checks, bool updated,
                       const TextStyle& style) {
  std::string out;
  for (const ReferenceCheck& check : checks) {
    const std::string status(status_of(check));
    const std::string shown_status = check.passed() ? style.good(status) : style.bad(status);
    out += fmt::format("{}{}  {}  {}\n", shown_status, std::string(10 - status.size(), ' '),
                       printable(check.spec), style.subdued(printable(check.name)));
    if (check.passed()) continue;
    for (const std::string& complaint : complaints(check, updated)) {
      out += "    " + printable(complaint) + "\n";
    }
  }
  out += fmt::format("{} designs: {} as recorded, {} drifted, {} without a record", checks.size(),
                     count_status(checks, "ok"), count_status(checks, "drifted"),
                     count_status(checks, "unrecorded"));
  return out + (updated ? "; records brought up to date\n" : "\n");
}

ordered_json check_json(std::span<const ReferenceCheck> checks) {
  const auto entry_json = [](const RecordedResult& result) {
    return ordered_json{{"result", result.name},
                        {"recorded", result_json(result.recorded)},
                        {"computed", result_json(result.computed)},
                        {"difference", number_or_null(result.difference)},
                        {"tolerance", result.tolerance},
                        {"drifted", result.drifted}};
  };
  const ordered_json designs = json_list(checks, [&](const ReferenceCheck& check) {
    return ordered_json{{"spec", check.spec},
                        {"name", check.name},
                        {"status", status_of(check)},
                        {"results", json_list(check.results, entry_json)}};
  });
  return {{"designs", designs},
          {"ok", count_status(checks, "ok")},
          {"drifted", count_status(checks, "drifted")},
          {"unrecorded", count_status(checks, "unrecorded")}};
}

std::string check_csv(std::span<const ReferenceCheck> checks) {
  std::string out = "spec,status,result,recorded,computed,difference,tolerance,drifted\n";
  const auto cell = [](const ResultValue& value) {
    return value.index() == 0 ? ordered_json(nullptr) : ordered_json(value_words(value));
  };
  for (const ReferenceCheck& check : checks) {
    for (const RecordedResult& result : check.results) {
      out += csv_line({check.spec, status_of(check), result.name, cell(result.recorded),
                       cell(result.computed), number_or_null(result.difference), result.tolerance,
                       result.drifted});
    }
  }
  return out;
}

std::string check_junit(std::span<const ReferenceCheck> checks, bool updated) {
  const std::size_t errors = count_status(checks, "error");
  const std::size_t failures = checks.size() - errors - count_status(checks, "ok");
  const std::string counts =
      fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\"", checks.size(), failures, errors);
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  out +=
      fmt::format("<testsuites {}>\n  <testsuite name=\"tethercalc check\" {}>\n", counts, counts);
  for (const ReferenceCheck& check : checks) {
    const std::size_t name = check.spec.rfind('/') + 1;
    const std::string opening =
        fmt::format("    <testcase classname=\"{}\" name=\"{}\"",
                    attribute_text(std::string_view(check.spec).substr(0, name > 0 ? name - 1 : 0)),
                    attribute_text(std::string_view(check.spec).substr(name)));
    if (check.passed()) {
      out += opening + "/>\n";
      continue;
    }
    out +=
        fmt::format("{}>\n      <{} type=\"{}\" message=\"{}\"/>\n    </testcase>\n", opening,
                    check.problems.empty() ? "failure" : "error", status_of(check),
                    attribute_text(fmt::format("{}", fmt::join(complaints(check, updated), "\n"))));
  }
  return out + "  </testsuite>\n</testsuites>\n";
}

}  // namespace tethercalc
