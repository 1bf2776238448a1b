// The pages that explain codes: one for each code that can be printed, none beside, none empty.
#include <catch2/catch.hpp>

#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "support/printed_codes.hpp"
#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/model/demands.hpp"
#include "tethercalc/report/diagnosis_report.hpp"
#include "tethercalc/report/explanation.hpp"
#include "tethercalc/study/results.hpp"

using namespace tethercalc;

namespace {

std::string contents_of(const std::filesystem::path& path) {
  std::ostringstream out;
  out << std::ifstream(path).rdbuf();
  return out.str();
}

std::set<std::string> explained_codes() {
  std::set<std::string> codes;
  for (const Explanation& page : explanations()) codes.insert(page.code);
  return codes;
}

/// The names after an enumeration's "enum class NAME {" in a header, as its author wrote them.
std::vector<std::string> enumerators_of(const std::string& header, const std::string& name) {
  const std::string text =
      contents_of(std::filesystem::path(TETHERCALC_SOURCE_DIR) / "include/tethercalc" / header);
  const std::size_t begin = text.find("enum class " + name + " {");
  REQUIRE(begin != std::string::npos);
  const std::string body = text.substr(begin, text.find("};", begin) - begin);
  std::vector<std::string> names;
  const std::regex enumerator("\n  ([a-z_]+),");
  for (auto it = std::sregex_iterator(body.begin(), body.end(), enumerator);
       it != std::sregex_iterator(); ++it) {
    names.push_back((*it)[1]);
  }
  return names;
}

}  // namespace

TEST_CASE("each enumerator that answers name has a page under its own name") {
  const std::set<std::string> codes = explained_codes();
  for (const auto& [header, name] :
       std::map<std::string, std::string>{{"model/warning.hpp", "WarningKind"},
                                          {"solve/optimize.hpp", "Limit"},
                                          {"model/demands.hpp", "Demand"}}) {
    const std::vector<std::string> names = enumerators_of(header, name);
    REQUIRE(names.size() >= 9);
    for (const std::string& code : names) {
      INFO(name << "::" << code);
      CHECK(codes.count(code) == 1);
    }
  }
}

/// Whether `name` stands there and does not go on.
bool has_word(const std::string& text, const std::string& name) {
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
    const char next = text[at + name.size()];
    if (next != '_' && !std::isalnum(static_cast<unsigned char>(next))) return true;
  }
  return false;
}

TEST_CASE("each warning and note is told somewhere in the sources") {
  std::string sources;
  const auto root = std::filesystem::path(TETHERCALC_SOURCE_DIR) / "src";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    if (entry.path().extension() == ".cpp") sources += contents_of(entry.path());
  }
  const std::vector<std::string> kinds = enumerators_of("model/warning.hpp", "WarningKind");
  CHECK(kinds.size() == codes_of(CodeGroup::warnings).size());
  for (const std::string& kind : kinds) {
    INFO(kind);
    CHECK(has_word(sources, "WarningKind::" + kind));
  }
}

TEST_CASE("each effect of both catalogues has a page that says what the catalogue says") {
  for (const Effect& effect : effect_catalogue()) {
    INFO(effect.id);
    const Explanation* page = find_explanation(effect.id);
    REQUIRE(page != nullptr);
    CHECK(page->title == effect.title);
    REQUIRE(page->part("Formula") != nullptr);
    CHECK(page->part("Formula")->texts == std::vector<std::string>{effect.change});
    REQUIRE(page->part("Parameters") != nullptr);
    CHECK(page->part("Parameters")->texts.size() == effect.parameters.size());
  }
}

TEST_CASE("no two pages have one code and no part of a page is empty") {
  CHECK(explained_codes().size() == explanations().size());
  for (const Explanation& page : explanations()) {
    INFO(page.code);
    CHECK(page.title.size() > 8);
    CHECK(page.title.back() != '.');
    std::size_t letters = 0;
    for (const char* heading : {"What it means", "Why", "What to do", "Source"}) {
      INFO(heading);
      REQUIRE(page.part(heading) != nullptr);
    }
    // Of a warning or a record that says what was done, or is not known, there may be none.
    CHECK((page.part("Formula") != nullptr || page.group == CodeGroup::warnings ||
           page.group == CodeGroup::records));
    for (const ExplanationPart& part : page.parts) {
      INFO(part.heading);
      CHECK(!part.texts.empty());
      for (const std::string& text : part.texts) {
        CHECK(!text.empty());
        letters += text.size();
      }
    }
    CHECK(letters > 250);
  }
}

