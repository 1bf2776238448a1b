// Effects of one's own: what is true of a log that the catalogue does not know, and what is not.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "hidden_effects/diagnosed.hpp"
#include "hidden_effects/power_scenarios.hpp"
#include "support/random.hpp"
#include "support/reference_data.hpp"
#include "support/run_program.hpp"
#include "support/verdicts.hpp"
#include "tethercalc/diagnose/hypothesis.hpp"
#include "tethercalc/diagnose/power_diagnosis.hpp"
#include "tethercalc/files/effect_file.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/report/diagnosis_report.hpp"

using namespace tethercalc;
using test::lists;
using truth::HiddenFlight;

namespace {

/// Drag that grows with the roll; channels as `formula_channels` has them.
Hypothesis rolling_drag() {
  return {
      .id = "rolling_drag",
      .title = "Rolling drags",
      .mechanism = "A rolled drone meets the air with its side.",
      .parameters = {{.name = "c", .unit = "N·s/m", .lower = -500, .upper = 500, .scale = 5}},
      .formula = [](std::span<const double> at,
                    std::span<const double> c) { return -c[0] * at[8] * (1 - std::cos(at[2])); },
      .words = "-c * airspeed * (1 - cos(roll))"};
}

Hypothesis ground_cushion() {
  return {.id = "ground_cushion",
          .title = "Drag close to the ground",
          .mechanism = "The wake comes back.",
          .parameters = {{.name = "depth", .neutral = 3, .lower = 0.5, .upper = 20, .scale = 1},
                         {.name = "c", .unit = "N·s/m", .lower = -5, .upper = 5, .scale = 0.1}},
          .formula =
              [](std::span<const double> at, std::span<const double> p) {
                return -p[1] * at[8] * std::exp(-std::max(at[7], 0.0) / p[0]);
              },
          .words = "-c * airspeed * exp(-max(height, 0) / depth)"};
}

HiddenFlight a_flight(int draw, double roll_drag) {
  HiddenFlight hidden;
  hidden.seed = 8800 + static_cast<std::uint64_t>(draw) + 1000 * test::run_seed();
  hidden.duration = 300;
  hidden.roll_drag = roll_drag;
  hidden.roll_std = 5;
  return hidden;
}

Diagnosis asked(const HiddenFlight& hidden, std::vector<Effect> hypotheses) {
  FlightDiagnosisOptions options = truth::beside(truth::usual_base);
  options.hypotheses = std::move(hypotheses);
  return diagnose_flight(truth::design_of(hidden), truth::fly(hidden), options);
}

std::vector<Effect> read(const std::string& text) {
  const test::TemporaryFolder folder;
  test::write_file(folder.path() / "effects.json", text);
  return read_effects((folder.path() / "effects.json").string());
}

std::string refusal(const std::string& text) {
  try {
    (void)read(text);
  } catch (const InputError& error) {
    std::string all;
    for (const InputProblem& problem : error.problems()) {
      all += problem.where + ": " + problem.message + "\n";
    }
    return all;
  }
  return "";
}

/// A file with this formula of a force and a parameter c.
std::string file_with(const std::string& formula, const std::string& parameter = "c") {
  return R"({"id": "mine", "title": "t", "mechanism": "m.", "force_N": ")" + formula +
         R"(", "parameters": [{"name": ")" + parameter + R"(", "lower": -2, "upper": 2}]})";
}

/// The diagnosis of the published flight, the samples that were published.
nlohmann::ordered_json published_flight(const std::filesystem::path& log,
                                        const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"diagnose",
                                     test::project_file("examples/holybro-x500.json"),
                                     "--flight",
                                     log.string(),
                                     "--mass-g",
                                     "1549",
                                     "--from",
                                     "25%",
                                     "--to",
                                     "90%",
                                     "--pitch-offset-deg",
                                     "1.4955439766569403",
                                     "--format",
                                     "json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const test::Ran run = test::run_tethercalc(arguments);
  REQUIRE(run.exit_code == 0);
  return nlohmann::ordered_json::parse(run.out);
}

}  // namespace

TEST_CASE("a true hypothesis is found and sized, a false one beside it is not") {
  int found = 0;
  const int draws = test::draws(4);
  for (int draw = 0; draw < draws; ++draw) {
    const Diagnosis d =
        asked(a_flight(draw, 60), {effect_of(rolling_drag()), effect_of(ground_cushion())});
    CHECK_FALSE(lists(d.findings, "ground_cushion"));
    for (const Finding& f : d.findings) {
      if (f.effect != "rolling_drag") continue;
      ++found;
      CHECK(f.parameters.front().value == Approx(60).epsilon(0.3));
    }
  }
  CHECK(found >= draws - 1);
}

TEST_CASE("hypotheses are ruled out, with a bound, by flights that hide nothing") {
  int named = 0;
  const int draws = test::draws(4);
  for (int draw = 0; draw < draws; ++draw) {
    const Diagnosis d =
        asked(a_flight(50 + draw, 0), {effect_of(rolling_drag()), effect_of(ground_cushion())});
    named += !d.findings.empty();
    CHECK(test::verdict_counts(d)["rolling_drag"] == 1);
    CHECK(test::verdict_counts(d)["ground_cushion"] == 1);
  }
  CHECK(named <= 1);
}

