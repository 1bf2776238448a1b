#include "tethercalc/io/autopilot_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "io/dataflash_text.hpp"
#include "io/foreign_files.hpp"
#include "io/ulog.hpp"
#include "tethercalc/io/dataflash.hpp"
#include "tethercalc/io/input_error.hpp"

namespace tethercalc {
namespace {

constexpr std::size_t head_size = 4096;  // bytes that tell what a file is

/// What a log says of itself. Units: UNIT messages name them by a letter, FMTU messages give one
/// letter a field (ArduPilot, libraries/AP_Logger/LogStructure.h).
class Descriptions {
 public:
  explicit Descriptions(const DataFlashContents& scanned) : scanned_(scanned) {
    for (const auto& description : scanned.descriptions) {
      take(scanned.types[description.type].format, description.message);
    }
  }

  std::vector<std::string> words;
  std::map<std::string, double> parameters;

  void put_units(std::vector<LogContents::Type>& types) const {
    for (std::size_t i = 0; i < types.size(); ++i) {
      const auto letters = letters_.find(scanned_.types[i].format.type);
      if (letters != letters_.end()) put_units(types[i].type, letters->second);
    }
  }

 private:
  void take(const DataFlashFormat& format, const std::byte* message) {
    if (format.name == "MSG") {
      if (words.size() < LogContents::most_words) words.push_back(message_words(format, message));
      return;
    }
    const bool is_parameter = format.name == "PARM";
    const bool is_unit = format.name == "UNIT";
    const LogField* const number = format.find_number(is_parameter ? "Value"
                                                      : is_unit    ? "Id"
                                                                   : "FmtType");
    const LogField* const text = format.find(is_parameter ? "Name" : is_unit ? "Label" : "UnitIds");
    if (number == nullptr || text == nullptr || text->is_number()) return;
    const double value = field_value(message, *number);
    if (is_parameter) {
      parameters.try_emplace(field_text(message, *text), value);
    } else if (is_unit) {
      names_[static_cast<char>(value)] = field_text(message, *text);
    } else {
      letters_[static_cast<int>(value)] = field_text(message, *text);
    }
  }

  void put_units(LogMessageType& type, const std::string& letters) const {
    for (std::size_t i = 0; i < std::min(letters.size(), type.fields.size()); ++i) {
      LogField& field = type.fields[i];
      if (letters[i] == '#' && field.is_number()) type.instance_field = field.name;
      const auto name = names_.find(letters[i]);
      if (letters[i] != '#' && letters[i] != '-' && name != names_.end()) field.unit = name->second;
    }
  }

