// A log's summary as text, CSV and JSON, and its messages as CSV.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "support/dataflash_writer.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/report/log_report.hpp"

using namespace tethercalc;
using test::DataFlashWriter;

namespace {

DataFlashWriter small_log() {
  DataFlashWriter log;
  log.define(20, "TEST", "QfcZ", "TimeUS,Value,Angle,Note");
  log.add(20,
          {std::uint64_t{9'007'199'254'740'993}, 0.1, std::int64_t{-561}, std::string("plain")});
  log.add(20, {std::uint64_t{9'007'199'254'741'993}, std::nan(""), std::int64_t{0},
               std::string("says \"a, b\"")});
  return log;
}

std::string csv_of(const DataFlashWriter& log, const std::string& message) {
  std::string all;
  messages_csv(AutopilotLog(log.bytes(), "small.bin"), message,
               [&](std::string_view line) { all += line; });
  return all;
}

}  // namespace

TEST_CASE("messages are exported exactly: 64-bit integers, shortest numbers, quoted text, no NaN") {
  CHECK(csv_of(small_log(), "TEST") ==
        "TimeUS,Value,Angle,Note\n"
        "9007199254740993,0.1,-5.61,plain\n"
        "9007199254741993,,0,\"says \"\"a, b\"\"\"\n");
}

TEST_CASE("an unknown message is refused with the closest one, before anything is written") {
  std::size_t lines = 0;
  const std::vector<std::byte> bytes = small_log().bytes();
  CHECK_THROWS_WITH(
      messages_csv(AutopilotLog(bytes, "small.bin"), "TESTS", [&](std::string_view) { ++lines; }),
      "small.bin: the log holds no message TESTS; did you mean \"TEST\"?");
  CHECK(lines == 0);
}

TEST_CASE("the JSON summary holds what the log does, and is valid whatever the log holds") {
  DataFlashWriter log;
  log.define(11, "MSG", "QZ", "TimeUS,Message");
  log.add(11, {std::uint64_t{1'000'000}, std::string("\xFF\xFE bad")});
  log.add(11, {std::uint64_t{3'000'000}, std::string("")});
  std::vector<std::byte> bytes = log.bytes();
  bytes.push_back(std::byte{0xA3});
  bytes.push_back(std::byte{0x95});
  const auto answer =
      nlohmann::json::parse(log_json(summarize_log(AutopilotLog(bytes, "a.bin")), "a.bin").dump());
  CHECK(answer.at("file") == "a.bin");
  CHECK(answer.at("bytes") == bytes.size());
  CHECK(answer.at("messages") == 4);
  CHECK(answer.at("first_s") == 1.0);
  CHECK(answer.at("last_s") == 3.0);
  CHECK(answer.at("duration_s") == 2.0);
  CHECK(answer.at("flying").is_null());
  CHECK(answer.at("gap_count") == 1);
  CHECK(answer.at("gaps").at(0).at("duration_s") == 2.0);
  CHECK(answer.at("skipped").at("bytes") == 2);
  CHECK(answer.at("skipped").at("messages") == 1);
  CHECK(answer.at("skipped").at("stretches").at(0).at("offset") == bytes.size() - 2);
  REQUIRE(answer.at("types").size() == 2);
  CHECK(answer.at("types").at(0).at("name") == "FMT");
  CHECK(answer.at("types").at(0).at("rate_Hz").is_null());
  CHECK(answer.at("types").at(1).at("rate_Hz") == 0.5);
  CHECK(answer.at("types").at(1).at("fields") == nlohmann::json({"TimeUS", "Message"}));
}

TEST_CASE("the text and CSV summaries have a line for every message") {
  const std::vector<std::byte> bytes = small_log().bytes();
  const LogSummary summary = summarize_log(AutopilotLog(bytes, "small.bin"));
  const std::string text = log_text(summary, "small.bin");
  CHECK(text.find("small.bin: ") == 0);
  CHECK(text.find("4 messages, nothing skipped") != std::string::npos);
  CHECK(text.find("TEST") != std::string::npos);
  CHECK(log_csv(summary).find(
            "name,count,rate_Hz,first_s,last_s,longest_gap_s\nFMT,2,,,,\nTEST,2,") == 0);
}
