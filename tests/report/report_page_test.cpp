// The page of `report`, made by the program and taken apart by python3's parsers.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "support/random.hpp"
#include "support/reference_data.hpp"
#include "support/run_program.hpp"

using namespace tethercalc::test;
using Catch::Contains;
using nlohmann::json;

namespace {

const std::string published = project_file("examples/holybro-x500.json");
const std::string flight = project_file("examples/simulated-flight.csv");

/// A spec and its flight; under a sanitizer, where another test has the page of a flight, the spec.
std::vector<std::string> with_a_flight() {
  if (leave_rates_out()) return {published};
  return {published, "--flight", flight, "--mass-g", "1550"};
}

json digest(const std::filesystem::path& page) {
  const Ran run = run_shell("python3 " + shell_quoted(project_file("tests/report/page_digest.py")) +
                            " " + shell_quoted(page.string()));
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  return json::parse(run.out);
}

struct Page {
  int exit_code = -1;
  std::string text;
  json content;
};

/// The page that `report` writes for these arguments.
Page made(std::vector<std::string> arguments) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "page.html";
  arguments.insert(arguments.begin(), "report");
  arguments.insert(arguments.end(), {"--output", file.string()});
  const Ran run = run_tethercalc(arguments);
  INFO(run.err);
  REQUIRE(std::filesystem::exists(file));
  CHECK(run.out.empty());
  return {run.exit_code, file_text(file), digest(file)};
}

json answer_of(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--format", "json"});
  return json::parse(run_tethercalc(arguments).out);
}

std::vector<std::string> texts(const Page& page, const std::string& element) {
  std::vector<std::string> out;
  for (const json& text : page.content["texts"]) {
    if (text[0] == element) out.push_back(text[1]);
  }
  return out;
}

std::multiset<std::string> element_names(const Page& page) {
  std::multiset<std::string> names;
  for (const json& element : page.content["elements"]) names.insert(element[0]);
  return names;
}

/// Rows of the table whose caption begins so, the header first.
json table(const Page& page, const std::string& caption) {
  for (const json& found : page.content["tables"]) {
    if (found["caption"].get<std::string>().starts_with(caption)) return found["rows"];
  }
  FAIL("no table " + caption);
  return {};
}

/// Every run of white space as one space.
std::string flat(const std::string& text) {
  std::istringstream words(text);
  std::string out;
  for (std::string word; words >> word;) out += word + " ";
  return out;
}

/// Whether a cell is `value` as far as its digits go.
bool cell_shows(const std::string& cell, const json& value) {
  if (value.is_null()) return cell == "–";
  std::size_t read = 0;
  const double shown = std::stod(cell, &read);
  const std::size_t point = cell.find('.');
  const auto decimals = point == std::string::npos ? 0 : double(cell.size() - point - 1);
  return read == cell.size() &&
         std::abs(shown - value.get<double>()) <= 0.5000001 * std::pow(10.0, -decimals);
}

/// The key of an operating point that a column of a design's tables shows.
const std::map<std::string, std::string> point_keys{{"mm²", "cross_section_mm2"},
                                                    {"tether g", "tether_mass_g"},
                                                    {"supply W", "total_power_W"},
                                                    {"drone W", "drone_power_W"},
                                                    {"lost W", "tether_loss_W"},
                                                    {"current A", "current_A"},
                                                    {"at drone V", "received_voltage_V"},
                                                    {"headroom", "headroom"},
                                                    {"tilt deg", "pitch_deg"},
                                                    {"available g", "available_thrust_g"},
                                                    {"needed g", "necessary_thrust_g"}};

/// Checks each number of a row against its operating points; `judged` is the condition of columns
/// that do not say theirs. Returns how many there were.
int check_row(const json& header, const json& row, const json& points, const std::string& judged) {
  int numbers = 0;
  for (std::size_t c = 0; c < header.size(); ++c) {
    const std::string title = header[c];
    const std::string cell = row[c];
    json expected;
    if (title == "hover W" || title == "forward W") {
      expected = points[title.substr(0, title.find(' '))]["total_power_W"];
    } else if (title == "lost %") {
      const json& p = points[judged];
      if (!p["tether_loss_W"].is_null()) {
        expected = 100 * p["tether_loss_W"].get<double>() / p["total_power_W"].get<double>();
      }
    } else if (point_keys.contains(title)) {
      expected = points[judged][point_keys.at(title)];
    } else {
      continue;
    }
    INFO(title << " " << cell << " against " << expected);
    CHECK(cell_shows(cell, expected));
    ++numbers;
  }
  return numbers;
}