  const DataFlashContents& scanned_;
  std::map<char, std::string> names_;
  std::map<int, std::string> letters_;
};

LogContents dataflash_contents(std::span<const std::byte> log) {
  const DataFlashContents scanned = scan_dataflash(log);
  LogContents contents;
  static_cast<LogTotals&>(contents) = scanned;
  for (const auto& type : scanned.types) contents.types.push_back({type.format, type.count});
  Descriptions descriptions(scanned);
  descriptions.put_units(contents.types);
  contents.words = std::move(descriptions.words);
  contents.parameters = std::move(descriptions.parameters);
  return contents;
}

[[noreturn]] void fail_as_foreign(std::span<const std::byte> content, const std::string& name) {
  std::string kind = foreign_kind(content);
  if (kind.empty()) {
    kind = looks_like_text(content)
               ? "is a text, but not one of an autopilot's log"
               : fmt::format("is no log: no message of ArduPilot or PX4 was found in its {} bytes",
                             content.size());
    kind += "; expected ArduPilot's .bin or .log, or PX4's .ulg";
  }
  throw InputError(name, kind);
}

/// Whether any message but those that define others is defined. Random bytes are never that.
bool is_dataflash(const LogContents& contents) {
  return contents.messages > 0 &&
         std::ranges::any_of(contents.types, [](const auto& t) { return t.type.name != "FMT"; });
}

}  // namespace

std::size_t LogContents::count(std::string_view name) const {
  std::size_t sum = 0;
  for (const Type& type : types) sum += type.type.name == name ? type.count : 0;
  return sum;
}

const LogMessageType* LogContents::find(std::string_view name) const {
  const Type* best = nullptr;
  for (const Type& type : types) {
    if (type.type.name == name && (best == nullptr || type.count > best->count)) best = &type;
  }
  return best == nullptr ? nullptr : &best->type;
}

AutopilotLog::AutopilotLog(std::span<const std::byte> content, std::string name)
    : name_(std::move(name)), messages_(content) {
  if (content.empty()) throw InputError(name_, "the file is empty");
  if (looks_like_ulog(content)) {
    format_ = LogFormat::ulog;
    if (needs_newer_ulog_reader(content)) {
      throw InputError(name_,
                       "is a ULog of a kind that cannot be read: it sets flags that are not known "
                       "here, and says that it is misread without them");
    }
    contents_ = scan_ulog(content);
    if (contents_.messages == 0) {
      throw InputError(
          name_, fmt::format("begins as a ULog, but holds no message in {} bytes", content.size()));
    }
    return;
  }
  if (looks_like_dataflash_text(content)) {
    format_ = LogFormat::dataflash_text;
    DataFlashTranscript transcript = transcribe_dataflash(content);
    transcript_ = std::move(transcript.messages);
    messages_ = transcript_;
    contents_ = dataflash_contents(messages_);
    contents_.bytes = content.size();
    for (const SkippedBytes& line : transcript.skipped) contents_.add(line);
    for (std::string& sentence : transcript.rejected) contents_.add_rejected(std::move(sentence));
    if (!is_dataflash(contents_)) fail_as_foreign(content, name_);
    return;
  }
  constexpr std::array mark = {std::byte{0xA3}, std::byte{0x95}};
  const bool is_marked =
      content.size() > mark.size() && std::equal(mark.begin(), mark.end(), content.begin());
  if (!is_marked && (looks_like_text(content) || !foreign_kind(content).empty())) {
    fail_as_foreign(content, name_);
  }
  contents_ = dataflash_contents(content);
  if (!is_dataflash(contents_)) fail_as_foreign(content, name_);
}

void AutopilotLog::for_each(
    const std::function<void(const LogMessageType&, const std::byte*)>& visit) const {
  if (format_ == LogFormat::ulog) {
    for_each_ulog_message(messages_, visit);
  } else {
    for_each_message(messages_, visit);
  }
}

std::vector<int> AutopilotLog::instances(std::string_view message) const {
  std::set<int> found;
  for (const LogContents::Type& type : contents_.types) {
    if (type.type.name != message || type.count == 0) continue;
    if (type.type.instance) found.insert(*type.type.instance);
    if (!type.type.instance_field) continue;
    const std::vector<std::string> field = {*type.type.instance_field};
    const auto values = columns(message, field);
    for (const double value : values.front()) found.insert(static_cast<int>(value));
  }
  return {found.begin(), found.end()};
}

std::vector<std::vector<double>> AutopilotLog::columns(std::string_view message,
                                                       std::span<const std::string> fields,
                                                       std::optional<int> instance) const {
  if (format_ == LogFormat::ulog) {
    return extract_ulog_columns(messages_, message, fields, instance);
  }
  std::optional<DataFlashInstance> wanted;
  const LogMessageType* const type = contents_.find(message);
  if (instance && type != nullptr && type->instance_field) {
    wanted = {*type->instance_field, static_cast<double>(*instance)};
  }
  return extract_columns(messages_, message, fields, wanted);
}

LogSeries AutopilotLog::series(std::string_view message, std::span<const std::string> fields,
                               std::optional<int> instance) const {
  LogSeries series;
  series.columns.resize(fields.size());
  const LogMessageType* const type = contents_.find(message);
  const auto time = type == nullptr ? std::nullopt : time_of(*type);
  if (!time) return series;
  std::vector<std::string> all = {time->field.name};
  all.insert(all.end(), fields.begin(), fields.end());
  std::vector<std::vector<double>> found = columns(message, all, instance);
  series.time = std::move(found.front());
  for (double& t : series.time) t /= time->counts_per_second;
  series.columns.assign(std::make_move_iterator(found.begin() + 1),
                        std::make_move_iterator(found.end()));
  return series;
}

bool looks_like_text(std::span<const std::byte> content) {
  const auto head = content.first(std::min(content.size(), head_size));
  constexpr std::array mark = {std::byte{0xA3}, std::byte{0x95}};
  const auto is_control = [](std::byte byte) {
    const auto code = std::to_integer<unsigned>(byte);
    return code < 0x20 && (code < '\t' || code > '\r');
  };
  return std::ranges::none_of(head, is_control) &&
         std::search(head.begin(), head.end(), mark.begin(), mark.end()) == head.end();
}

bool looks_like_dataflash_text(std::span<const std::byte> content) {
  if (!looks_like_text(content)) return false;
  const std::string_view head(reinterpret_cast<const char*>(content.data()),
                              std::min(content.size(), head_size));
  return head.starts_with("FMT,") || head.find("\nFMT,") != std::string_view::npos;
}

}  // namespace tethercalc
