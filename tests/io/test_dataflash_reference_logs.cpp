// Real logs, compared with what the reference reader recorded of them.
#include <algorithm>
#include <boost/crc.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "files/input_files.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/dataflash.hpp"
#include "tethercalc/io/log_readers.hpp"
#include "tethercalc/io/log_summary.hpp"
#include "tethercalc/model/units.hpp"

using namespace tethercalc;
namespace fs = std::filesystem;

namespace {

const fs::path reference_data = TETHERCALC_REFERENCE_DATA;

struct ReferenceLog {
  fs::path path;
  nlohmann::json recorded;
};

std::vector<ReferenceLog> reference_logs() {
  std::vector<ReferenceLog> logs;
  const fs::path folder = reference_data / "data" / "logs";
  if (!fs::is_directory(folder)) return logs;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".bin") continue;
    fs::path recorded = entry.path();
    recorded.replace_extension(".golden.json");
    std::ifstream file(recorded);
    logs.push_back({entry.path(), nlohmann::json::parse(file)});
  }
  return logs;
}

bool skip_without(const std::vector<ReferenceLog>& logs) {
  if (logs.empty()) std::cout << "SKIPPED: no reference logs in " << reference_data << '\n';
  return logs.empty();
}

struct ColumnStatistics {
  std::size_t finite = 0;
  std::size_t nonfinite = 0;
  long double sum = 0;
  long double magnitude = 0;  // sum of absolute values: the scale of the sum's rounding
  double minimum = std::numeric_limits<double>::infinity();
  double maximum = -std::numeric_limits<double>::infinity();

  void add(double value) {
    if (!std::isfinite(value)) {
      ++nonfinite;
      return;
    }
    ++finite;
    sum += value;
    magnitude += std::abs(value);
    minimum = std::min(minimum, value);
    maximum = std::max(maximum, value);
  }
};

ColumnStatistics statistics_of(const std::vector<double>& values) {
  ColumnStatistics statistics;
  for (const double value : values) statistics.add(value);
  return statistics;
}

void check_statistics(const ColumnStatistics& found, const nlohmann::json& recorded) {
  CHECK(found.finite == recorded.at("n").get<std::size_t>());
  CHECK(found.nonfinite == recorded.at("nonfinite").get<std::size_t>());
  if (found.finite == 0) return;
  CHECK(found.minimum == recorded.at("min").get<double>());
  CHECK(found.maximum == recorded.at("max").get<double>());
  // The recorded sum is rounded to a double, some after adding up with rounding at every step:
  // n·ε of the sum of magnitudes bounds both.
  const double tolerance = static_cast<double>(found.magnitude) *
                           static_cast<double>(found.finite) *
                           std::numeric_limits<double>::epsilon();
  CHECK(std::abs(static_cast<double>(found.sum) - recorded.at("sum").get<double>()) <= tolerance);
}

/// "XKF1[C=0]" and "BAT[0]" are recorded for the messages of one instance.
struct Group {
  std::string message;
  std::optional<DataFlashInstance> instance;
};

Group group_of(const std::string& name, const DataFlashContents& contents) {
  const auto bracket = name.find('[');
  Group group{name.substr(0, bracket), std::nullopt};
  if (bracket == std::string::npos) return group;
  const auto digit = name.find_first_of("0123456789", bracket);
  const double number = std::stod(name.substr(digit));
  for (const std::string field : {"C", "I", "Inst", "Instance"}) {
    if (contents.find(group.message)->find(field) != nullptr) {
      group.instance = DataFlashInstance{field, number};
      return group;
    }
  }
  FAIL("no instance field in " + group.message);
  return group;
}

void check_message_field(const std::byte* message, const LogField& field,
                         const nlohmann::json& recorded) {
  if (recorded == "nan") {
    CHECK(std::isnan(field_value(message, field)));
  } else if (recorded.is_number_integer()) {
    CHECK(field_text(message, field) == recorded.dump());
  } else if (recorded.is_number()) {
    CHECK(field_value(message, field) == recorded.get<double>());
  } else if (field.kind != 'a') {
    CHECK(field_text(message, field) == recorded.get<std::string>());
  }
}

}  // namespace