void check_design_tables(const std::vector<std::string>& arguments) {
  std::vector<std::string> optimize = arguments;
  optimize.insert(optimize.begin(), "optimize");
  const json answer = answer_of(optimize);
  const Page page = made(arguments);
  const std::string judged = answer["headroom"]["condition"];
  int numbers = 0;

  if (answer["status"] == "optimal") {
    const json conditions = table(page, "The optimum in flight");
    REQUIRE(conditions.size() == 3);
    for (const json& row : {conditions[1], conditions[2]}) {
      numbers += check_row(conditions[0], row, answer["optimum"], row[0]);
    }
  }
  const json power = table(page, "Power against cross-section");
  REQUIRE(power.size() == answer["table"].size() + 1);
  for (std::size_t i = 1; i < power.size(); ++i) {
    numbers += check_row(power[0], power[i], answer["table"][i - 1], judged);
  }
  const json sizes = table(page, "Sizes that can be bought");
  REQUIRE(sizes.size() == answer["standard_sizes"].size() + 1);
  for (std::size_t i = 1; i < sizes.size(); ++i) {
    const json& size = answer["standard_sizes"][i - 1];
    CHECK(sizes[i][0] == size["name"]);
    numbers += check_row(sizes[0], sizes[i], size, judged);
    if (!size["feasible"]) CHECK(sizes[i].back() == size["shortcoming"]);
  }
  CHECK(numbers > 100);
}

}  // namespace

TEST_CASE("the page has one title, headings in order, landmarks, and names for everything") {
  const Page page = made(with_a_flight());
  CHECK(page.exit_code == 0);
  CHECK(page.content["odd"].empty());
  std::map<std::string, int> count;
  std::set<std::string> ids;
  std::vector<std::string> named_by;
  int level = 0;
  for (const json& element : page.content["elements"]) {
    const std::string name = element[0];
    const json& attributes = element[1];
    INFO(element);
    const bool of_a_figure = name == "title" && attributes.contains("id");
    if (!of_a_figure) ++count[name];
    if (attributes.contains("id")) CHECK(ids.insert(attributes["id"]).second);
    if (attributes.contains("aria-labelledby")) {
      std::istringstream words(attributes["aria-labelledby"].get<std::string>());
      for (std::string word; words >> word;) named_by.push_back(word);
    }
    if (name.size() == 2 && name[0] == 'h' && std::isdigit(name[1]) != 0) {
      CHECK(name[1] - '0' <= level + 1);
      level = name[1] - '0';
    }
    if (name == "html") CHECK(attributes["lang"] == "en");
    if (name == "th") CHECK(attributes.contains("scope"));
    if (name == "svg") {
      CHECK(attributes["role"] == "img");
      CHECK(attributes.contains("aria-labelledby"));
    }
    if (name == "section" || name == "table") CHECK(attributes.contains("aria-labelledby"));
  }
  for (const char* once : {"html", "head", "title", "body", "header", "nav", "main", "h1"}) {
    INFO(once);
    CHECK(count[once] == 1);
  }
  // The design has two figures, a flight two more.
  CHECK(count["svg"] == (leave_rates_out() ? 2 : 4));
  for (const std::string& id : named_by) {
    INFO(id);
    CHECK(ids.contains(id));
  }
  CHECK_THAT(page.text, Contains("name=\"viewport\""));
  CHECK_THAT(page.text, Contains("prefers-color-scheme: dark"));
  CHECK_THAT(page.text, Contains("@media print"));
}

TEST_CASE("the page runs nothing and fetches nothing, and its policy says so") {
  const Page page = made(with_a_flight());
  bool policy = false;
  for (const json& element : page.content["elements"]) {
    const std::string name = element[0];
    INFO(element);
    for (const char* forbidden : {"script", "link", "iframe", "object", "embed", "img", "base",
                                  "form", "image", "foreignobject", "animate", "set"}) {
      CHECK(name != forbidden);
    }
    for (const auto& [key, value] : element[1].items()) {
      CHECK_FALSE(key.starts_with("on"));
      if (key == "href" || key == "src" || key == "xlink:href") {
        CHECK(value.get<std::string>().starts_with("#"));
      }
      if (key == "http-equiv") {
        policy = value == "Content-Security-Policy";
        CHECK(element[1]["content"] ==
              "default-src 'none'; style-src 'unsafe-inline'; img-src data:");
      }
    }
  }
  CHECK(policy);
  CHECK_THAT(page.text, !Contains("@import"));
  CHECK(std::regex_search(page.text, std::regex("url\\((?!'?#)")) == false);
}

