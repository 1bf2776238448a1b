// What is read from PX4 logs whose content is known by construction.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "support/ulog_writer.hpp"
#include "tethercalc/io/autopilot_log.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/log_summary.hpp"

using namespace tethercalc;
using test::ULogContent;
using test::ULogWriter;

namespace {

std::vector<double> column(const AutopilotLog& log, const std::string& message,
                           const std::string& field, std::optional<int> instance = {}) {
  const std::vector<std::string> fields = {field};
  return log.columns(message, fields, instance).front();
}

}  // namespace

TEST_CASE("nested types, arrays of them and padding lie where the formats say") {
  ULogWriter log;
  log.format(
      "outer:uint64_t timestamp;uint8_t first;uint8_t[3] _padding0;inner[2] part;int16_t last;");
  log.format("inner:float value;int8_t[2] pair;uint8_t[2] _padding0;");
  log.subscribe(7, "outer");
  ULogContent content;
  content.put(std::uint64_t{5}).put(std::uint8_t{200}).put(std::uint8_t{9}).put(std::uint16_t{9});
  for (const float value : {1.5F, -2.5F}) {
    content.put(value).put(std::int8_t{-3}).put(std::int8_t{4}).put(std::uint16_t{9});
  }
  content.put(std::int16_t{-300});
  log.data(7, content);
  const AutopilotLog read(log.bytes(), "log");
  CHECK(read.format() == LogFormat::ulog);
  std::vector<std::string> names;
  for (const LogField& field : read.contents().find("outer")->fields) names.push_back(field.name);
  CHECK(names == std::vector<std::string>{"timestamp", "first", "part[0].value", "part[0].pair[0]",
                                          "part[0].pair[1]", "part[1].value", "part[1].pair[0]",
                                          "part[1].pair[1]", "last"});
  CHECK(column(read, "outer", "first") == std::vector<double>{200});
  CHECK(column(read, "outer", "part[1].value") == std::vector<double>{-2.5});
  CHECK(column(read, "outer", "part[0].pair[1]") == std::vector<double>{4});
  CHECK(column(read, "outer", "last") == std::vector<double>{-300});
}

TEST_CASE("padding at the end of a message may be there or not") {
  ULogWriter log;
  log.format("topic:uint64_t timestamp;uint8_t value;uint8_t[7] _padding0;");
  log.subscribe(1, "topic");
  log.data(1, ULogContent().put(std::uint64_t{1}).put(std::uint8_t{3}));
  log.data(1, ULogContent().put(std::uint64_t{2}).put(std::uint64_t{4}));
  const AutopilotLog read(log.bytes(), "log");
  CHECK(column(read, "topic", "value") == std::vector<double>{3, 4});
  CHECK(read.contents().skipped_bytes == 0);
}

TEST_CASE("instances of a topic are told apart, and asked for together come in the log's order") {
  ULogWriter log;
  log.format("battery_status:uint64_t timestamp;float voltage_v;");
  log.subscribe(3, "battery_status", 0);
  log.subscribe(4, "battery_status", 2);
  for (const auto number : std::vector<std::uint16_t>{3, 4, 3}) {
    log.data(number,
             ULogContent().put(std::uint64_t{1'500'000}).put(10.0F * static_cast<float>(number)));
  }
  const AutopilotLog read(log.bytes(), "log");
  CHECK(read.instances("battery_status") == std::vector<int>{0, 2});
  CHECK(column(read, "battery_status", "voltage_v", 0) == std::vector<double>{30, 30});
  CHECK(column(read, "battery_status", "voltage_v", 2) == std::vector<double>{40});
  CHECK(column(read, "battery_status", "voltage_v") == std::vector<double>{30, 40, 30});
  const std::vector<std::string> fields = {"voltage_v"};
  CHECK(read.series("battery_status", fields, 2).time == std::vector<double>{1.5});
  CHECK(column(read, "battery_status", "current_a").empty());
  CHECK(read.contents().count("battery_status") == 3);
}