TEST_CASE("every reference log has the recorded messages, formats and bytes") {
  const auto logs = reference_logs();
  if (skip_without(logs)) return;
  for (const auto& [path, recorded] : logs) {
    INFO(path.filename().string());
    const MappedFile file(path);
    const DataFlashContents contents = scan_dataflash(file.bytes());
    CHECK(contents.messages == recorded.at("total_messages").get<std::size_t>());
    std::map<std::string, std::size_t> counts;
    for (const auto& type : contents.types) {
      if (type.count > 0) counts[type.format.name] += type.count;
    }
    CHECK(counts == recorded.at("counts").get<std::map<std::string, std::size_t>>());
    CHECK(contents.rejected_definitions.empty());

    for (const auto& [name, format] : recorded.at("formats").items()) {
      INFO(name);
      const DataFlashFormat* const found = contents.find(name);
      REQUIRE(found != nullptr);
      CHECK(found->type == format.at("type").get<int>());
      CHECK(found->length == format.at("len").get<std::size_t>());
      CHECK(found->format == format.at("format").get<std::string>());
      // One log's FMT, an old one, leaves out its own last label: reading needs none of them.
      if (name == "FMT") continue;
      std::vector<std::string> names;
      for (const auto& field : found->fields) names.push_back(field.name);
      CHECK(names == format.at("columns").get<std::vector<std::string>>());
    }

    std::map<std::string, boost::crc_32_type> checksums;
    std::size_t bytes_read = 0;
    for_each_message(file.bytes(), [&](const DataFlashFormat& format, const std::byte* message) {
      checksums[format.name].process_bytes(message, format.length);
      bytes_read += format.length;
    });
    CHECK(bytes_read + contents.skipped_bytes == file.bytes().size());
    for (const auto& [name, checksum] : recorded.at("payload_crc32").items()) {
      INFO(name);
      CHECK(checksums[name].checksum() == std::stoul(checksum.get<std::string>(), nullptr, 16));
    }
  }
}

TEST_CASE("every column of every reference log has the recorded count, sum, minimum and maximum") {
  const auto logs = reference_logs();
  if (skip_without(logs)) return;
  for (const auto& [path, recorded] : logs) {
    INFO(path.filename().string());
    const MappedFile file(path);
    const DataFlashContents contents = scan_dataflash(file.bytes());
    for (const auto& [name, columns] : recorded.at("columns").items()) {
      const Group group = group_of(name, contents);
      for (const auto& [column, statistics] : columns.items()) {
        INFO(name << '.' << column);
        const std::vector<std::string> wanted = {column};
        const auto values = extract_columns(file.bytes(), group.message, wanted, group.instance);
        check_statistics(statistics_of(values[0]), statistics);
      }
    }
    for (const auto& [name, range] : recorded.at("time_range").items()) {
      INFO(name);
      const bool microseconds = contents.find(name)->find("TimeUS") != nullptr;
      const std::vector<std::string> wanted = {microseconds ? "TimeUS" : "TimeMS"};
      const auto statistics =
          statistics_of(extract_columns(file.bytes(), name, wanted, std::nullopt)[0]);
      CHECK(statistics.minimum == range.at(0).get<double>());
      CHECK(statistics.maximum == range.at(1).get<double>());
    }
  }
}

TEST_CASE(
    "the first and last messages, parameters and texts of the reference logs are as recorded") {
  const auto logs = reference_logs();
  if (skip_without(logs)) return;
  for (const auto& [path, recorded] : logs) {
    INFO(path.filename().string());
    const MappedFile file(path);
    std::map<std::string, std::vector<const std::byte*>> messages;
    std::map<std::string, DataFlashFormat> formats;
    for_each_message(file.bytes(), [&](const DataFlashFormat& format, const std::byte* message) {
      messages[format.name].push_back(message);
      formats.try_emplace(format.name, format);
    });
    const auto check = [&](const std::string& name, const std::byte* message,
                           const nlohmann::json& fields) {
      for (const auto& [field, value] : fields.items()) {
        INFO(name << '.' << field);
        REQUIRE(formats.at(name).find(field) != nullptr);
        check_message_field(message, *formats.at(name).find(field), value);
      }
    };
    for (const auto& [name, head] : recorded.at("head").items()) {
      if (name.find('[') != std::string::npos) continue;
      for (std::size_t i = 0; i < head.size(); ++i) check(name, messages.at(name).at(i), head[i]);
    }
    for (const auto& [name, tail] : recorded.at("tail").items()) {
      if (name.find('[') == std::string::npos) check(name, messages.at(name).back(), tail);
    }
    std::vector<std::string> texts;
    for (const std::byte* message : messages["MSG"]) {
      texts.push_back(field_text(message, *formats.at("MSG").find("Message")));
    }
    texts.resize(std::min<std::size_t>(texts.size(), 60));  // no more were recorded
    CHECK(texts == recorded.at("msg").get<std::vector<std::string>>());
    std::map<std::string, double> parameters;
    for (const std::byte* message : messages["PARM"]) {
      parameters[field_text(message, *formats.at("PARM").find("Name"))] =
          field_value(message, *formats.at("PARM").find("Value"));
    }
    CHECK(parameters.size() == recorded.at("parm_count").get<std::size_t>());
    for (const auto& [name, value] : recorded.at("parm").items()) {
      INFO(name);
      CHECK(parameters.at(name) == value.get<double>());
    }
  }
}