TEST_CASE("every number of the design's tables is that of optimize") {
  check_design_tables({published});
  check_design_tables({published, "--set", "requirements.headroom_at=forward"});
  check_design_tables({published, "--set", "supply.voltage_V=40"});
  check_design_tables({project_file("examples/reference/every-effect.json")});
}

TEST_CASE("every number of the ranking of motors is that of compare") {
  const json answer = answer_of({"compare", published, "--motors", "alike"});
  const json rows = table(made({published}), "Motors by power");
  REQUIRE(rows.size() > 5);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const json& motor = answer["motors"][i - 1];
    CHECK(rows[i][0] == motor["motor"]);
    CHECK(check_row(rows[0], rows[i], motor["optimum"], "hover") == 5);
  }
}

TEST_CASE(
    "sentences, findings and what could not be tested stand there as the commands tell them") {
  const std::vector<std::string> log{"--mass-g", "1550", "--air-density", "1.225"};
  std::vector<std::string> arguments{published, "--flight", flight};
  arguments.insert(arguments.end(), log.begin(), log.end());
  const Page page = made(arguments);

  std::vector<std::string> drag{"drag", flight};
  drag.insert(drag.end(), log.begin(), log.end());
  std::vector<std::string> diagnose = arguments;
  diagnose.insert(diagnose.begin(), "diagnose");
  std::string explained;  // what limits it and what was found
  for (const char* code : {"available_power", "linear_drag"}) {
    explained += flat(run_tethercalc({"explain", code}).out);
  }
  std::erase(explained, '`');
  const std::string told = flat(run_tethercalc({"optimize", published}).out) +
                           flat(run_tethercalc(drag).out) + flat(run_tethercalc(diagnose).out) +
                           explained;
  const std::set<std::string> of_the_page_alone{
      "Tether of a drone",
      "By the spec as it stands, of which the figures and tables of designs below are:",
      "tethercalc explain CODE says why, with the formula and its source."};
  int sentences = 0;
  for (const std::string& text : texts(page, "p")) {
    if (text.starts_with("Steady flight, in hover")) break;  // how it was computed
    if (of_the_page_alone.contains(text) || text.starts_with("By what the logs show:")) continue;
    INFO(text);
    CHECK_THAT(told, Contains(flat(text)));
    ++sentences;
  }
  CHECK(sentences > 10);
  const json answer = answer_of(diagnose);
  REQUIRE(!answer["findings"].empty());
  const std::vector<std::string> headings = texts(page, "h3");
  for (const json& finding : answer["findings"]) {
    const auto about = [&](const std::string& heading) {
      return heading.starts_with(finding["title"].get<std::string>());
    };
    CHECK(std::any_of(headings.begin(), headings.end(), about));
  }
  for (const json& effect : answer["not_identifiable"]) {
    std::string words = effect["effect"].get<std::string>();
    std::ranges::replace(words, '_', ' ');
    CHECK_THAT(page.text, Contains(words));
  }
}

TEST_CASE("a flight and a power log are told on one page, each with its own figure") {
  const auto folder = reference_file("data/practice");
  if (!folder) return;
  const Page page =
      made({(*folder / "x500-tethered.spec.json").string(), "--flight",
            (*folder / "flight-11.csv").string(), "--power", (*folder / "power-22.csv").string()});
  std::set<std::string> ids;
  for (const json& element : page.content["elements"]) {
    if (element[1].contains("id")) CHECK(ids.insert(element[1]["id"]).second);
  }
  CHECK(ids.contains("flight-diagnosis"));
  CHECK(ids.contains("power-diagnosis"));
  CHECK(element_names(page).count("svg") == 5);

  const Ran diagnosis = run_tethercalc({"diagnose", (*folder / "x500-tethered.spec.json").string(),
                                        "--flight", (*folder / "flight-11.csv").string(), "--power",
                                        (*folder / "power-22.csv").string(), "--format", "json"});
  const json impact = json::parse(diagnosis.out)["design_impact"];
  char after[40];
  std::snprintf(after, sizeof after, "fly %.3f mm²", impact["cross_section_mm2"][1].get<double>());
  REQUIRE(impact["total_power_W"][0] != impact["total_power_W"][1]);
  const std::size_t headline = page.text.find("By what the logs show: " + std::string(after));
  const std::size_t by_spec = page.text.find("By the spec as it stands");
  CHECK(headline != std::string::npos);
  CHECK(headline < by_spec);
}

