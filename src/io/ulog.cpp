#include "io/ulog.hpp"

#include <fmt/format.h>

#include <unordered_map>

#include "io/log_columns.hpp"
#include "io/ulog_walk.hpp"

namespace tethercalc {
namespace {

using ULogVisitor = std::function<void(const LogMessageType&, const std::byte*)>;

/// The firmware's words as messages with fields.
const LogMessageType& words_type(char letter) {
  // Behind the header: level, tag in C messages, time, words.
  static const LogMessageType logging{
      "logging", {{"timestamp", 'Q', 4, 8}, {"level", 't', 3, 1}, {"message", 'T', 12}}, {}, {}};
  static const LogMessageType tagged{
      "logging_tagged",
      {{"timestamp", 'Q', 6, 8}, {"level", 't', 3, 1}, {"tag", 'H', 4, 2}, {"message", 'T', 14}},
      {},
      {}};
  return letter == 'L' ? logging : tagged;
}

/// What a message is an example of; nullptr where it holds no fields.
const LogMessageType* type_of(char letter, const std::byte* message,
                              const ulog::Definitions& known) {
  if (letter == 'D') {
    return known.type(log_bytes::read<std::uint16_t>(message + ulog::header_size));
  }
  return letter == 'L' || letter == 'C' ? &words_type(letter) : nullptr;
}

template <class T>
double stored_number(const std::byte* at) {
  return static_cast<double>(log_bytes::read<T>(at));
}

/// A value as text: characters as they are, numbers in full, arrays of them separated by blanks.
std::string text_of(const ulog::KeyAndValue& information) {
  const ulog::TypeText& type = information.type;
  if (type.name == "char") return std::string(log_bytes::text_at(information.value, type.count));
  static const std::map<std::string_view, char> kinds = {
      {"int8_t", 'b'},  {"uint8_t", 'B'},  {"int16_t", 'h'}, {"uint16_t", 'H'},
      {"int32_t", 'i'}, {"uint32_t", 'I'}, {"int64_t", 'q'}, {"uint64_t", 'Q'},
      {"float", 'f'},   {"double", 'd'},   {"bool", 'b'}};
  std::string text;
  const std::size_t size = ulog::size_of_basic(type.name);
  for (std::size_t i = 0; i < type.count; ++i) {
    if (i > 0) text += ' ';
    text += field_text(information.value, {"", kinds.at(type.name), i * size, size});
  }
  return text;
}

class ULogContentsTaker {
 public:
  explicit ULogContentsTaker(std::span<const std::byte> log) { contents.bytes = log.size(); }

  void on_message(char letter, const std::byte* message, std::size_t,
                  const ulog::Definitions& known) {
    ++contents.messages;
    if (letter == 'A') count_of(known.type(log_bytes::read<std::uint16_t>(message + 4)));
    if (letter == 'I') take_information(message);
    if (letter == 'M') take_multiple(message);
    if (letter == 'P') take_parameter(message);
    if (letter == 'O') take_dropout(message);
    if (letter == 'L' || letter == 'C') take_words(letter, message);
    if (const LogMessageType* const type = type_of(letter, message, known)) {
      Counted& counted = count_of(type);
      ++contents.types[counted.index].count;
      if (counted.time) last_time_ = field_value(message, counted.time->field) / 1e6;
    }
  }
  void on_rejected(std::string sentence) { contents.add_rejected(std::move(sentence)); }
  void on_skipped(const SkippedBytes& lost) { contents.add(lost); }

  LogContents contents;

 private:
  struct Counted {
    std::size_t index = 0;
    std::optional<LogTime> time;
  };

  Counted& count_of(const LogMessageType* type) {
    static Counted none;
    if (type == nullptr) return none;
    if (type == last_type_) return *last_counted_;
    const auto [entry, is_new] = counted_.try_emplace(type);
    if (is_new) {
      auto& types = contents.types;
      const auto same = std::ranges::find_if(types, [type](const LogContents::Type& other) {
        return other.type.name == type->name && other.type.instance == type->instance;
      });
      entry->second = {static_cast<std::size_t>(same - types.begin()), time_of(*type)};
      if (same == types.end()) types.push_back({*type, 0});
    }
    last_type_ = type;
    last_counted_ = &entry->second;
    return entry->second;
  }

  void take_information(const std::byte* message) {
    const auto information = ulog::key_and_value(message, ulog::header_size);
    if (information) contents.information[std::string(information->key)] = text_of(*information);
  }
  /// Parts of one text are put together; of several texts under one key the first is kept.
  void take_multiple(const std::byte* message) {
    const auto information = ulog::key_and_value(message, ulog::header_size + 1);
    if (!information || information->type.name != "char") return;
    const bool continued = ulog::byte_at(message + ulog::header_size) != 0;
    std::string key(information->key);
    const bool is_first = contents.information.try_emplace(key).second;
    if (is_first) open_ = key;
    if (!is_first && !(continued && open_ == key)) open_.clear();
    if (open_ == key) contents.information[key] += text_of(*information);
  }
  void take_parameter(const std::byte* message) {
    const auto parameter = ulog::key_and_value(message, ulog::header_size);
    if (!parameter) return;
    const double value = parameter->type.name == "float"
                             ? stored_number<float>(parameter->value)
                             : stored_number<std::int32_t>(parameter->value);
    contents.parameters.try_emplace(std::string(parameter->key), value);
  }
  void take_words(char letter, const std::byte* message) {
    if (contents.words.size() >= LogContents::most_words) return;
    contents.words.push_back(field_text(message, *words_type(letter).find("message")));
  }
  void take_dropout(const std::byte* message) {
    const double milliseconds = stored_number<std::uint16_t>(message + ulog::header_size);
    contents.dropouts.push_back({last_time_, milliseconds / 1000});
  }

