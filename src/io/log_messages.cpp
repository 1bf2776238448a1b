#include "tethercalc/io/log_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "io/log_columns.hpp"

namespace tethercalc {
namespace {

constexpr std::size_t most_told = 100;  // stretches skipped, and definitions rejected
constexpr std::size_t numbers_in_a = 32;

}  // namespace

double field_value(const std::byte* message, const LogField& field) {
  double value = std::nan("");
  Numbers::use(field.kind, [&](auto number_at) { value = number_at(message + field.offset); });
  return value;
}

bool LogField::is_number() const {
  bool found = false;
  Numbers::use(kind, [&](auto) { found = true; });
  return found;
}

const LogField* LogMessageType::find(std::string_view field_name) const {
  const auto found = std::ranges::find(fields, field_name, &LogField::name);
  return found == fields.end() ? nullptr : &*found;
}

const LogField* LogMessageType::find_number(std::string_view field_name) const {
  const LogField* const found = find(field_name);
  return found != nullptr && found->is_number() ? found : nullptr;
}

std::string field_text(const std::byte* message, const LogField& field) {
  const std::byte* const at = message + field.offset;
  switch (field.kind) {
    case 'n':
    case 'N':
    case 'Z':
    case 't':
      return std::string(log_bytes::text_at(at, field.size));
    case 'T': {
      constexpr std::size_t header = 3;
      const std::size_t length = header + log_bytes::read<std::uint16_t>(message);
      return std::string(log_bytes::text_at(at, length - field.offset));
    }
    case 'a': {
      std::string numbers;
      for (std::size_t i = 0; i < numbers_in_a; ++i) {
        if (i > 0) numbers += ' ';
        numbers += std::to_string(log_bytes::read<std::int16_t>(at + i * sizeof(std::int16_t)));
      }
      return numbers;
    }
    case 'q':
      return fmt::format("{}", log_bytes::read<std::int64_t>(at));
    case 'Q':
      return fmt::format("{}", log_bytes::read<std::uint64_t>(at));
    case 'f':
      return fmt::format("{}", log_bytes::read<float>(at));
    default:
      return fmt::format("{}", field_value(message, field));
  }
}

std::optional<LogTime> time_of(const LogMessageType& type) {
  if (!type.fields.empty() && type.fields.front().is_number()) {
    if (type.fields.front().name == "TimeUS") return LogTime{type.fields.front(), 1e6};
    if (type.fields.front().name == "TimeMS") return LogTime{type.fields.front(), 1e3};
  }
  const LogField* const timestamp = type.find_number("timestamp");
  if (timestamp != nullptr && timestamp->kind == 'Q') return LogTime{*timestamp, 1e6};
  const LogField* const since_start = type.find_number("T");
  const bool older_gps = type.name.starts_with("GPS") && type.find("TimeMS") != nullptr;
  if (!older_gps || since_start == nullptr) return std::nullopt;
  return LogTime{*since_start, 1e3};
}

void LogTotals::add(const SkippedBytes& lost) {
  skipped_bytes += lost.bytes;
  skipped_messages += lost.messages;
  if (skipped.size() < most_told) skipped.push_back(lost);
}

void LogTotals::add_rejected(std::string sentence) {
  if (rejected_definitions.size() < most_told) rejected_definitions.push_back(std::move(sentence));
}

}  // namespace tethercalc