TEST_CASE("whatever a name holds, it stands there as text") {
  const std::multiset<std::string> harmless = element_names(made({published}));
  const std::string wide(300, 'W');
  const std::string markup = "<script>alert(1)</script></title></style></svg></pre>]]><!-- ";
  const std::string quotes =
      "\"><img src=x onerror=alert(1)> it's &amp; `date` $(date) \\n %s {} @macro 'end' # set "
      "output";
  const std::string long_one = "Ünïcödé 無人機 🚁" + std::string(300, 'W');
  for (const std::string& name : {markup, quotes, long_one}) {
    INFO(name);
    const Page page = made({published, "--set", "name=" + json(name).dump(), "--set",
                            "drone.motor=" + json{{"name", name},
                                                  {"points",
                                                   {{{"thrust_g", 400}, {"power_W", 40}},
                                                    {{"thrust_g", 1400}, {"power_W", 250}}}}}
                                                 .dump()});
    CHECK(page.exit_code != 2);
    CHECK(texts(page, "h1").front() == name);
    CHECK_FALSE(texts(page, "title").front().empty());
    std::set<std::string> names;
    for (const std::string& element : element_names(page)) names.insert(element);
    for (const std::string& element : names) CHECK(harmless.contains(element));
  }
}

TEST_CASE("a name cannot turn the direction of writing or hide characters on the page") {
  const Page page = made({published, "--set", "name=\"a\\u202eb\\u2028c\\u200fd\""});
  CHECK(texts(page, "h1").front() ==
        "a\xEF\xBF\xBD"
        "b\xEF\xBF\xBD"
        "c\xEF\xBF\xBD"
        "d");
  for (const char* hidden : {"\u202e", "\u2028", "\u200f"})
    CHECK_THAT(page.text, !Contains(hidden));
  CHECK_THAT(texts(page, "pre").front(), Contains("\"a\\u202eb\\u2028c\\u200fd\""));

  const Ran refused = run_tethercalc({"report", published, "--set", "name=\"a\\u0007\""});
  CHECK(refused.exit_code == 2);
  CHECK(refused.out.empty());
}

TEST_CASE("names of files do no harm, and the command on the page can be typed again") {
  const TemporaryFolder folder;
  json spec = json::parse(file_text(published));
  spec.erase("name");
  const std::string name = "<b>\"it's\" &amp; $(touch x)";
  const auto file = folder.path() / (name + ".json");
  write_file(file, spec.dump());
  const Page page = made({file.string()});
  CHECK(texts(page, "h1").front() == name);

  const std::string command = texts(page, "pre").back();
  const std::string program = "tethercalc ";
  REQUIRE(command.starts_with(program));
  const Ran again =
      run_shell("set -- " + command.substr(program.size()) + "; printf '%s\\n' \"$2\" \"$#\"");
  CHECK(again.out == file.string() + "\n4\n");
}

TEST_CASE("the spec on the page, read again, gives the same page") {
  const Page page = made({published, "--set", "supply.voltage_V=60", "--set", "name=sixty"});
  const TemporaryFolder folder;
  const auto file = folder.path() / "again.json";
  write_file(file, texts(page, "pre").front());
  const Page again = made({file.string()});
  CHECK(again.content["tables"] == page.content["tables"]);
  CHECK(texts(again, "h1") == texts(page, "h1"));
  CHECK(json::parse(texts(page, "pre").front())["supply"]["voltage_V"] == 60);
}

TEST_CASE("what the spec does not say stands in the table of defaults") {
  const json rows = table(made({published, "--set", "drone.motor_power_factor=1"}), "Fields that");
  std::map<std::string, std::string> defaults;
  for (std::size_t i = 1; i < rows.size(); ++i) defaults[rows[i][0]] = rows[i][1];
  CHECK(defaults.at("flight.gravity_m_s2") == "9.80665 m/s²");
  CHECK(defaults.at("requirements.max_pitch_deg") == "45 °");
  CHECK_FALSE(defaults.contains("drone.motor_power_factor"));
  CHECK_FALSE(defaults.contains("drone.mass_g"));
  CHECK_FALSE(defaults.contains("tether.cross_section_mm2"));
}

