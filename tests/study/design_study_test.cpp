#include "tethercalc/study/design.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "support/random.hpp"
#include "support/random_designs.hpp"
#include "tethercalc/solve/optimize.hpp"

using namespace tethercalc;

namespace {

SweepAxis masses(const Design& design, std::vector<double> shares) {
  for (double& share : shares) share *= design.drone.mass / unit::gram;
  return {"drone.mass_g", std::move(shares),
          [](Design& d, double grams) { d.drone.mass = grams * unit::gram; }};
}

}  // namespace

TEST_CASE("a choice is never worse than the optimum of any alternative") {
  int at_tilt_limit = 0;
  for (unsigned i = 0; i < 200; ++i) {
    test::Random random(test::run_seed() + i);
    INFO("TETHERCALC_TEST_SEED=" << test::run_seed() << ", case " << i);
    DesignQuestion question;
    Design& base = question.problem.base = test::random_design(random);
    base.requirements.power_at = Condition::forward;
    base.flight.airspeed = random.uniform(8, 20);
    const Optimization plain = optimize(base);
    if (!plain.feasible) continue;
    // A tilt that the drone may have with its tether, but not without the tether's weight.
    const double tilt = std::max(std::abs(plain.hover.pitch), std::abs(plain.forward.pitch));
    base.requirements.max_pitch = std::max(tilt * (1 + 1e-6), 1 * unit::degree);
    question.problem.free = {masses(base, {1, 1.03, 1.1})};
    double least = std::numeric_limits<double>::infinity();
    for (const double share : {1.0, 1.03, 1.1}) {
      Design design = base;
      design.drone.mass *= share;
      const Optimization optimum = optimize(design);
      if (optimum.feasible) least = std::min(least, optimum.forward.total_power);
    }
    if (!std::isfinite(least)) continue;
    ++at_tilt_limit;
    const DesignAnswer answer = search_design(question.problem);
    CHECK(answer.feasible);
    CHECK(answer.minimum.value <= least * (1 + 1e-12));
  }
  CHECK(at_tilt_limit > 20);
}

TEST_CASE("a limit on the cross-section is one on the cable that flies") {
  DesignQuestion question;
  question.problem.base = test::published_design();
  question.problem.free = {{"supply.voltage_V", Uniform{40, 75},
                            [](Design& d, double volts) { d.supply.voltage = volts; }}};
  const auto answer_with = [&](double mm2, int sign) {
    question.problem.limits = {
        {"area", PointQuantity{&OperatingPoint::cross_section, unit::square_millimetre}, mm2,
         sign}};
    return study_design(question).answer;
  };
  // The published optimum, 1.0886 mm² at 75 V, lies within the first limit and outside of the
  // second; below it the headroom is not met.
  CHECK(answer_with(1.2, 1).best.area == Approx(1.0886e-6).epsilon(1e-4));
  CHECK(answer_with(1.2, -1).best.area == Approx(1.2e-6).epsilon(1e-6));
  CHECK_FALSE(answer_with(1.05, 1).feasible);
}

TEST_CASE("a price lets everything that is free adapt, choices too") {
  // With 100 g more, 1.3 mm² no longer leaves the headroom; the next size does.
  DesignQuestion question;
  Design& base = question.problem.base = test::published_design();
  base.drone.mass = 1.85;
  question.problem.free = {
      {std::string(cross_section_path), std::vector<double>{1.0377, 1.3087, 1.6502},
       [](Design& d, double mm2) { d.tether.cross_section = mm2 * unit::square_millimetre; }}};
  const DesignStudy before = study_design(question);
  base.drone.mass += 0.1;
  const DesignStudy after = study_design(question);
  REQUIRE(before.answer.feasible);
  REQUIRE(after.answer.feasible);
  CHECK(after.answer.best.area > before.answer.best.area);
  for (const ShadowPrice& price : before.prices) {
    if (price.name != "drone.mass_g") continue;
    CHECK(price.price ==
          Approx(after.answer.minimum.value - before.answer.minimum.value).epsilon(1e-9));
    return;
  }
  FAIL("no price of mass");
}

TEST_CASE("an optimum inside of a range is at no end of it, however wide the range") {
  // The published optimum is 1.0886 mm²; below 1e-3 mm² there is no cable.
  for (const auto& [lo, hi] :
       std::vector<std::pair<double, double>>{{0.9, 1.2}, {0.4, 1e6}, {1e-3, 1e6}}) {
    INFO(lo << " to " << hi);
    DesignQuestion question;
    question.problem.base = test::published_design();
    question.problem.free = {
        {std::string(cross_section_path), Uniform{lo, hi}, [](Design& d, double mm2) {
           if (!(mm2 >= 1e-3)) throw std::invalid_argument("no cable");
           d.tether.cross_section = mm2 * unit::square_millimetre;
         }}};
    const DesignStudy study = study_design(question);
    CHECK(study.answer.best.area == Approx(1.0886e-6).epsilon(1e-4));
    for (const ShadowPrice& price : study.prices) CHECK(price.of != Priced::range_end);
  }
}

TEST_CASE("an end of a range that binds has a price, and has none where nothing lies beyond it") {
  for (const double least : {0.0, 1.3}) {
    DesignQuestion question;
    question.problem.base = test::published_design();
    question.problem.free = {
        {std::string(cross_section_path), Uniform{1.3, 1e6}, [least](Design& d, double mm2) {
           if (mm2 < least) throw std::invalid_argument("no cable");
           d.tether.cross_section = mm2 * unit::square_millimetre;
         }}};
    const DesignStudy study = study_design(question);
    CHECK(study.answer.best.area == Approx(1.3e-6).epsilon(1e-6));
    const auto ends = std::ranges::count_if(
        study.prices, [](const ShadowPrice& price) { return price.of == Priced::range_end; });
    CHECK(ends == (least == 0 ? 1 : 0));
  }
}

TEST_CASE("the condition in which power is judged may be free") {
  DesignQuestion question;
  question.problem.base = test::published_design();
  question.problem.free = {
      {"requirements.power_at", NamedChoices{{"forward", "hover"}}, [](Design& d, double which) {
         d.requirements.power_at = which == 0 ? Condition::forward : Condition::hover;
       }}};
  // Both are limited by the headroom at 1.0886 mm², where hover takes the published 405.4 W.
  const DesignAnswer answer = study_design(question).answer;
  CHECK(answer.values == std::vector<double>{1});
  CHECK(answer.minimum.value == Approx(405.4).margin(0.1));
}
