#include "tethercalc/report/log_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <ostream>
#include <vector>

#include "io/closest_name.hpp"
#include "report/characters.hpp"
#include "report/result_values.hpp"
#include "tethercalc/io/dataflash.hpp"
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

ordered_json message_json(const LogSummary::Message& message) {
  return {{"name", message.name},
          {"count", message.count},
          {"rate_Hz", number_or_null(message.rate)},
          {"first_s", number_or_null(message.first_time)},
          {"last_s", number_or_null(message.last_time)},
          {"longest_gap_s", number_or_null(message.longest_gap)},
          {"fields", message.fields}};
}

std::string in_order(std::vector<std::string> names) {
  std::ranges::sort(names);
  for (std::string& name : names) name = printable(name);
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

[[noreturn]] void fail_without(std::string_view message, std::string_view name,
                               const DataFlashContents& contents) {
  std::vector<std::string> names;
  for (const auto& type : contents.types) {
    if (type.count > 0) names.push_back(type.format.name);
  }
  const std::string meant = did_you_mean(message, names);
  throw InputError(std::string(name),
                   fmt::format("the log holds no message {}{}", message,
                               meant.empty() ? "; it holds " + in_order(names) : meant));
}

}  // namespace

std::string log_text(const LogSummary& summary, std::string_view name, const TextStyle& style) {
  std::string text = fmt::format("{}: {} bytes, {} messages, {}\n", style.bold(std::string(name)),
                                 summary.bytes, summary.messages, skipped_text(summary));
  if (!summary.firmware.empty()) text += "firmware   " + printable(summary.firmware) + "\n";
  text += time_text(summary);
  if (summary.flying) {
    text += fmt::format("flying     {:.1f} s ({})\n", summary.flying->duration,
                        summary.flying->determined_by);
  } else {
    text += "flying     not known: neither take-off events nor velocities in the log\n";
  }
  text += damage_text(summary);
  TextTable table(
      {word_column("message"), "count", "rate Hz", "first s", "last s", "longest gap s"});
  for (const LogSummary::Message& message : summary.types) {
    table.add({message.name, std::to_string(message.count), cell(message.rate, 2),
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
  ordered_json report = {{"file", name},
                         {"bytes", summary.bytes},
                         {"messages", summary.messages},
                         {"firmware", printable(summary.firmware)},
                         {"first_s", number_or_null(summary.first_time)},
                         {"last_s", number_or_null(summary.last_time)},
                         {"duration_s", nullptr},
                         {"flying", nullptr},
                         {"gaps", gaps},
                         {"gap_count", summary.gap_count},
                         {"implausible_times", summary.implausible_times},
                         {"skipped",
                          {{"bytes", summary.skipped_bytes},
                           {"messages", summary.skipped_messages},
                           {"stretches", stretches}}},
                         {"rejected_definitions", summary.rejected_definitions},
                         {"types", json_list(summary.types, message_json)}};
  if (summary.first_time) report["duration_s"] = *summary.last_time - *summary.first_time;
  if (summary.flying) {
    report["flying"] = {{"duration_s", summary.flying->duration},
                        {"determined_by", summary.flying->determined_by}};
  }
  return report;
}

void write_messages_csv(std::span<const std::byte> log, std::string_view message,
                        std::string_view name, std::ostream& out) {
  const DataFlashContents contents = scan_dataflash(log);
  if (contents.count(message) == 0) fail_without(message, name, contents);
  const DataFlashFormat& header = *contents.find(message);
  std::string line;
  for (const DataFlashField& field : header.fields) {
    line += (line.empty() ? "" : ",") + csv_text(field.name);
  }
  out << line << '\n';
  for_each_message(log, [&](const DataFlashFormat& format, const std::byte* bytes) {
    if (format.name != message) return;
    line.clear();
    for (const DataFlashField& column : header.fields) {
      if (&column != &header.fields.front()) line += ',';
      // By name, because a log behind another in one file may define the message anew.
      const DataFlashField* const field = format.find(column.name);
      if (field == nullptr) continue;
      const bool none = field->is_number() && !std::isfinite(field_value(bytes, *field));
      if (!none) line += csv_text(field_text(bytes, *field));
    }
    out << line << '\n';
  });
}

}  // namespace tethercalc