  std::unordered_map<const LogMessageType*, Counted> counted_;
  const LogMessageType* last_type_ = nullptr;
  Counted* last_counted_ = nullptr;
  std::string open_;  // the key whose text goes on
  double last_time_ = 0;
};

/// A visitor of messages that have fields, or of all, that does not mind damage.
template <class Act>
class ULogMessages {
 public:
  explicit ULogMessages(Act act) : act_(std::move(act)) {}
  void on_message(char letter, const std::byte* message, std::size_t length,
                  const ulog::Definitions& known) {
    act_(letter, message, length, known);
  }
  void on_rejected(const std::string&) {}
  void on_skipped(const SkippedBytes&) {}

 private:
  Act act_;
};

std::optional<WantedFields> wanted_from_topic(const LogMessageType& type, std::string_view message,
                                              std::span<const std::string> fields,
                                              std::optional<int> instance) {
  if (type.name != message || (instance && type.instance && type.instance != instance)) {
    return std::nullopt;
  }
  WantedFields wanted;
  for (const std::string& name : fields) {
    const LogField* const field = type.find_number(name);
    if (field == nullptr) return std::nullopt;
    wanted.fields.push_back(*field);
  }
  return wanted;
}

/// What to take from the types of a log, each asked once.
class WantedTypes {
 public:
  WantedTypes(std::string_view message, std::span<const std::string> fields,
              std::optional<int> instance)
      : message_(message), fields_(fields), instance_(instance) {}
  const WantedFields* of(const LogMessageType* type) {
    if (type == nullptr) return nullptr;
    const auto [entry, is_new] = known_.try_emplace(type);
    if (is_new) {
      if (auto wanted = wanted_from_topic(*type, message_, fields_, instance_)) {
        entry->second = &kept_.emplace_back(std::move(*wanted));
      }
    }
    return entry->second;
  }

 private:
  std::string_view message_;
  std::span<const std::string> fields_;
  std::optional<int> instance_;
  std::unordered_map<const LogMessageType*, const WantedFields*> known_;
  std::deque<WantedFields> kept_;
};

}  // namespace

bool looks_like_ulog(std::span<const std::byte> content) {
  constexpr std::array<std::uint8_t, 7> magic = {'U', 'L', 'o', 'g', 0x01, 0x12, 0x35};
  constexpr std::size_t most_damaged = 2;
  if (content.size() < magic.size()) return false;
  std::size_t damaged = 0;
  for (std::size_t i = 0; i < magic.size(); ++i) {
    damaged += ulog::byte_at(content.data() + i) == magic[i] ? 0 : 1;
  }
  return damaged <= most_damaged;
}

bool needs_newer_ulog_reader(std::span<const std::byte> log) {
  constexpr std::size_t incompatible_at = ulog::file_header_size + ulog::header_size + 8;
  constexpr std::size_t flags = 8;
  constexpr std::uint8_t appended_data = 1;
  if (log.size() < incompatible_at + flags) return false;
  const std::byte* const first = log.data() + ulog::file_header_size;
  if (ulog::letter_of(first) != 'B' || ulog::length_of(first) < ulog::flags_size) return false;
  bool any = (ulog::byte_at(log.data() + incompatible_at) & ~appended_data) != 0;
  for (std::size_t i = 1; i < flags; ++i) {
    any = any || ulog::byte_at(log.data() + incompatible_at + i) != 0;
  }
  return any;
}

LogContents scan_ulog(std::span<const std::byte> log) {
  ULogContentsTaker taker(log);
  ulog::walk(log, taker);
  return std::move(taker.contents);
}

void for_each_raw_ulog_message(
    std::span<const std::byte> log,
    const std::function<void(char, const std::byte*, std::size_t)>& visit) {
  ULogMessages visitor{[&](char letter, const std::byte* message, std::size_t length,
                           const ulog::Definitions&) { visit(letter, message, length); }};
  ulog::walk(log, visitor);
}

void for_each_ulog_message(std::span<const std::byte> log, const ULogVisitor& visit) {
  ULogMessages visitor{
      [&](char letter, const std::byte* message, std::size_t, const ulog::Definitions& known) {
        if (const LogMessageType* const type = type_of(letter, message, known)) {
          visit(*type, message);
        }
      }};
  ulog::walk(log, visitor);
}

std::vector<std::vector<double>> extract_ulog_columns(std::span<const std::byte> log,
                                                      std::string_view message,
                                                      std::span<const std::string> fields,
                                                      std::optional<int> instance) {
  WantedTypes types(message, fields, instance);
  std::vector<std::pair<const WantedFields*, const std::byte*>> found;
  // By number rather than by type: asked for every message.
  std::vector<std::pair<const LogMessageType*, const WantedFields*>> by_number;
  ULogMessages visitor{
      [&](char letter, const std::byte* at, std::size_t, const ulog::Definitions& known) {
        if (letter != 'D') {
          if (const WantedFields* const wanted = types.of(type_of(letter, at, known))) {
            found.emplace_back(wanted, at);
          }
          return;
        }
        const std::size_t number = log_bytes::read<std::uint16_t>(at + ulog::header_size);
        if (number >= by_number.size()) by_number.resize(number + 1);
        auto& [type, wanted] = by_number[number];
        if (const LogMessageType* const now = known.type(number); now != type) {
          type = now;
          wanted = types.of(now);
        }
        if (wanted != nullptr) found.emplace_back(wanted, at);
      }};
  ulog::walk(log, visitor);
  ColumnFiller columns(fields.size(), found.size());
  for (const auto& [wanted, at] : found) columns.add(*wanted, at);
  return columns.finish();
}

}  // namespace tethercalc