TEST_CASE("structure without a name comes as a file that, read again, is found") {
  if (test::leave_rates_out()) return;  // that in the power goes the same way
  const HiddenFlight hidden = a_flight(90, 120);
  const Diagnosis before = asked(hidden, {});
  REQUIRE(before.unexplained.detected);
  nlohmann::ordered_json file = diagnosis_json(before, nullptr)["unexplained"]["effect"];
  REQUIRE(file.is_object());
  file["id"] = "named_now";
  const Diagnosis after = asked(hidden, read(file.dump()));
  REQUIRE(lists(after.findings, "named_now"));
  CHECK(after.extended.holdout_rmse < before.extended.holdout_rmse);
}

TEST_CASE("structure in the power comes as such a file, too") {
  power_truth::Scenario scenario;
  scenario.seed = 1'000'003ULL * test::run_seed() + 6;
  scenario.hidden.step_in_motor_power = 0.06;
  const PowerLog log = power_truth::as_power_log(power_truth::simulate(scenario));
  const Diagnosis before = diagnose_power(power_truth::spec(), log).diagnosis;
  REQUIRE(before.unexplained.detected);
  nlohmann::ordered_json file = diagnosis_json(before, nullptr)["unexplained"]["effect"];
  REQUIRE(file.is_object());
  file["id"] = "named_now";
  const Diagnosis after =
      diagnose_power(power_truth::spec(), log, {}, {}, read(file.dump())).diagnosis;
  REQUIRE(lists(after.findings, "named_now"));
  CHECK(after.findings.front().parameters.front().value == Approx(0.06).margin(0.01));
}

TEST_CASE("a hypothesis about the power is found where it is true") {
  if (test::leave_rates_out()) return;
  power_truth::Scenario scenario;
  scenario.seed = 1'000'003ULL * test::run_seed() + 5;
  scenario.hidden.motor_power_per_height = 0.15;
  const PowerLog log = power_truth::as_power_log(power_truth::simulate(scenario));
  const std::vector<Effect> effects = read(
      R"({"id": "height_power", "title": "t", "mechanism": "m.", "power_W": "c * power * (height / 30)^2",
          "parameters": [{"name": "c", "lower": -1, "upper": 1}]})");
  const Diagnosis without = diagnose_power(power_truth::spec(), log).diagnosis;
  const Diagnosis with = diagnose_power(power_truth::spec(), log, {}, {}, effects).diagnosis;
  REQUIRE(lists(with.findings, "height_power"));
  CHECK(with.extended.holdout_rmse < without.extended.holdout_rmse);
  const ParameterEstimate& c = with.findings.front().parameters.front();
  CHECK(c.value == Approx(0.15).margin(0.03));
}

TEST_CASE("the examples of hypotheses hold of the published flight as they say") {
  const auto file = test::reference_file("data/x500-flight.csv");
  if (!file) return;
  const std::string folder = test::project_file("examples/effects/");
  const auto d = published_flight(
      *file, {"--base", "linear_drag,wind", "--effects", folder + "braking-wake.json", "--effects",
              folder + "ground-cushion.json"});
  const auto& first = d["findings"][0];
  const auto rivals = first["indistinguishable_from"].get<std::vector<std::string>>();
  CHECK((first["effect"] == "braking_wake" ||
         std::find(rivals.begin(), rivals.end(), "braking_wake") != rivals.end()));
  CHECK(std::any_of(d["ruled_out"].begin(), d["ruled_out"].end(),
                    [](const auto& r) { return r["effect"] == "ground_cushion"; }));
}

TEST_CASE("structure of the published flight that comes back as an effect displaces no drag") {
  const auto file = test::reference_file("data/x500-flight.csv");
  if (!file || test::stride() > 1)
    return;  // two minutes under a sanitizer, of code tried elsewhere
  const auto names = [](const nlohmann::ordered_json& d) {
    std::set<std::string> found;
    for (const auto& f : d["findings"]) found.insert(f["effect"].get<std::string>());
    return found;
  };
  const auto before = published_flight(*file, {});
  REQUIRE(before["unexplained"]["effect"].is_object());
  const test::TemporaryFolder folder;
  const std::string effects = folder.path() / "unnamed.json";
  test::write_file(effects, before["unexplained"]["effect"].dump());
  const std::set<std::string> after = names(published_flight(*file, {"--effects", effects}));
  for (const char* effect : {"linear_drag", "wind", "propwash"}) {
    INFO(effect);
    CHECK(names(before).contains(effect));
    CHECK(after.contains(effect));
  }
}

TEST_CASE("an effect's sizes come first, whatever the order in its file") {
  const Effect effect = effect_of(ground_cushion());
  CHECK(effect.sizes == 1);
  CHECK(effect.parameters[0].name == "c");
  CHECK(effect.parameters[1].name == "depth");
}