TEST_CASE("fields of a spec that a page names exist") {
  const std::regex field("`((drone|tether|supply|flight|requirements)\\.[A-Za-z0-9_.]+)`");
  std::size_t named = 0;
  for (const Explanation& page : explanations()) {
    for (const ExplanationPart& part : page.parts) {
      for (const std::string& text : part.texts) {
        for (auto it = std::sregex_iterator(text.begin(), text.end(), field);
             it != std::sregex_iterator(); ++it) {
          const std::string path = (*it)[1];
          INFO(page.code << ": " << path);
          ++named;
          // An object of fields counts, such as tether.heating.
          const auto fields = spec_fields();
          CHECK(std::any_of(fields.begin(), fields.end(), [&](const SpecField& f) {
            const std::string dotted = dot_path(f.pointer);
            return dotted == path || dotted.starts_with(path + ".");
          }));
        }
      }
    }
  }
  CHECK(named > 40);
}

TEST_CASE("each verdict with a page is a key of a diagnosis, and each list of effects has a page") {
  Diagnosis diagnosis;
  diagnosis.findings.push_back({});
  const std::string printed = diagnosis_json(diagnosis, nullptr).dump();
  for (const std::string_view name : verdict_names()) {
    INFO(name);
    CHECK(printed.find("\"" + std::string(name) + "\"") != std::string::npos);
  }
  const auto json = diagnosis_json({}, nullptr);
  for (const auto& [key, value] : json.items()) {
    if (value.is_array() && value.empty() && key != "notes" && key != "note_codes" &&
        key != "further") {
      INFO(key);
      CHECK(find_explanation(key) != nullptr);
    }
  }
}

TEST_CASE("codes in recorded results and in the outputs that documents show have pages") {
  const std::regex code(
      "\"(limited_by|outcome|effect|status)\":\\s*(\\{\\s*\"value\":\\s*)?\"([a-z_]+)\"");
  const std::filesystem::path root = TETHERCALC_SOURCE_DIR;
  std::size_t seen = 0;
  test::Codes in_rows;
  for (const char* folder : {".", "docs", "examples/reference"}) {
    for (const auto& entry : std::filesystem::directory_iterator(root / folder)) {
      if (!entry.is_regular_file()) continue;
      const std::string text = contents_of(entry.path());
      // Rows of CSV, each below the last line that names columns.
      for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
        std::istringstream lines(text.substr(at));
        test::collect_csv_codes(lines, in_rows);
        if (text.find('\n', at) == text.npos) break;
      }
      for (auto it = std::sregex_iterator(text.begin(), text.end(), code);
           it != std::sregex_iterator(); ++it) {
        INFO(entry.path().string() << ": " << (*it)[3]);
        ++seen;
        CHECK(find_explanation((*it)[3].str()) != nullptr);
      }
    }
  }
  CHECK(seen > 20);
  CHECK(in_rows.count("available_power") == 1);  // of a sweep in README.md
  for (const std::string& printed : in_rows) {
    INFO(printed);
    CHECK(find_explanation(printed) != nullptr);
  }
}

TEST_CASE("a misspelt code is refused with the closest one") {
  CHECK(find_explanation("tether sag") == find_explanation("tether_sag"));  // as texts write it
  CHECK_THROWS_WITH(explanation_of("propwosh"), Catch::Contains("did you mean \"propwash\""));
  CHECK_THROWS_AS(explanation_of(""), InputError);
}

TEST_CASE("the committed pages are the ones that the texts and tables give") {
  const auto path = std::filesystem::path(TETHERCALC_SOURCE_DIR) / "docs/explain.md";
  if (std::getenv("TETHERCALC_UPDATE") != nullptr) std::ofstream(path) << explanations_markdown();
  INFO("docs/explain.md is out of date; run this test with TETHERCALC_UPDATE=1 and commit it");
  CHECK(contents_of(path) == explanations_markdown());
}

TEST_CASE("the document of all pages links to headings that are there") {
  const std::string document = explanations_markdown();
  const std::regex link("\\]\\(#([a-z_]+)\\)");
  std::size_t links = 0;
  for (auto it = std::sregex_iterator(document.begin(), document.end(), link);
       it != std::sregex_iterator(); ++it) {
    ++links;
    CHECK(document.find("\n### " + (*it)[1].str() + "\n") != std::string::npos);
  }
  CHECK(links == explanations().size());
}
