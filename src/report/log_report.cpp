#include "tethercalc/report/log_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "io/closest_name.hpp"
#include "report/characters.hpp"
#include "report/result_values.hpp"
#include "tethercalc/io/input_error.hpp"

namespace tethercalc {
namespace {

std::string messages_text(std::size_t count) {
  return fmt::format("{} message{}", count, count == 1 ? "" : "s");
}

std::string skipped_text(const LogSummary& summary) {
  if (summary.skipped_bytes == 0) return "nothing skipped";
  return fmt::format("{} bytes skipped, with at least {}", summary.skipped_bytes,
                     messages_text(summary.skipped_messages));
}

std::string time_text(const LogSummary& summary) {
  if (!summary.first_time) return "no message carries a time\n";
  std::string text =
      fmt::format("time       {:.3f} s to {:.3f} s, {:.3f} s long\n", *summary.first_time,
                  *summary.last_time, *summary.last_time - *summary.first_time);
  text += summary.gap_count == 0 ? "gaps       none over 1 s\n"
                                 : fmt::format("gaps       {} over 1 s:\n", summary.gap_count);
  constexpr std::size_t most_shown = 10;
  for (std::size_t i = 0; i < summary.gaps.size() && i < most_shown; ++i) {
    text += fmt::format("             {:.3f} s after {:.3f} s\n", summary.gaps[i].duration,
                        summary.gaps[i].start);
  }
  if (summary.gap_count > most_shown) {
    text += fmt::format("             and {} more\n", summary.gap_count - most_shown);
  }
  return text;
}

std::string damage_text(const LogSummary& summary) {
  std::string text;
  constexpr std::size_t most_shown = 10;
  for (std::size_t i = 0; i < summary.skipped.size() && i < most_shown; ++i) {
    const SkippedBytes& lost = summary.skipped[i];
    text += fmt::format("skipped    {} bytes at byte {}, at least {}\n", lost.bytes, lost.offset,
                        messages_text(lost.messages));
  }
  if (summary.skipped.size() > most_shown) text += "skipped    and more, further on\n";
  if (summary.implausible_times > 0) {
    text += fmt::format("note       {} messages have a time that was not believed\n",
                        summary.implausible_times);
  }
  for (const std::string& sentence : summary.rejected_definitions) {
    text += "note       " + sentence + "\n";
  }
  return text;
}

std::string cell(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : "";
}

std::vector<std::string> printable_all(std::vector<std::string> texts) {
  for (std::string& text : texts) text = printable(text);
  return texts;
}

ordered_json message_json(const LogSummary::Message& message) {
  return {{"name", printable(message.name)},
          {"count", message.count},
          {"rate_Hz", number_or_null(message.rate)},
          {"first_s", number_or_null(message.first_time)},
          {"last_s", number_or_null(message.last_time)},
          {"longest_gap_s", number_or_null(message.longest_gap)},
          {"instances", message.instances},
          {"fields", printable_all(message.fields)},
          {"units", printable_all(message.units)}};
}

std::string in_order(std::vector<std::string> names) {
  std::ranges::sort(names);
  for (std::string& name : names) name = printable(name);
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

[[noreturn]] void fail_without(std::string_view message, const AutopilotLog& log) {
  std::vector<std::string> names;
  for (const auto& type : log.contents().types) {
    const bool is_new = std::ranges::find(names, type.type.name) == names.end();
    if (type.count > 0 && is_new) names.push_back(type.type.name);
  }
  const std::string meant = did_you_mean(message, names);
  throw InputError(log.name(),
                   fmt::format("the log holds no message {}{}", message,
                               meant.empty() ? "; it holds " + in_order(names) : meant));
}

constexpr std::size_t most_listed = 10;

std::string flights_text(const LogSummary& summary) {
  if (!summary.flying) {
    return "flying     not known: neither take-off events nor velocities in the log\n";
  }
  const LogSummary::Flying& flying = *summary.flying;
  std::string text =
      fmt::format("flying     {:.1f} s ({})\n", flying.duration, flying.determined_by);
  if (flying.flights.size() < 2) return text;
  for (std::size_t i = 0; i < std::min(flying.flights.size(), most_listed); ++i) {
    const LogSummary::Flight& flight = flying.flights[i];
    text += fmt::format("             flight {}: {:.1f} s to {:.1f} s, {:.1f} s\n", i + 1,
                        flight.start, flight.end, flight.end - flight.start);
  }
  if (flying.flights.size() > most_listed) {
    text += fmt::format("             and {} more\n", flying.flights.size() - most_listed);
  }
  return text;
}

constexpr double joule_per_Wh = 3600;

std::string battery_text(const LogSummary::Battery& battery) {
  std::string text =
      fmt::format("battery    {}{}: {:.2f} V to {:.2f} V, mean {:.2f} V", battery.message,
                  battery.instance ? fmt::format(" {}", *battery.instance) : "",
                  battery.least_voltage, battery.greatest_voltage, battery.mean_voltage);
  if (!battery.mean_current) return text + "; no current\n";
  // An ammeter off zero reads a little less than nothing.
  return text + fmt::format("; mean {} A, at most {} A; {} Wh\n", fixed(*battery.mean_current, 2),
                            fixed(*battery.greatest_current, 2),
                            fixed(*battery.energy / joule_per_Wh, 2));
}

std::string findings_text(const LogSummary& summary) {
  std::string text;
  for (const LogSummary::Battery& battery : summary.batteries) text += battery_text(battery);
  if (summary.batteries.empty()) text += "battery    no voltage in the log\n";
  if (summary.wind) {
    text += fmt::format("wind       {:.1f} m/s from {:.0f}° (mean of the estimator's guess, {})\n",
                        summary.wind->mean_speed, summary.wind->from_deg, summary.wind->message);
  }
  for (const LogSummary::Use& use : summary.uses) {
    text += fmt::format("{}: {}, {}\n", use.command, use.possible ? "yes" : "no",
                        printable(use.because));
  }
  return text;
}

std::string dropouts_text(const LogSummary& summary) {
  if (summary.dropouts.empty()) return "";
  double total = 0;
  for (const auto& dropout : summary.dropouts) total += dropout.duration;
  return fmt::format("dropouts   {}, {:.3f} s in all, in which the controller could not write\n",
                     summary.dropouts.size(), total);
}

std::string_view format_name(LogFormat format) {
  switch (format) {
    case LogFormat::dataflash:
      return "dataflash";
    case LogFormat::dataflash_text:
      return "dataflash_text";
    case LogFormat::ulog:
      break;
  }
  return "ulog";
}

std::string_view format_title(LogFormat format) {
  switch (format) {
    case LogFormat::dataflash:
      return "ArduPilot DataFlash";
    case LogFormat::dataflash_text:
      return "ArduPilot DataFlash as text";
    case LogFormat::ulog:
      break;
  }
  return "PX4 ULog";
}

ordered_json logged_battery_json(const LogSummary::Battery& battery) {
  ordered_json report = {{"message", battery.message},
                         {"instance", nullptr},
                         {"samples", battery.samples},
                         {"voltage_V",
                          {{"least", battery.least_voltage},
                           {"mean", battery.mean_voltage},
                           {"greatest", battery.greatest_voltage}}},
                         {"current_A", nullptr},
                         {"energy_Wh", nullptr}};
  if (battery.instance) report["instance"] = *battery.instance;
  if (battery.mean_current) {
    report["current_A"] = {{"mean", *battery.mean_current},
                           {"greatest", *battery.greatest_current}};
    report["energy_Wh"] = *battery.energy / joule_per_Wh;
  }
  return report;
}

}  // namespace

std::string log_text(const LogSummary& summary, std::string_view name, const TextStyle& style) {
  std::string text = fmt::format("{}: {} bytes, {} messages, {}\n", style.bold(std::string(name)),
                                 summary.bytes, summary.messages, skipped_text(summary));
  text += fmt::format("format     {}\n", format_title(summary.format));
  if (!summary.vehicle.empty()) text += "vehicle    " + summary.vehicle + "\n";
  if (!summary.firmware.empty()) text += "firmware   " + printable(summary.firmware) + "\n";
  text += time_text(summary);
  text += flights_text(summary);
  text += findings_text(summary);
  text += dropouts_text(summary);
  text += damage_text(summary);
  TextTable table(
      {word_column("message"), "count", "rate Hz", "first s", "last s", "longest gap s"});
  for (const LogSummary::Message& message : summary.types) {
    table.add({printable(message.name), std::to_string(message.count), cell(message.rate, 2),
               cell(message.first_time, 3), cell(message.last_time, 3),
               cell(message.longest_gap, 3)});
  }
  text += '\n' + table.text(style);
  return text;
}

std::string log_csv(const LogSummary& summary) {
  std::string text = "name,count,rate_Hz,first_s,last_s,longest_gap_s\n";
  for (const LogSummary::Message& message : summary.types) {
    text += fmt::format("{},{},{},{},{},{}\n", message.name, message.count, cell(message.rate, 6),
                        cell(message.first_time, 6), cell(message.last_time, 6),
                        cell(message.longest_gap, 6));
  }
  return text;
}

ordered_json log_json(const LogSummary& summary, std::string_view name) {
  const ordered_json gaps = json_list(summary.gaps, [](const LogSummary::Gap& gap) {
    return ordered_json{{"start_s", gap.start}, {"duration_s", gap.duration}};
  });
  const ordered_json stretches = json_list(summary.skipped, [](const SkippedBytes& lost) {
    return ordered_json{
        {"offset", lost.offset}, {"bytes", lost.bytes}, {"messages", lost.messages}};
  });
  const ordered_json dropouts =
      json_list(summary.dropouts, [](const LogContents::Dropout& dropout) {
        return ordered_json{{"after_s", dropout.time}, {"duration_s", dropout.duration}};
      });
  const ordered_json uses = json_list(summary.uses, [](const LogSummary::Use& use) {
    return ordered_json{
        {"command", use.command}, {"possible", use.possible}, {"because", printable(use.because)}};
  });
  ordered_json report = {{"file", name},
                         {"format", format_name(summary.format)},
                         {"bytes", summary.bytes},
                         {"messages", summary.messages},
                         {"firmware", printable(summary.firmware)},
                         {"vehicle", nullptr},
                         {"first_s", number_or_null(summary.first_time)},
                         {"last_s", number_or_null(summary.last_time)},
                         {"duration_s", nullptr},
                         {"flying", nullptr},
                         {"batteries", json_list(summary.batteries, logged_battery_json)},
                         {"wind", nullptr},
                         {"uses", uses},
                         {"gaps", gaps},
                         {"gap_count", summary.gap_count},
                         {"dropouts", dropouts},
                         {"implausible_times", summary.implausible_times},
                         {"skipped",
                          {{"bytes", summary.skipped_bytes},
                           {"messages", summary.skipped_messages},
                           {"stretches", stretches}}},
                         {"rejected_definitions", summary.rejected_definitions},
                         {"types", json_list(summary.types, message_json)}};
  if (summary.first_time) report["duration_s"] = *summary.last_time - *summary.first_time;
  if (summary.flying) {
    report["flying"] = {
        {"duration_s", summary.flying->duration},
        {"determined_by", summary.flying->determined_by},
        {"flights", json_list(summary.flying->flights, [](const LogSummary::Flight& flight) {
           return ordered_json{{"start_s", flight.start}, {"end_s", flight.end}};
         })}};
  }
  if (!summary.vehicle.empty()) report["vehicle"] = summary.vehicle;
  if (summary.wind) {
    report["wind"] = {{"message", summary.wind->message},
                      {"speed_m_s", summary.wind->mean_speed},
                      {"from_deg", summary.wind->from_deg}};
  }
  return report;
}

void messages_csv(const AutopilotLog& log, std::string_view message,
                  const std::function<void(std::string_view line)>& put) {
  const LogContents& contents = log.contents();
  if (contents.count(message) == 0) fail_without(message, log);
  // Copied: the types that for_each() hands out are others, of the same names.
  const LogMessageType header = *contents.find(message);
  const bool several = log.format() == LogFormat::ulog && log.instances(message).size() > 1;
  std::string line = several ? "instance" : "";
  for (const LogField& field : header.fields) {
    line += (line.empty() ? "" : ",") + csv_text(field.name);
  }
  put(line += '\n');
  log.for_each([&](const LogMessageType& type, const std::byte* bytes) {
    if (type.name != message) return;
    line = several ? std::to_string(type.instance.value_or(0)) : "";
    for (const LogField& column : header.fields) {
      if (several || &column != &header.fields.front()) line += ',';
      // By name, because a log behind another in one file may define the message anew.
      const LogField* const field = type.find(column.name);
      if (field == nullptr) continue;
      const bool none = field->is_number() && !std::isfinite(field_value(bytes, *field));
      if (!none) line += csv_text(field_text(bytes, *field));
    }
    put(line += '\n');
  });
}

}  // namespace tethercalc
