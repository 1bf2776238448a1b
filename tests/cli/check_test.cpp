#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "support/run_program.hpp"

using namespace tethercalc::test;
using Catch::Contains;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

const std::string reference = project_file("examples/reference");

/// A copy of one reference design with its record.
void copy_design(const fs::path& folder, const std::string& name = "power-line-hover") {
  for (const char* suffix : {".json", ".expected.json"}) {
    fs::copy_file(fs::path(reference) / (name + suffix), folder / (name + suffix));
  }
}

ordered_json read_json(const fs::path& path) { return ordered_json::parse(file_text(path)); }

}  // namespace

TEST_CASE("the reference designs are as recorded, at every limit") {
  const Ran run = run_tethercalc({"check", reference, "--format", "json"});
  CHECK(run.exit_code == 0);
  const ordered_json answer = ordered_json::parse(run.out);
  CHECK(answer["ok"] == answer["designs"].size());
  CHECK(answer["ok"] >= 12);
  std::set<std::string> limits;
  for (const ordered_json& design : answer["designs"]) {
    const ordered_json spec = read_json(design["spec"].get<std::string>());
    CHECK(spec["description"].get<std::string>().size() > 20);
    std::string limit;
    for (const ordered_json& result : design["results"]) {
      const std::string name = result["result"];
      if (name == "status" || name.starts_with("limit")) {
        limit += result["recorded"].get<std::string>() + " ";
      }
    }
    limits.insert(limit);
  }
  for (const char* limit : {"minimum_power", "max_pitch", "available_power", "takeoff_mass"}) {
    for (const char* condition : {"hover", "forward"}) {
      CHECK(limits.count(std::string("optimal ") + limit + " " + condition + " ") == 1);
    }
  }
  for (const char* limit : {"motor_thrust", "max_pitch", "available_power"}) {
    for (const char* condition : {"hover", "forward"}) {
      CHECK(limits.count(std::string("infeasible ") + limit + " " + condition + " ") == 1);
    }
  }
}

TEST_CASE("a drifted design is told with its drift and its tolerance, and can be recorded anew") {
  const TemporaryFolder folder;
  copy_design(folder.path());
  const fs::path record = folder.path() / "power-line-hover.expected.json";
  ordered_json content = read_json(record);
  // The published digits (Beffert and Zell 2025, section V-B), with their last digit as tolerance.
  content["cross_section_mm2"] = {{"value", 1.0886}, {"absolute_tolerance", 1e-4}};
  content["hover.tether_mass_g"] = {{"value", 540.0}, {"relative_tolerance", 0.01}};
  write_file(record, content.dump());

  const std::string junit = (folder.path() / "report.xml").string();
  const Ran drifted = run_tethercalc({"check", folder.path().string(), "--junit", junit});
  CHECK(drifted.exit_code == 1);
  CHECK_THAT(drifted.out, Contains("hover.tether_mass_g: recorded 540.0, now 546.9") &&
                              Contains("allowed ±5.4") && Contains("1 drifted") &&
                              !Contains("cross_section_mm2"));
  const std::string xml = file_text(junit);
  CHECK_THAT(xml, Contains("tests=\"1\" failures=\"1\" errors=\"0\"") &&
                      Contains("<failure type=\"drifted\" message=\"hover.tether_mass_g"));
  const Ran valid = run_shell(
      "python3 -c 'import sys, xml.dom.minidom as m; m.parse(sys.argv[1])' " + shell_quoted(junit));
  CHECK(valid.exit_code == 0);

  const Ran updated = run_tethercalc({"check", folder.path().string(), "--update"});
  CHECK(updated.exit_code == 0);
  CHECK_THAT(updated.out, Contains("recorded 540.0, now 546.9"));
  const ordered_json renewed = read_json(record);
  CHECK(renewed["hover.tether_mass_g"]["value"].get<double>() == Approx(546.9).margin(0.05));
  CHECK(renewed["hover.tether_mass_g"]["relative_tolerance"] == 0.01);
  CHECK(renewed["cross_section_mm2"]["value"] == 1.0886);  // within its tolerance: kept
  CHECK(run_tethercalc({"check", folder.path().string()}).exit_code == 0);
}

TEST_CASE("a change of the design shows as drift") {
  const TemporaryFolder folder;
  copy_design(folder.path());
  const fs::path spec = folder.path() / "power-line-hover.json";
  ordered_json content = read_json(spec);
  content["supply"]["voltage_V"] = 40;  // no longer feasible
  write_file(spec, content.dump());
  const Ran run = run_tethercalc({"check", spec.string()});
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.out, Contains("status: recorded optimal, now infeasible") && Contains("now none"));
}

TEST_CASE("a design without a record fails until it has one") {
  const TemporaryFolder folder;
  copy_design(folder.path());
  fs::remove(folder.path() / "power-line-hover.expected.json");
  const std::string spec = (folder.path() / "power-line-hover.json").string();
  const std::string junit = (folder.path() / "report.xml").string();
  CHECK(run_tethercalc({"check", spec, "--junit", junit}).exit_code == 1);
  CHECK_THAT(file_text(junit), Contains("message=\"no record; --update makes one\""));
  CHECK(run_tethercalc({"check", spec, "--update", "--junit", junit}).exit_code == 0);
  CHECK_THAT(file_text(junit), Contains("message=\"had no record\""));
  CHECK(run_tethercalc({"check", spec}).exit_code == 0);
}

TEST_CASE("files that cannot be checked are told, and the report still counts them") {
  const TemporaryFolder folder;
  copy_design(folder.path());
  copy_design(folder.path(), "least-power-hover");
  write_file(folder.path() / "least-power-hover.expected.json",
             R"({"cros_section_mm2": {"value": 1, "relative_tolerance": 0.1},
                 "hover.headroom": {"value": 2}, "status": "optimal"})");
  const std::string junit = (folder.path() / "report.xml").string();
  const Ran run = run_tethercalc({"check", folder.path().string(), "--junit", junit});
  CHECK(run.exit_code == 2);
  CHECK(run.out.empty());
  CHECK_THAT(run.err, Contains("did you mean \"cross_section_mm2\"?") &&
                          Contains("needs \"relative_tolerance\"") &&
                          Contains("expected an object"));
  CHECK_THAT(file_text(junit), Contains("tests=\"2\" failures=\"0\" errors=\"1\""));

  fs::remove(folder.path() / "least-power-hover.json");
  CHECK_THAT(run_tethercalc({"check", folder.path().string()}).err, Contains("there is no spec"));
  CHECK(run_tethercalc({"check", (folder.path() / "nothing.json").string()}).exit_code == 2);
}
