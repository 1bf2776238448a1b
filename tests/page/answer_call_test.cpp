#include "page/answer_call.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "support/reference_data.hpp"
#include "support/run_program.hpp"

namespace {

using namespace tethercalc;
using nlohmann::ordered_json;

const std::string project = TETHERCALC_SOURCE_DIR;

std::string example(const std::string& name) {
  return test::file_text(project + "/examples/" + name);
}

/// Files of a request with what holds their bytes.
struct Files {
  std::map<std::string, std::string> texts;

  [[nodiscard]] page::NamedFiles named() const {
    page::NamedFiles files;
    for (const auto& [name, text] : texts) files[name] = std::as_bytes(std::span(text));
    return files;
  }
};

ordered_json replied(const std::string& request, const Files& files = {}) {
  return ordered_json::parse(page::answer_call(request, files.named()));
}

ordered_json replied(const ordered_json& request, const Files& files = {}) {
  return replied(request.dump(), files);
}

ordered_json answered(const ordered_json& request, const Files& files = {}) {
  const ordered_json reply = replied(request, files);
  INFO(reply.dump().substr(0, 2000));
  REQUIRE(reply.contains("answer"));
  return reply.at("answer");
}

std::string only_message(const ordered_json& reply) {
  INFO(reply.dump().substr(0, 2000));
  REQUIRE(reply.contains("problems"));
  REQUIRE(reply.at("problems").size() == 1);
  return reply.at("problems").at(0).at("message");
}

std::string program(const std::string& arguments) {
  const test::Ran ran = test::run_shell("cd " + test::shell_quoted(project + "/examples") + " && " +
                                        test::shell_quoted(TETHERCALC_COMMAND) + " " + arguments);
  INFO(ran.err);
  REQUIRE(ran.exit_code <= 1);
  return ran.out;
}

const std::vector<std::string> example_names{"holybro-x500.json", "headroom-range.json",
                                             "hexacopter-400v.json",
                                             "reference/infeasible-power-hover.json"};

}  // namespace

TEST_CASE("the page answers a design as the program does, in JSON and in words") {
  for (const std::string& name : example_names) {
    INFO(name);
    const std::string spec = example(name);
    const ordered_json optimum = answered({{"ask", "optimize"}, {"spec", spec}});
    CHECK(optimum.at("result") == ordered_json::parse(program("optimize --format json " + name)));
    CHECK(optimum.at("text") == program("optimize " + name));
    const ordered_json ranking = answered({{"ask", "compare"}, {"spec", spec}});
    CHECK(ranking.at("result") ==
          ordered_json::parse(program("compare --motors all --format json " + name)));
    CHECK(ranking.at("text") == program("compare --motors all " + name));
  }
}

TEST_CASE("envelope, shape, CSV and figures of the page are those of the program") {
  const std::string spec = example("holybro-x500.json");
  const ordered_json area{"1.0886"};
  CHECK(answered({{"ask", "envelope"}, {"spec", spec}, {"area_mm2", area}}).at("text") ==
        program("envelope holybro-x500.json --area-mm2 1.0886"));
  CHECK(answered({{"ask", "shape"}, {"spec", spec}, {"area_mm2", area}}).at("result") ==
        ordered_json::parse(program("shape holybro-x500.json --area-mm2 1.0886 --format json")));
  CHECK(answered({{"ask", "csv"}, {"spec", spec}}).at("csv") ==
        program("optimize --format csv holybro-x500.json"));
  const test::TemporaryFolder folder;
  const std::string picture = folder.path() / "optimum.svg";
  (void)program("plot optimum holybro-x500.json --width-mm 170 --output " + picture);
  CHECK(answered({{"ask", "svg"}, {"spec", spec}, {"width_mm", 170}}).at("svg") ==
        test::file_text(picture));
}

TEST_CASE("a conductor of the spec is called by its id, else its name, else the spec's own") {
  const auto headline = [](const ordered_json& conductor) {
    ordered_json spec = ordered_json::parse(example("holybro-x500.json"));
    spec["tether"]["conductor"] = conductor;
    return answered({{"ask", "optimize"}, {"spec", spec.dump()}}).at("headline").get<std::string>();
  };
  ordered_json conductor{{"resistivity_20C_ohm_mm2_per_m", 0.0278},
                         {"temperature_coefficient_per_K", 0.004},
                         {"density_g_cm3", 2.7}};
  CHECK_THAT(headline(conductor), Catch::EndsWith(" mm² of the spec's own conductor."));
  conductor["name"] = "Litz wire";
  CHECK_THAT(headline(conductor), Catch::EndsWith(" mm² of Litz wire."));
  conductor["id"] = "litz";
  CHECK_THAT(headline(conductor), Catch::EndsWith(" mm² of litz."));
}

TEST_CASE("a brief answer is the whole one without its text") {
  ordered_json request{{"ask", "optimize_and_figures"}, {"spec", example("holybro-x500.json")}};
  ordered_json whole = answered(request);
  request["brief"] = true;
  REQUIRE(whole.erase("text") == 1);
  CHECK(answered(request).dump() == whole.dump());
}

