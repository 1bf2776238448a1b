// Any bytes as a power log or a flight log in CSV, from the reader to the words, the JSON and the
// figure of its diagnosis: each answers or refuses, and no number in an answer is infinite or none.
//
// The first byte chooses the kind of log. Logs are kept short: a diagnosis of minutes takes
// seconds.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/log_readers.hpp"
#include "tethercalc/io/spec_writer.hpp"
#include "tethercalc/report/diagnosis_report.hpp"
#include "tethercalc/report/result_figures.hpp"
#include "tethercalc/study/diagnosis.hpp"

namespace {

using namespace tethercalc;

constexpr std::size_t longest = 400;  // samples

void require(bool holds) {
  if (!holds) std::abort();
}

DesignFile start() {
  DesignFile file = parse_design(starting_spec(), "start.json");
  file.design.tether.cross_section = 1.1e-6;
  return file;
}

void tell(const DesignFile& file, const Diagnosis& diagnosis, const Design& extended) {
  require(!diagnosis_text(diagnosis, {}).empty());
  const nlohmann::ordered_json answer = diagnosis_json(diagnosis, spec_with(file, extended));
  require(nlohmann::ordered_json::parse(answer.dump()) == answer);
  (void)diagnosis_csv(diagnosis.findings);
  if (diagnosis.compared.empty()) return;
  const Figure figure = diagnosis_figure("log", diagnosis);
  require(!figure.title.empty() && !figure.description.empty());
}

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

void diagnose_power(const DesignFile& file, std::string_view text) {
  PowerLog log = parse_power_log(bytes_of(text), "power.csv").log;
  if (log.time.size() > longest) return;
  DiagnosisQuestion question{file.design};
  question.power = LoggedPower{std::move(log)};
  const DiagnosisStudy study = study_diagnosis(question);
  tell(file, study.power.value(), study.extended);
}

void diagnose_flight(const DesignFile& file, std::string_view text) {
  FlightLog log = parse_flight_log(bytes_of(text), "flight.csv").log;
  if (log.time.size() > longest) return;
  DiagnosisQuestion question{file.design};
  question.flight.emplace();
  question.flight->flights.push_back({std::move(log), {}});
  const DiagnosisStudy study = study_diagnosis(question);
  tell(file, study.flight.value(), study.extended);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const DesignFile file = start();
  if (size < 1) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    if (data[0] == 'f') {
      diagnose_flight(file, text);
    } else {
      diagnose_power(file, text);
    }
  } catch (const InputError& error) {
    require(!error.problems().empty());
  } catch (const UnsuitableLog& error) {
    require(*error.what() != '\0');
  }
  return 0;
}