TEST_CASE("an infeasible design gives a page too, with what would help, and exit code 1") {
  const Page page = made({published, "--set", "supply.voltage_V=40"});
  CHECK(page.exit_code == 1);
  const json answer = answer_of({"optimize", published, "--set", "supply.voltage_V=40"});
  CHECK_THAT(page.text, Contains("This design cannot fly as required."));
  const std::vector<std::string> sentences = texts(page, "p");
  CHECK(std::count(sentences.begin(), sentences.end(), answer["reason"].get<std::string>()) == 1);
  REQUIRE(!answer["remedies"].empty());
  const std::vector<std::string> items = texts(page, "li");
  const auto helps = [](const std::string& item) { return item.starts_with("a supply of "); };
  CHECK(std::count_if(items.begin(), items.end(), helps) == 1);
}

TEST_CASE("a solved tether is drawn as it hangs, a straight one is not") {
  const Page page = made({project_file("examples/reference/hanging-slack.json")});
  CHECK_THAT(page.text, Contains("How the cable hangs"));
  // 3 % of 30 m more than the height, in hover and in forward flight.
  const std::size_t table = page.text.find("Pull on the drone, tensions");
  REQUIRE(table != std::string::npos);
  CHECK(page.text.find("30.90", page.text.find("30.90", table) + 1) != std::string::npos);
  CHECK_THAT(made({published}).text, !Contains("How the cable hangs"));
}

TEST_CASE("warnings stand on the page") {
  const std::vector<std::string> arguments{
      published, "--set",
      R"(drone.motor={"points": [{"thrust_g": 400, "power_W": 40}, {"thrust_g": 700, "power_W": 90},
         {"thrust_g": 800, "power_W": 85}, {"thrust_g": 1500, "power_W": 260}]})"};
  std::vector<std::string> optimize = arguments;
  optimize.insert(optimize.begin(), "optimize");
  const json answer = answer_of(optimize);
  REQUIRE(!answer["warnings"].empty());
  const std::vector<std::string> sentences = texts(made(arguments), "p");
  for (const json& warning : answer["warnings"]) {
    const std::string note = "Note: " + warning.get<std::string>();
    CHECK(std::count(sentences.begin(), sentences.end(), note) == 1);
  }
}

TEST_CASE("the same question gives the same page, byte by byte") {
  const Ran once = run_tethercalc({"report", published});
  CHECK(once.out == run_tethercalc({"report", published}).out);
  CHECK(once.out.starts_with("<!DOCTYPE html>\n"));
  const std::string version = run_tethercalc({"--version"}).out;  // and a line end
  CHECK_THAT(once.out, Contains("Computed by " + version.substr(0, version.size() - 1) + "."));
}

TEST_CASE("bad input leaves the page that was there and says everything that is wrong") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "page.html";
  write_file(file, "as it was");
  const auto refused = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "report");
    arguments.insert(arguments.end(), {"--output", file.string()});
    const Ran run = run_tethercalc(arguments);
    CHECK(run.exit_code == 2);
    CHECK(run.out.empty());
    CHECK(file_text(file) == "as it was");
    CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
    return run.err;
  };
  const std::string both =
      refused({published, "--set", "supply.voltage_V=-1", "--set", "drone.motor_count=0.5"});
  CHECK_THAT(both, Contains("voltage_V") && Contains("motor_count"));
  CHECK_THAT(refused({published, "--flight", "nowhere.csv"}), Contains("nowhere.csv"));
  CHECK_THAT(refused({published, "--power", published}), Contains("holybro-x500.json"));
  CHECK_THAT(refused({published, "--flight", flight, "--mass-g", "0"}), Contains("--mass-g"));
  CHECK_THAT(refused({published, "--flght", flight}), Contains("did you mean \"--flight\""));

  const Ran nowhere = run_tethercalc({"report", published, "--output", "/nowhere/page.html"});
  CHECK(nowhere.exit_code == 2);
}

TEST_CASE("a report needs no other program") {
  const TemporaryFolder empty;
  const Ran run =
      run_shell("PATH=" + shell_quoted(empty.path().string()) + " " +
                shell_quoted(TETHERCALC_COMMAND) + " report " + shell_quoted(published));
  INFO(run.err);
  CHECK(run.exit_code == 0);
  CHECK(run.err.empty());
  CHECK_THAT(run.out, Contains("<svg "));
}