TEST_CASE("the curves of a figure carry the numbers of the answer") {
  const ordered_json all = answered({{"ask", "optimize_and_figures"},
                                     {"spec", example("holybro-x500.json")},
                                     {"kinds", {"optimum", "motors", "shape"}}});
  const double area = all.at("result").at("optimum").at("cross_section_mm2");
  const double power = all.at("result").at("optimum").at("forward").at("total_power_W");
  bool marked = false;
  std::size_t curves = 0;
  for (const ordered_json& figure : all.at("figures")) {
    for (const ordered_json& series : figure.at("series")) {
      CHECK(series.at("x").size() == series.at("y").size());
      curves += series.at("role") == "curve" ? 1 : 0;
      if (figure.at("kind") == "optimum" && figure.at("part") == 1 &&
          series.at("style").value("mark", "") == "diamond") {
        marked = series.at("x").at(0) == area && series.at("y").at(0) == power;
      }
    }
  }
  CHECK(marked);
  CHECK(curves > 30);
}

TEST_CASE("what is wrong with a spec is told in the program's words, with line and pointer") {
  const test::TemporaryFolder folder;
  std::string bad = example("holybro-x500.json");
  bad.replace(bad.find("1710"), 4, "1.71");
  bad.replace(bad.find("\"aluminium\""), 11, "\"aluminum\"");
  test::write_file(folder.path() / "spec.json", bad);
  const test::Ran ran =
      test::run_shell("cd " + test::shell_quoted(folder.path()) + " && " +
                      test::shell_quoted(TETHERCALC_COMMAND) + " optimize spec.json");
  std::string told;
  const ordered_json problems = replied({{"ask", "optimize"}, {"spec", bad}}).at("problems");
  for (const ordered_json& problem : problems) {
    told += problem.at("where").get<std::string>() + ": " +
            problem.at("message").get<std::string>() + "\n";
  }
  CHECK(told == ran.err);
  REQUIRE(problems.size() == 2);
  CHECK(problems.at(0).at("pointer") == "/drone/mass_g");
  CHECK(problems.at(0).at("line") == 6);
}

TEST_CASE("whatever a request holds, the reply is JSON that says what is wrong") {
  for (const std::string request :
       {"", "{", "[]", "7", "null", "{\"ask\": 7}", "{}", "\xff\xfe", "{\"ask\": \"optimize\"}",
        "{\"ask\": \"set\"}", "{\"ask\": \"optimize\", \"spec\": \"\"}",
        "{\"ask\": \"optimize\", \"spec\": \"{}\"}", "{\"ask\": \"drag\"}",
        "{\"ask\": \"diagnose\"}"}) {
    INFO(request);
    const ordered_json reply = replied(request);
    REQUIRE(reply.contains("problems"));
    CHECK_FALSE(reply.at("problems").empty());
  }
  CHECK(only_message(replied({{"ask", "optimise"}})).find("did you mean \"optimize\"?") !=
        std::string::npos);
  CHECK(only_message(replied({{"ask", "log"}, {"file", "flight.bin"}}, {{{"fligth.bin", "x"}}})) ==
        "no such file; did you mean \"fligth.bin\"?");
  CHECK(only_message(
            replied(
                {{"ask", "optimize"}, {"spec", example("holybro-x500.json")}, {"kind", "optimum"}}))
            .starts_with("is nothing that this ask takes"));
}

TEST_CASE("a motor that a spec names as a file is taken from the request") {
  const std::string table = "Thrust (g),Power (W)\n300,35\n600,85\n1000,180\n";
  ordered_json spec = ordered_json::parse(example("holybro-x500.json"));
  spec["drone"]["motor"] = "mine.csv";
  const test::TemporaryFolder folder;
  test::write_file(folder.path() / "mine.csv", table);
  test::write_file(folder.path() / "spec.json", spec.dump());
  const ordered_json found =
      answered({{"ask", "optimize"}, {"spec", spec.dump()}}, {{{"mine.csv", table}}});
  CHECK(found.at("result") ==
        ordered_json::parse(
            program("optimize --format json " + test::shell_quoted(folder.path() / "spec.json"))));
  CHECK(only_message(replied({{"ask", "optimize"}, {"spec", spec.dump()}})) ==
        "mine.csv: no such file");
}