TEST_CASE("effects of several files come in their order, and none of one id twice") {
  const std::string wake = test::project_file("examples/effects/braking-wake.json");
  const std::string cushion = test::project_file("examples/effects/ground-cushion.json");
  const auto effects = read_effect_files(std::vector{cushion, wake});
  REQUIRE(effects.size() == 2);
  CHECK(effects[0].id == "ground_cushion");
  CHECK(effects[1].id == "braking_wake");
  CHECK(read_effect_files({}).empty());
  CHECK_THROWS_WITH(
      read_effect_files(std::vector{wake, cushion, wake}),
      Catch::Matchers::Contains(wake) &&
          Catch::Matchers::Contains("\"braking_wake\" is an effect of another file, too"));
}

TEST_CASE("every problem of an effect's file is told with its place") {
  using Catch::Matchers::Contains;
  CHECK_THAT(refusal(R"({"id": "mine"})"), Contains("/title: \"title\" is missing") &&
                                               Contains("/parameters: \"parameters\" is missing"));
  CHECK_THAT(refusal(file_with("c * airspee")),
             Contains("/force_N: \"airspee\" is neither a channel nor a parameter") &&
                 Contains("did you mean \"airspeed\""));
  CHECK_THAT(refusal(file_with("c * (airspeed")), Contains("is no formula: Missing parenthesis"));
  CHECK_THAT(refusal(file_with("c + 1")), Contains("its formula is 1 there"));
  CHECK_THAT(refusal(file_with("c * sqrt(airspeed)")), Contains("its formula is no number there"));
  CHECK_THAT(refusal(file_with("0 * c")), Contains("changes its formula by itself"));
  CHECK_THAT(refusal(file_with("c * (airspeed = 5)")), Contains("to compare write =="));
  std::string idle = file_with("c * airspeed");
  idle.insert(idle.find("[{") + 1, R"({"name": "idle", "lower": 0, "upper": 1}, )");
  CHECK_THAT(refusal(idle), Contains("has a formula that idle does not change"));
  CHECK_THAT(refusal(file_with("tilt", "tilt")), Contains("is the name of a channel"));
  CHECK_THAT(refusal(file_with("c", "c d")), Contains("is no name that a formula can hold"));
  CHECK_THAT(refusal("[]"), Contains("holds no effect"));
  CHECK_THAT(refusal("[" + file_with("c") + "," + file_with("c") + "]"),
             Contains("is the id of another effect"));
  std::string known = file_with("c");
  known.replace(known.find("mine"), 4, "wind");
  CHECK_THAT(refusal(known), Contains("is one of the catalogue"));
  std::string both = file_with("c");
  both.insert(both.find("\"force_N\""), "\"power_W\": \"c\", ");
  CHECK_THAT(refusal(both), Contains("needs one formula"));
}

TEST_CASE("every channel of a formula stands in the documentation") {
  const std::string page = test::file_text(test::project_file("docs/diagnosis.md"));
  for (const LogKind kind : {LogKind::flight, LogKind::power}) {
    for (const FormulaChannel& channel : formula_channels(kind)) {
      CHECK_THAT(page, Catch::Contains("`" + std::string(channel.name) + "`"));
    }
  }
}

TEST_CASE("whatever bytes an effect's file holds, it is read or refused with reasons") {
  test::Random random(test::run_seed());
  const std::string whole = file_with("-c * airspeed * exp(-max(height, 0) / 3) + c * sin(tilt)^2");
  const std::string pieces = "(){}[]\",:+-*/^?<>=&|!._0123456789eEcxpi \n\t";
  for (int i = 0; i < 400; ++i) {
    std::string text = whole;
    for (int k = random.integer(1, 4); k > 0; --k) {
      const auto at =
          static_cast<std::size_t>(random.integer(0, static_cast<int>(text.size()) - 1));
      const char piece =
          pieces[static_cast<std::size_t>(random.integer(0, static_cast<int>(pieces.size()) - 1))];
      if (random.chance(0.3)) {
        text.erase(at, 1);
      } else if (random.chance(0.5)) {
        text.insert(at, 1, piece);
      } else {
        text[at] = piece;
      }
    }
    INFO(text);
    try {
      const std::size_t effects = read(text).size();
      CHECK(effects == 1);
    } catch (const InputError& error) {
      CHECK_FALSE(error.problems().empty());
    }
  }
}

TEST_CASE("a formula that is no number somewhere in the log ends the diagnosis with its place") {
  Hypothesis hypothesis = rolling_drag();
  hypothesis.formula = [](std::span<const double> at, std::span<const double> c) {
    return c[0] * (at[0] > 100 && at[0] < 130 ? std::sqrt(-1.0) : at[8]);
  };
  CHECK_THROWS_WITH(asked(a_flight(91, 0), {effect_of(hypothesis)}),
                    Catch::Matchers::Contains("has a formula that is no number at 100."));
}