TEST_CASE("information, its continued parts, first parameters, words and dropouts are told") {
  ULogWriter log;
  log.information("sys_name", "PX4");
  log.information("uint32_t ver_sw_release", ULogContent().put(std::uint32_t{0x010B0200}));
  log.multiple(false, "perf", "one ");
  log.multiple(true, "perf", "and more");
  log.multiple(false, "perf", "another list");
  log.parameter("MC_ROLL_P", 6.5F);
  log.format("topic:uint64_t timestamp;");
  log.subscribe(1, "topic");
  log.data(1, ULogContent().put(std::uint64_t{2'000'000}));
  log.parameter("MC_ROLL_P", 7.5F);
  log.words('6', 2'100'000, "Takeoff detected");
  log.dropout(250);
  log.sync();
  const AutopilotLog read(log.bytes(), "log");
  const LogContents& contents = read.contents();
  CHECK(contents.information.at("sys_name") == "PX4");
  CHECK(contents.information.at("ver_sw_release") == "17498624");
  CHECK(contents.information.at("perf") == "one and more");
  CHECK(contents.parameters.at("MC_ROLL_P") == 6.5);
  CHECK(contents.words == std::vector<std::string>{"Takeoff detected"});
  REQUIRE(contents.dropouts.size() == 1);
  CHECK(contents.dropouts[0].time == Approx(2.1));
  CHECK(contents.dropouts[0].duration == 0.25);
  CHECK(contents.skipped_bytes == 0);
  CHECK(contents.messages == log.starts().size());
  CHECK(summarize_log(read).firmware == "PX4 1.11.2");
}

TEST_CASE("data appended after a crash is read, though the message before it is cut") {
  ULogWriter log;
  log.format("topic:uint64_t timestamp;float value;");
  log.subscribe(1, "topic");
  log.data(1, ULogContent().put(std::uint64_t{1}).put(1.0F));
  log.append(ULogContent().put(std::uint16_t{14}).put('D').put(std::uint16_t{1}).bytes());
  log.begin_appended();
  log.data(1, ULogContent().put(std::uint64_t{2}).put(2.0F));
  const AutopilotLog read(log.bytes(), "log");
  CHECK(column(read, "topic", "value") == std::vector<double>{1, 2});
  CHECK(read.contents().skipped_bytes == 5);
  CHECK(read.contents().skipped_messages == 1);
}

TEST_CASE("a log with flags that change its meaning in a way not known here is refused") {
  ULogWriter log(0, 4);
  log.sync();
  CHECK_THROWS_WITH(AutopilotLog(log.bytes(), "new.ulg"),
                    Catch::Contains("new.ulg: is a ULog of a kind that cannot be read"));
}

TEST_CASE("contradicting, circular and endless definitions cost their own messages only") {
  ULogWriter log;
  log.format("good:uint64_t timestamp;");
  log.format("circle:uint64_t timestamp;circle inner;");
  log.format("endless:many[65535] inner;");
  log.format("many:double[65535] value;");
  log.format("unknown:complex value;");
  log.format("twice:uint64_t timestamp;");
  log.format("twice:uint32_t timestamp;");
  const std::vector<std::string> names = {"good", "circle", "endless", "unknown", "twice"};
  for (std::uint16_t i = 0; i < names.size(); ++i) log.subscribe(i, names[i]);
  log.subscribe(20, "good");
  log.subscribe(20, "good", 1);
  for (const auto number : std::vector<std::uint16_t>{0, 1, 2, 3, 4, 20, 0}) {
    log.data(number, ULogContent().put(std::uint64_t{7}));
  }
  const AutopilotLog read(log.bytes(), "log");
  CHECK(read.contents().count("good") == 2);
  for (const char* const name : {"circle", "endless", "unknown", "twice"}) {
    CHECK(read.contents().count(name) == 0);
  }
  CHECK(read.contents().skipped_bytes == 5 * 13);
  CHECK(read.contents().rejected_definitions.size() == 6);
}