TEST_CASE("a field is changed in the text of a spec with the layout kept") {
  const std::string spec = example("holybro-x500.json");
  const auto with = [&spec](const std::string& path, const ordered_json& value) {
    return answered({{"ask", "set"}, {"spec", spec}, {"path", path}, {"value", value}})
        .at("spec")
        .get<std::string>();
  };
  std::string expected = spec;
  expected.replace(expected.find("1710"), 4, "1800");
  CHECK(with("drone.mass_g", 1800) == expected);
  CHECK(with("/drone/mass_g", 1800) == expected);
  CHECK(with("tether.cross_section_mm2", nullptr) == spec);
  // Whatever is changed, the rest reads as before, and taking it away again restores the text.
  for (const auto& [path, value] : std::vector<std::pair<std::string, ordered_json>>{
           {"tether.cross_section_mm2", 1.5},
           {"tether.strength_member.material", "aramid"},
           {"drone.drag.fore_aft_asymmetry", 0.1},
           {"name", "a \"quoted\" name"},
           {"supply.converter.efficiency",
            ordered_json::parse(
                R"([{"output_W":1,"efficiency":0.9},{"output_W":9,"efficiency":0.95}])")}}) {
    INFO(path);
    const ordered_json before = ordered_json::parse(spec);
    std::string pointer = "/" + path;
    std::replace(pointer.begin(), pointer.end(), '.', '/');
    const ordered_json::json_pointer at(pointer);
    ordered_json wanted = before;
    wanted[at] = value;
    const std::string text = with(path, value);
    CHECK(ordered_json::parse(text) == wanted);
    const bool was_there = before.contains(at);
    if (!was_there && path != "tether.strength_member.material") {
      CHECK(answered({{"ask", "set"}, {"spec", text}, {"path", path}, {"value", nullptr}})
                .at("spec") == spec);
    }
  }
  CHECK(
      only_message(replied({{"ask", "set"}, {"spec", spec}, {"path", "drone.mass"}, {"value", 1}}))
          .find("did you mean \"drone.mass_g\"?") != std::string::npos);
}

TEST_CASE("every field that the page shows can be set to its default") {
  const ordered_json known = answered({{"ask", "about"}});
  const std::string spec = example("holybro-x500.json");
  CHECK(known.at("fields").size() > 60);
  for (const ordered_json& field : known.at("fields")) {
    INFO(field.dump());
    CHECK_FALSE(field.at("help").get<std::string>().empty());
    if (field.at("default").is_null()) continue;
    const std::string text = answered({{"ask", "set"},
                                       {"spec", spec},
                                       {"path", field.at("path")},
                                       {"value", field.at("default")}})
                                 .at("spec");
    CHECK(answered({{"ask", "spec"}, {"spec", text}}).contains("spec"));
  }
  for (const ordered_json& given : known.at("examples")) {
    CHECK(answered({{"ask", "optimize"}, {"spec", given.at("spec")}}).contains("headline"));
  }
}

TEST_CASE("the drag that a flight shows is that of the program, and goes into the spec") {
  const Files files{{{"simulated-flight.csv", example("simulated-flight.csv")}}};
  const ordered_json drag = answered({{"ask", "drag"},
                                      {"file", "simulated-flight.csv"},
                                      {"mass_g", 1550},
                                      {"air_density_kg_m3", 1.225}},
                                     files);
  CHECK(drag.at("result") ==
        ordered_json::parse(program("drag simulated-flight.csv --mass-g 1550 --air-density 1.225 "
                                    "--format json 2>/dev/null")));
  CHECK(drag.at("figures").size() >= 4);
  const ordered_json learned = answered({{"ask", "drag"},
                                         {"file", "simulated-flight.csv"},
                                         {"mass_g", 1550},
                                         {"air_density_kg_m3", 1.225},
                                         {"spec", example("holybro-x500.json")}},
                                        files);
  CHECK(ordered_json::parse(learned.at("spec").get<std::string>())
            .at("drone")
            .at("drag")
            .at("front_area_m2") == drag.at("result").at("drone").at("drag").at("front_area_m2"));
}

TEST_CASE("a diagnosis of the page is that of the program") {
  const Files files{{{"simulated-power.csv", example("simulated-power.csv")}}};
  const ordered_json told = answered({{"ask", "diagnose"},
                                      {"spec", example("holybro-x500.json")},
                                      {"power", "simulated-power.csv"},
                                      {"set", {"tether.cross_section_mm2=1.09"}}},
                                     files);
  CHECK(told.at("result") ==
        ordered_json::parse(program("diagnose holybro-x500.json --power simulated-power.csv --set "
                                    "tether.cross_section_mm2=1.09 --format json")));
  CHECK_FALSE(told.at("figures").empty());
}

TEST_CASE("every code is explained in the program's words, others are refused with the closest") {
  for (const char* code : {"available_power", "drag_estimated", "propwash", "log_stuck", "fail"}) {
    const ordered_json page = answered({{"ask", "explain"}, {"code", code}});
    CHECK(page.at("text") == program(std::string("explain ") + code));
    CHECK(page.at("result") ==
          ordered_json::parse(program(std::string("explain ") + code + " --format json")));
  }
  CHECK_THAT(only_message(replied({{"ask", "explain"}, {"code", "propwosh"}})),
             Catch::Contains("did you mean \"propwash\""));
}

TEST_CASE("a log is told as by the program") {
  const Files files{{{"px4-flight.ulg", example("px4-flight.ulg")}}};
  const ordered_json told = answered({{"ask", "log"}, {"file", "px4-flight.ulg"}}, files);
  CHECK(told.at("text") == program("log px4-flight.ulg"));
  CHECK(told.at("result") == ordered_json::parse(program("log px4-flight.ulg --format json")));
}
