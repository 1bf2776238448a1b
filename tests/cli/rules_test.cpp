// `rules` and `report --rules`.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <regex>

#include "cli/published.hpp"
#include "support/run_program.hpp"

using namespace tethercalc::test;
using Catch::Contains;
using nlohmann::json;

namespace {

const std::string octocopter = project_file("examples/tethered-25kg.json");

json rules_of(const std::string& spec, const std::string& book) {
  return json::parse(run_tethercalc({"rules", spec, "--rules", book, "--format", "json"}).out);
}

std::string verdict_of(const json& answer, const std::string& id) {
  for (const json& clause : answer["clauses"]) {
    if (clause["id"] == id) return clause["verdict"];
  }
  return "no such clause";
}

/// The word, whatever its case, not as a part of others ("safety organizations").
bool says_safe(const std::string& text) {
  return std::regex_search(text, std::regex("\\bsafe(ly)?\\b", std::regex::icase));
}

/// Of a page's text what a reader sees.
std::string as_shown(const std::string& html) {
  return std::regex_replace(html, std::regex("&#39;"), "'");
}

}  // namespace

TEST_CASE(
    "the published drone keeps mass and tether length of class C3, and its strength is unknown") {
  const json answer = rules_of(published, "eu-c3");
  CHECK(verdict_of(answer, "mass") == "pass");
  CHECK(verdict_of(answer, "tether-length") == "pass");
  CHECK(verdict_of(answer, "height") == "pass");
  CHECK(verdict_of(answer, "tether-strength") == "unknown");
  CHECK(verdict_of(answer, "dimension") == "unknown");
  CHECK(verdict_of(answer, "discharge") == "unknown");
  CHECK(answer["counts"]["fail"] == 0);
  CHECK(std::abs(answer["cross_section_mm2"].get<double>() - 1.0886) < 1e-4);  // its optimum
}

TEST_CASE("a large system on 100 m fails the tether's length of class C3 and exits with 1") {
  const Ran run = run_tethercalc({"rules", octocopter, "--rules", "eu-c3"});
  CHECK(run.exit_code == 1);
  CHECK(widest_line(run.out) <= 100);
  const json answer = rules_of(octocopter, "eu-c3");
  CHECK(verdict_of(answer, "tether-length") == "fail");
  CHECK(verdict_of(answer, "tether-strength") == "pass");
  // 23.9 kg without the tether that it lifts, more than 25 kg with it.
  CHECK(verdict_of(answer, "mass") == "unknown");
}

TEST_CASE("every clause is told with document, number and edition") {
  for (const char* book : {"eu-c3", "uk", "us", "electrical"}) {
    const Ran run = run_tethercalc({"rules", published, "--rules", book});
    std::string flat = std::regex_replace(run.out, std::regex("\\s+"), " ");
    const json answer = rules_of(published, book);
    CHECK(!answer["clauses"].empty());
    for (const json& clause : answer["clauses"]) {
      for (const char* key : {"document", "clause", "edition", "text"}) {
        CHECK_THAT(flat, Contains(clause[key].get<std::string>()));
      }
      if (clause["checked_against"].is_null()) {
        CHECK_THAT(flat, Contains("Not verified against the official text"));
        CHECK(clause["is_quote"] == false);
      }
    }
  }
}

TEST_CASE("no form of the answer calls anything safe") {
  const TemporaryFolder folder;
  const std::string page = (folder.path() / "page.html").string();
  for (const std::string& spec : {published, octocopter}) {
    for (const char* book : {"eu-c3", "uk", "us", "electrical"}) {
      for (const char* format : {"table", "json", "csv"}) {
        CHECK_FALSE(
            says_safe(run_tethercalc({"rules", spec, "--rules", book, "--format", format}).out));
      }
    }
  }
  run_tethercalc({"report", octocopter, "--rules", "eu-c3", "--output", page});
  const std::string html = file_text(page);
  const std::size_t begin = html.find("id=\"rules\"");
  REQUIRE(begin != std::string::npos);
  CHECK_FALSE(says_safe(html.substr(begin, html.find("</section>", begin) - begin)));
}

TEST_CASE("report --rules has every clause of the command on its page") {
  const TemporaryFolder folder;
  const std::string page = (folder.path() / "page.html").string();
  const Ran run = run_tethercalc({"report", published, "--rules", "us", "--output", page});
  CHECK(run.exit_code == 0);
  const std::string html = as_shown(file_text(page));
  const json rules = rules_of(published, "us");
  for (const json& clause : rules["clauses"]) {
    CHECK_THAT(html, Contains(clause["document"].get<std::string>() + ", " +
                              clause["clause"].get<std::string>()));
  }
  CHECK_THAT(html, Contains("What published rules ask: United States"));
}

TEST_CASE("an unknown book and a missing one are refused before anything is computed") {
  const Ran wrong = run_tethercalc({"report", published, "--rules", "eu-c4"});
  CHECK(wrong.exit_code == 2);
  CHECK(wrong.out.empty());
  CHECK_THAT(wrong.err, Contains("--rules") && Contains("did you mean \"eu-c3\""));
  const Ran none = run_tethercalc({"rules", published});
  CHECK(none.exit_code == 2);
  CHECK_THAT(none.err, Contains("--rules") && Contains("eu-c3"));
}

TEST_CASE("the voltages of the electrical clauses are those of the voltage classes") {
  for (const auto& [volts, touch, extra_low, name] :
       {std::tuple{60, "pass", "pass", "touchable_elv"}, std::tuple{61, "unknown", "pass", "elv"},
        std::tuple{120, "unknown", "pass", "elv"},
        std::tuple{121, "unknown", "unknown", "low_voltage"}}) {
    const std::string set = "supply.voltage_V=" + std::to_string(volts);
    const json answer = json::parse(run_tethercalc({"rules", published, "--rules", "electrical",
                                                    "--set", set, "--format", "json"})
                                        .out);
    CHECK(verdict_of(answer, "touch-voltage") == touch);
    CHECK(verdict_of(answer, "extra-low-voltage") == extra_low);
    const json optimum =
        json::parse(run_tethercalc({"optimize", published, "--set", set, "--format", "json"}).out);
    CHECK(optimum["voltage_class"]["name"] == name);
  }
}
