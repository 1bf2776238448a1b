// Real ULog files, compared with what the reference reader (pyulog) recorded of them.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "files/input_files.hpp"
#include "tethercalc/io/autopilot_log.hpp"

using namespace tethercalc;
namespace fs = std::filesystem;

namespace {

const fs::path folder = fs::path(TETHERCALC_REFERENCE_DATA) / "data" / "ulog";

std::vector<std::pair<fs::path, nlohmann::json>> reference_ulogs() {
  std::vector<std::pair<fs::path, nlohmann::json>> logs;
  if (!fs::exists(folder)) return logs;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".ulg") continue;
    fs::path golden = entry.path();
    std::ifstream in(golden.replace_extension(".golden.json"));
    logs.emplace_back(entry.path(), nlohmann::json::parse(in));
  }
  return logs;
}

bool skip_without(const auto& logs) {
  if (logs.empty()) std::cout << "SKIPPED: no " << folder << '\n';
  return logs.empty();
}

struct Statistics {
  std::size_t finite = 0;
  double sum = 0;
  double minimum = HUGE_VAL;
  double maximum = -HUGE_VAL;
  double magnitude = 0;  // sum of absolute values, which rounding is measured by
};

Statistics statistics_of_field(const std::vector<double>& column) {
  Statistics found;
  for (const double value : column) {
    if (!std::isfinite(value)) continue;
    ++found.finite;
    found.sum += value;
    found.magnitude += std::abs(value);
    found.minimum = std::min(found.minimum, value);
    found.maximum = std::max(found.maximum, value);
  }
  return found;
}

/// "topic[2]" as name and instance.
std::pair<std::string, int> topic_of(const std::string& key) {
  const std::size_t bracket = key.rfind('[');
  return {key.substr(0, bracket), std::stoi(key.substr(bracket + 1))};
}

bool is_padding(const std::string& field) { return field.find("_padding") != std::string::npos; }

/// Characters of a text are one field here and one each in the reference.
bool is_character_of_text(const LogMessageType& type, const std::string& field) {
  const LogField* const text = type.find(field.substr(0, field.rfind('[')));
  return text != nullptr && !text->is_number();
}

}  // namespace

TEST_CASE("every topic and field of the reference ULogs has the recorded count, sum and range") {
  const auto logs = reference_ulogs();
  if (skip_without(logs)) return;
  std::size_t compared = 0;
  for (const auto& [path, golden] : logs) {
    INFO(path.filename().string());
    const MappedFile file(path);
    const AutopilotLog log(file.bytes(), path.string());
    CHECK(log.format() == LogFormat::ulog);
    CHECK(log.contents().skipped_bytes == 0);
    CHECK(log.contents().rejected_definitions.empty());
    std::set<std::string> topics;
    for (const auto& type : log.contents().types) {
      if (type.count == 0 || !type.type.instance) continue;
      topics.insert(type.type.name + "[" + std::to_string(*type.type.instance) + "]");
    }
    for (const auto& [key, topic] : golden.at("topics").items()) {
      INFO(key);
      CHECK(topics.erase(key) == 1);
      const auto [name, instance] = topic_of(key);
      std::vector<std::string> fields;
      for (const auto& field : topic.at("fields").items()) {
        const bool is_field = !is_padding(field.key()) &&
                              !is_character_of_text(*log.contents().find(name), field.key());
        if (is_field) fields.push_back(field.key());
      }
      const auto columns = log.columns(name, fields, instance);
      std::size_t own_fields = 0;
      for (const LogField& field : log.contents().find(name)->fields) {
        own_fields += field.is_number() ? 1 : 0;
      }
      CHECK(own_fields == fields.size());
      for (std::size_t i = 0; i < fields.size(); ++i) {
        INFO(fields[i]);
        const auto& recorded = topic.at("fields").at(fields[i]);
        REQUIRE(columns[i].size() == topic.at("n").get<std::size_t>());
        const Statistics found = statistics_of_field(columns[i]);
        CHECK(found.finite == recorded.at("finite").get<std::size_t>());
        if (found.finite == 0) continue;
        CHECK(found.minimum == recorded.at("min").get<double>());
        CHECK(found.maximum == recorded.at("max").get<double>());
        // Added up in another order.
        CHECK(std::abs(found.sum - recorded.at("sum").get<double>()) <= 1e-12 * found.magnitude);
        ++compared;
      }
    }
    CHECK(topics.empty());
  }
  CHECK(compared > 2000);
}

TEST_CASE("information, parameters and dropouts of the reference ULogs are the recorded ones") {
  const auto logs = reference_ulogs();
  if (skip_without(logs)) return;
  for (const auto& [path, golden] : logs) {
    INFO(path.filename().string());
    const MappedFile file(path);
    const LogContents contents = AutopilotLog(file.bytes(), path.string()).contents();
    for (const auto& [key, value] : golden.at("info").items()) {
      INFO(key);
      REQUIRE(contents.information.count(key) == 1);
      CHECK(contents.information.at(key) ==
            (value.is_string() ? value.get<std::string>() : value.dump()));
    }
    CHECK(contents.parameters.size() == golden.at("parameters").size());
    for (const auto& [name, value] : golden.at("parameters").items()) {
      INFO(name);
      REQUIRE(contents.parameters.count(name) == 1);
      CHECK(contents.parameters.at(name) == value.get<double>());
    }
    const auto& dropouts = golden.at("dropouts");
    REQUIRE(contents.dropouts.size() == dropouts.size());
    for (std::size_t i = 0; i < dropouts.size(); ++i) {
      // The reference gives the latest time so far, which in one log is one that leaps ahead.
      CHECK(contents.dropouts[i].time <= dropouts[i][0].get<double>() / 1e6);
      CHECK(contents.dropouts[i].time > 0);
      CHECK(contents.dropouts[i].duration == Approx(dropouts[i][1].get<double>() / 1e3));
    }
  }
}
