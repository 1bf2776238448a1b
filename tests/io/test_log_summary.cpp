// What a log's summary tells, on logs whose content is known by construction.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "support/dataflash_writer.hpp"
#include "tethercalc/io/log_summary.hpp"

using namespace tethercalc;
using test::DataFlashWriter;

namespace {

LogSummary summarized(const DataFlashWriter& log) {
  return summarize_log(AutopilotLog(log.bytes(), "log"));
}

constexpr int ev_type = 12;

void define_ev(DataFlashWriter& log) { log.define(ev_type, "EV", "QB", "TimeUS,Id"); }
void add_ev(DataFlashWriter& log, double time, std::int64_t id) {
  log.add(ev_type, {static_cast<std::uint64_t>(time * 1e6), id});
}

/// EKF samples at 10 Hz from `start` to `end` s, moving north at `speed`.
void add_samples(DataFlashWriter& log, double start, double end, double speed) {
  for (double t = start; t < end - 0.05; t += 0.1) {
    test::add_xkf1(log, 0,
                   {.time_us = static_cast<std::uint64_t>(std::lround(t * 1e6)), .vn = speed});
  }
}

const LogSummary::Message& message(const LogSummary& summary, const std::string& name) {
  for (const auto& type : summary.types) {
    if (type.name == name) return type;
  }
  FAIL("no " + name);
  throw 0;
}

}  // namespace

TEST_CASE("counts, rates, time range and gaps of a log are told") {
  DataFlashWriter log;
  test::define_xkf1(log);
  log.define(11, "MSG", "QZ", "TimeUS,Message");
  log.add(11, {std::uint64_t{10'000'000}, std::string("ArduCopter V4.5.7")});
  add_samples(log, 10, 20, 0);
  add_samples(log, 25, 30, 0);
  const LogSummary summary = summarized(log);
  CHECK(summary.messages == 3 + 1 + 150);
  CHECK(summary.bytes == log.bytes().size());
  CHECK(summary.firmware == "ArduCopter V4.5.7");
  CHECK(*summary.first_time == Approx(10));
  CHECK(*summary.last_time == Approx(29.9));
  REQUIRE(summary.gaps.size() == 1);
  CHECK(summary.gaps[0].start == Approx(19.9));
  CHECK(summary.gaps[0].duration == Approx(5.1));
  const auto& xkf1 = message(summary, "XKF1");
  CHECK(xkf1.count == 150);
  CHECK(*xkf1.rate == Approx(149 / 19.9));
  CHECK(*xkf1.longest_gap == Approx(5.1));
  const auto& msg = message(summary, "MSG");
  CHECK(msg.count == 1);
  CHECK_FALSE(msg.rate.has_value());
  CHECK_FALSE(msg.longest_gap.has_value());
  CHECK_FALSE(message(summary, "FMT").first_time.has_value());
}

TEST_CASE("gaps are where nothing was written, in whatever order the messages stand") {
  DataFlashWriter log;
  test::define_xkf1(log);
  add_samples(log, 30, 31, 0);
  // Before and behind it, then what closes a gap, then what lies between two.
  add_samples(log, 10, 11, 0);
  add_samples(log, 50, 51, 0);
  add_samples(log, 11, 30, 0);
  add_samples(log, 40, 41, 0);
  const LogSummary summary = summarized(log);
  REQUIRE(summary.gap_count == 2);
  REQUIRE(summary.gaps.size() == 2);
  CHECK(summary.gaps[0].start == Approx(30.9));
  CHECK(summary.gaps[0].duration == Approx(9.1));
  CHECK(summary.gaps[1].start == Approx(40.9));
  CHECK(summary.gaps[1].duration == Approx(9.1));
}

