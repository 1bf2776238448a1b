#include "tethercalc/report/diagnosis_report.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>

using namespace tethercalc;

namespace {

Diagnosis example() {
  Diagnosis d;
  d.kind = LogKind::flight;
  d.quantity = "forward acceleration";
  d.unit = "m/s²";
  d.samples = 5000;
  d.effective_samples = 400;
  d.base.holdout_rmse = 0.25;
  d.extended.holdout_rmse = 0.2;
  d.findings.push_back({.effect = "wind",
                        .title = "Steady wind",
                        .mechanism = "The air moves.",
                        .stage = "airframe",
                        .parameters = {{"wind_m_s", -1.2, "m/s", -1.3, -1.1}},
                        .holdout_rmse_before = 0.25,
                        .holdout_rmse_after = 0.2,
                        .gain_percent = 20,
                        .gain_se_percent = 2,
                        .indistinguishable_from = {"pitch_trim"},
                        .to_separate = "pitch_trim: hover through all headings"});
  d.budget = {{36}, 4, 60};
  d.suspected.push_back({"linear_drag",
                         "Drag in proportion to speed",
                         34.1,
                         2.5,
                         {{"linear_m_s", 51, "m/s", 2, 1000}},
                         "a longer log, until chance cannot explain it",
                         0,
                         {{"wind_m_s", 1.25, "m/s", 1, 1.5}}});
  d.ruled_out.push_back({"wind_drift", "wind_drift_m_s", 0.42, "m/s"});
  d.not_testable.push_back({"vertical_coupling", "vd_m_s"});
  return d;
}

}  // namespace

TEST_CASE("the JSON of a diagnosis has the documented keys") {
  Diagnosis d = example();
  d.design_impact = DesignImpact{{1.09, std::nullopt}, {445.0, std::nullopt}};
  const auto json = diagnosis_json(d, nullptr);
  for (const char* key :
       {"kind", "samples", "effective_samples", "base", "findings", "suspected", "ruled_out",
        "not_testable", "not_identifiable", "unexplained", "extended", "design_impact"}) {
    CHECK(json.contains(key));
  }
  const auto& finding = json["findings"][0];
  CHECK(finding["effect"] == "wind");
  CHECK(finding["parameters"][0]["ci95"] == nlohmann::ordered_json({-1.3, -1.1}));
  CHECK(finding["indistinguishable_from"] == nlohmann::ordered_json({"pitch_trim"}));
  CHECK(json["suspected"][0]["effect"] == "linear_drag");
  CHECK(json["suspected"][0]["gain_se_percent"] == 2.5);
  CHECK(json["suspected"][0]["parameters"][0]["value"] == 51);
  CHECK(json["suspected"][0]["missing"] == "a longer log, until chance cannot explain it");
  CHECK(json["suspected"][0]["findings_with_it"][0]["value"] == 1.25);
  CHECK(json["ruled_out"].dump() ==
        R"([{"effect":"wind_drift","parameter":"wind_drift_m_s","bound":0.42,"unit":"m/s"}])");
  CHECK(json["base"]["unit"] == "m/s²");
  CHECK(json["unexplained"]["detected"] == false);
  CHECK(json["design_impact"]["cross_section_mm2"].dump() == "[1.09,null]");
}

TEST_CASE("a log too short has no error to report and says so without a NaN") {
  Diagnosis d = example();
  d.findings.clear();
  d.base.holdout_rmse = std::numeric_limits<double>::quiet_NaN();
  d.notes = {{WarningKind::log_too_short, "too short to tell an effect from chance"}};
  CHECK(diagnosis_json(d, nullptr)["base"]["holdout_rmse"].is_null());
  const std::string text = diagnosis_text(d, {});
  CHECK(text.find("nan") == std::string::npos);
  CHECK(text.starts_with("This flight log is too short to judge anything by."));
  CHECK(text.find("too short") != std::string::npos);
}

TEST_CASE("the story tells finding, uncertainty, rival and gain") {
  std::string text = diagnosis_text(example(), {});
  std::replace(text.begin(), text.end(), '\n', ' ');  // lines are wrapped
  CHECK(text.find("Drag in proportion to speed (linear_drag) would help by 34.1 ± 2.5 %") !=
        std::string::npos);
  CHECK(text.find("0.42 m/s") != std::string::npos);
  for (const char* part : {"wind_m_s = -1.20 m/s", "-1.30 to -1.10", "20.0 ± 2.0 %", "pitch trim",
                           "hover through all headings", "36.0 %", "vertical coupling"}) {
    INFO(part);
    CHECK(text.find(part) != std::string::npos);
  }
}

TEST_CASE("the story opens with what was found, in words within a sentence") {
  Diagnosis d = example();
  const auto opening = [&] {
    std::string text = diagnosis_text(d, {});
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.substr(0, text.find(" It has"));
  };
  d.findings[0].title = "Steady wind";
  CHECK(opening().starts_with("Found: steady wind (or pitch trim). That explains "));
  d.findings[0].indistinguishable_from.clear();
  CHECK(opening().starts_with("Found: steady wind. That explains "));
  d.findings[0].flight = 2;
  d.findings.push_back(d.findings[0]);
  d.findings[1].title = "ESC too hot";
  CHECK(opening().starts_with("Found: steady wind in flight 2; ESC too hot in flight 2. That "));
}

TEST_CASE("the CSV has one row a parameter") {
  CHECK(diagnosis_csv(example().findings) ==
        "effect,stage,parameter,value,unit,ci95_lower,ci95_upper,gain_percent,gain_se_percent\n"
        "wind,airframe,wind_m_s,-1.2,m/s,-1.3,-1.1,20,2\n");
}