TEST_CASE("the summary's first and last times of every message are the recorded ones") {
  const auto logs = reference_logs();
  if (skip_without(logs)) return;
  for (const auto& [path, recorded] : logs) {
    INFO(path.filename().string());
    const MappedFile file(path);
    const LogSummary summary = summarize_log(AutopilotLog(file.bytes(), path.string()));
    CHECK(summary.implausible_times == 0);
    for (const auto& message : summary.types) {
      INFO(message.name);
      CHECK(message.count == recorded.at("counts").at(message.name).get<std::size_t>());
      if (!message.first_time || message.fields.front().substr(0, 4) != "Time") continue;
      const double unit = message.fields.front() == "TimeUS" ? 1e6 : 1e3;
      CHECK(*message.first_time ==
            recorded.at("time_range").at(message.name).at(0).get<double>() / unit);
      CHECK(*message.last_time ==
            recorded.at("time_range").at(message.name).at(1).get<double>() / unit);
    }
  }
}

TEST_CASE("every log with an estimator gives a flight log of as many samples as it has messages") {
  const auto logs = reference_logs();
  if (skip_without(logs)) return;
  const std::map<std::string, std::string> estimators = {{"beastyag_sample", "NKF1"},
                                                         {"erle_loiter_rtl", "EKF1"},
                                                         {"lacondro_v463_log0", "XKF1[C=0]"},
                                                         {"pymavlink_test", "NKF1"},
                                                         {"sitl_delorean_00000116", "XKF1[C=0]"}};
  for (const auto& [path, recorded] : logs) {
    const auto estimator = estimators.find(path.stem().string());
    if (estimator == estimators.end()) continue;
    INFO(path.filename().string());
    const FlightLogReading reading = read_flight_log(path);
    CHECK(reading.samples_out_of_order == 0);
    CHECK(reading.samples_implausible == 0);
    CHECK(reading.source.substr(0, 4) == estimator->second.substr(0, 4));
    const auto& columns = recorded.at("columns").at(estimator->second);
    CHECK(reading.log.time.size() == columns.at("VN").at("n").get<std::size_t>());
    check_statistics(statistics_of(reading.log.north_velocity), columns.at("VN"));
    check_statistics(statistics_of(reading.log.east_velocity), columns.at("VE"));
    check_statistics(statistics_of(reading.log.down_velocity), columns.at("VD"));
    const auto pitch = statistics_of(reading.log.pitch);
    CHECK(pitch.minimum == columns.at("Pitch").at("min").get<double>() * unit::degree);
    CHECK(pitch.maximum == columns.at("Pitch").at("max").get<double>() * unit::degree);
  }
}

TEST_CASE("the published flight is the same from DataFlash and from CSV") {
  const fs::path binary = reference_data / "data" / "x500-flight.bin";
  if (!fs::exists(binary)) {
    std::cout << "SKIPPED: no " << binary << '\n';
    return;
  }
  const FlightLog from_log = read_flight_log(binary).log;
  const FlightLog from_csv = read_flight_log(reference_data / "data" / "x500-flight.csv").log;
  // Time in µs and angles in hundredths of a degree are written out in full.
  CHECK(from_log.time == from_csv.time);
  CHECK(from_log.roll == from_csv.roll);
  CHECK(from_log.pitch == from_csv.pitch);
  CHECK(from_log.yaw == from_csv.yaw);
  // Velocities are written with seven digits, so below 100 m/s within 5e-6 m/s.
  const auto close = [](const std::vector<double>& a, const std::vector<double>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](double x, double y) { return std::abs(x - y) <= 5e-6; });
  };
  CHECK(close(from_log.north_velocity, from_csv.north_velocity));
  CHECK(close(from_log.east_velocity, from_csv.east_velocity));
  CHECK(close(from_log.down_velocity, from_csv.down_velocity));
}