TEST_CASE("one time that is far off is not believed but a long pause is") {
  DataFlashWriter log;
  test::define_xkf1(log);
  add_samples(log, 10, 20, 0);
  test::add_xkf1(log, 0, {.time_us = 200'000'000});
  add_samples(log, 20, 21, 0);
  add_samples(log, 321, 322, 0);
  const LogSummary summary = summarized(log);
  CHECK(summary.implausible_times == 1);
  CHECK(*summary.last_time == Approx(321.9));
  CHECK(*summary.first_time == Approx(10));
  REQUIRE(summary.gap_count == 1);
  CHECK(summary.gaps[0].duration == Approx(300.1));
}

TEST_CASE("flying time goes from take-off to landing events, and over several flights") {
  DataFlashWriter log;
  test::define_xkf1(log);
  define_ev(log);
  add_ev(log, 1, 10);  // armed
  add_ev(log, 5, 28);
  add_ev(log, 25, 18);
  add_ev(log, 40, 28);
  add_ev(log, 43.5, 18);
  const LogSummary summary = summarized(log);
  REQUIRE(summary.flying.has_value());
  CHECK(summary.flying->duration == Approx(23.5));
  REQUIRE(summary.flying->flights.size() == 2);
  CHECK(summary.flying->flights[1].start == Approx(40));
  CHECK(summary.flying->flights[1].end == Approx(43.5));
}

TEST_CASE("a detector that bounces for less than two seconds does not land") {
  DataFlashWriter log;
  test::define_xkf1(log);
  define_ev(log);
  add_ev(log, 5, 28);
  for (double bounce = 20; bounce < 20.5; bounce += 0.1) {
    add_ev(log, bounce, 18);
    add_ev(log, bounce + 0.05, 28);
  }
  add_ev(log, 25, 18);
  add_ev(log, 27.5, 28);
  add_ev(log, 30, 18);
  const LogSummary summary = summarized(log);
  REQUIRE(summary.flying.has_value());
  REQUIRE(summary.flying->flights.size() == 2);
  CHECK(summary.flying->flights[0].end == Approx(25));
  CHECK(summary.flying->duration == Approx(22.5));
}

TEST_CASE("a log that begins or ends in the air counts from its beginning or to its end") {
  DataFlashWriter log;
  test::define_xkf1(log);
  define_ev(log);
  add_samples(log, 2, 3, 0);
  add_ev(log, 10, 18);
  add_ev(log, 20, 28);
  add_samples(log, 20, 26, 0);
  CHECK(summarized(log).flying->duration == Approx(8 + 5.9));
}

TEST_CASE("a flight without a landing ends with the motors or the movement, not with the log") {
  const auto flown_until = [](bool disarmed, double speed_after) {
    DataFlashWriter log;
    test::define_xkf1(log);
    define_ev(log);
    add_ev(log, 1, 10);  // armed
    add_ev(log, 2, 28);
    add_samples(log, 2, 30, 5);
    if (disarmed) add_ev(log, 33, 11);
    add_samples(log, 30, 90, speed_after);
    return summarized(log).flying.value();
  };
  CHECK(flown_until(true, 0.1).duration == Approx(31));
  CHECK(flown_until(false, 0.1).duration == Approx(27.9));
  CHECK(flown_until(false, 0.1).determined_by ==
        "the controller's take-off and landing events, and for want of the last landing the last "
        "movement");
  // Still flown when it was cut off.
  CHECK(flown_until(false, 1).duration == Approx(87.9));
}

TEST_CASE("without events, flying is moving, short pauses included and twitches not") {
  DataFlashWriter log;
  test::define_xkf1(log);
  add_samples(log, 0, 10, 0.1);
  add_samples(log, 10, 11, 2);  // carried to the field: too short
  add_samples(log, 11, 30, 0.1);
  add_samples(log, 30, 40, 5);
  add_samples(log, 40, 45, 0.1);  // hovers
  add_samples(log, 45, 50, 5);
  add_samples(log, 50, 80, 0.1);
  const LogSummary summary = summarized(log);
  REQUIRE(summary.flying.has_value());
  CHECK(summary.flying->duration == Approx(19.9));
  CHECK(summary.flying->determined_by.find("XKF1") != std::string::npos);
}
