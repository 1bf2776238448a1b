#include "tethercalc/report/diagnosis_report.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>

using namespace tethercalc;

namespace {

Diagnosis example() {
  Diagnosis d;
  d.kind = "flight";
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
  d.not_testable.push_back({"vertical_coupling", "vd_m_s"});
  return d;
}

}  // namespace

TEST_CASE("the JSON of a diagnosis has the documented keys") {
  Diagnosis d = example();
  d.design_impact = DesignImpact{{1.09, std::nullopt}, {445.0, std::nullopt}};
  const auto json = diagnosis_json(d, nullptr);
  for (const char* key :
       {"kind", "samples", "effective_samples", "base", "findings", "not_testable",
        "not_identifiable", "unexplained", "extended", "design_impact"}) {
    CHECK(json.contains(key));
  }
  const auto& finding = json["findings"][0];
  CHECK(finding["effect"] == "wind");
  CHECK(finding["parameters"][0]["ci95"] == nlohmann::ordered_json({-1.3, -1.1}));
  CHECK(finding["indistinguishable_from"] == nlohmann::ordered_json({"pitch_trim"}));
  CHECK(json["base"]["unit"] == "m/s²");
  CHECK(json["unexplained"]["detected"] == false);
  CHECK(json["design_impact"]["cross_section_mm2"].dump() == "[1.09,null]");
}

TEST_CASE("a log too short has no error to report and says so without a NaN") {
  Diagnosis d = example();
  d.findings.clear();
  d.base.holdout_rmse = std::numeric_limits<double>::quiet_NaN();
  d.notes = {"too short to tell an effect from chance"};
  CHECK(diagnosis_json(d, nullptr)["base"]["holdout_rmse"].is_null());
  const std::string text = diagnosis_text(d, {});
  CHECK(text.find("nan") == std::string::npos);
  CHECK(text.find("too short") != std::string::npos);
}

TEST_CASE("the story tells finding, uncertainty, rival and gain") {
  std::string text = diagnosis_text(example(), {});
  std::replace(text.begin(), text.end(), '\n', ' ');  // lines are wrapped
  for (const char* part : {"wind_m_s = -1.20 m/s", "-1.30 to -1.10", "20.0 ± 2.0 %", "pitch_trim",
                           "hover through all headings", "36.0 %", "vertical_coupling"}) {
    INFO(part);
    CHECK(text.find(part) != std::string::npos);
  }
}

TEST_CASE("the CSV has one row a parameter") {
  CHECK(diagnosis_csv(example().findings) ==
        "effect,stage,parameter,value,unit,ci95_lower,ci95_upper,gain_percent,gain_se_percent\n"
        "wind,airframe,wind_m_s,-1.2,m/s,-1.3,-1.1,20,2\n");
}
