#include "tethercalc/io/dataflash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <utility>

#include "io/dataflash_walk.hpp"
#include "io/log_columns.hpp"

namespace tethercalc {
namespace {

using MessageVisitor = std::function<void(const DataFlashFormat&, const std::byte*)>;

/// Calls `visit` for each message, keeping the formats in force.
class FormatKeeper {
 public:
  explicit FormatKeeper(const MessageVisitor& visit) : visit_(visit) {}
  void on_format(std::uint8_t type, const std::byte* fmt) {
    formats_[type] = &kept_.emplace_back(dataflash::parse_format(fmt));
  }
  void on_rejected(std::uint8_t, const std::byte*, std::string_view) {}
  void on_message(std::uint8_t type, const std::byte* message) { visit_(*formats_[type], message); }
  void on_skipped(const SkippedBytes&) {}

 private:
  const MessageVisitor& visit_;
  std::array<const DataFlashFormat*, 256> formats_{};
  std::deque<DataFlashFormat> kept_;  // also those no longer in force
};

class ContentsTaker {
 public:
  void on_format(std::uint8_t type, const std::byte* fmt) {
    DataFlashFormat format = dataflash::parse_format(fmt);
    auto& types = contents.types;
    const auto known = std::ranges::find_if(types, [&format](const DataFlashContents::Type& t) {
      return t.format.type == format.type && t.format.name == format.name &&
             t.format.format == format.format && t.format.labels == format.labels;
    });
    index_[type] = static_cast<std::size_t>(known - types.begin());
    describes_[type] = format.name == "MSG" || format.name == "PARM" || format.name == "UNIT" ||
                       format.name == "FMTU";
    if (known == types.end()) types.push_back({std::move(format), 0});
  }
  void on_rejected(std::uint8_t type, const std::byte* fmt, std::string_view reason) {
    contents.add_rejected(fmt::format("the definition of message {} (number {}) cannot be used: {}",
                                      printable(dataflash::parse_format(fmt).name), type, reason));
  }
  void on_message(std::uint8_t type, const std::byte* message) {
    ++contents.messages;
    ++contents.types[index_[type]].count;
    if (describes_[type]) contents.descriptions.push_back({index_[type], message});
  }
  void on_skipped(const SkippedBytes& lost) { contents.add(lost); }

  DataFlashContents contents;

 private:
  static std::string printable(std::string text) {
    for (char& c : text) {
      if (c < 0x21 || c > 0x7E) c = '?';
    }
    return text;
  }

  std::array<std::size_t, 256> index_{};  // of the type in contents.types
  std::array<bool, 256> describes_{};
};

std::optional<WantedFields> wanted_from(const DataFlashFormat& format, std::string_view name,
                                        std::span<const std::string> fields,
                                        const std::optional<DataFlashInstance>& instance) {
  if (format.name != name) return std::nullopt;
  WantedFields wanted;
  if (instance) {
    const LogField* const field = format.find_number(instance->field);
    if (field == nullptr) return std::nullopt;
    wanted.instance = *field;
  }
  for (const std::string& name_of_field : fields) {
    const LogField* const field = format.find_number(name_of_field);
    if (field == nullptr) return std::nullopt;
    wanted.fields.push_back(*field);
  }
  return wanted;
}

/// Calls `act(wanted, message)` for each wanted message.
template <class Act>
class Extractor {
 public:
  Extractor(std::string_view name, std::span<const std::string> fields,
            const std::optional<DataFlashInstance>& instance, Act act)
      : name_(name), fields_(fields), instance_(instance), act_(std::move(act)) {}
  void on_format(std::uint8_t type, const std::byte* fmt) {
    auto wanted = wanted_from(dataflash::parse_format(fmt), name_, fields_, instance_);
    wanted_[type] = wanted ? &kept_.emplace_back(std::move(*wanted)) : nullptr;
  }
  void on_rejected(std::uint8_t, const std::byte*, std::string_view) {}
  void on_message(std::uint8_t type, const std::byte* message) {
    const WantedFields* const wanted = wanted_[type];
    if (wanted == nullptr) return;
    if (wanted->instance && field_value(message, *wanted->instance) != instance_->value) return;
    act_(*wanted, message);
  }
  void on_skipped(const SkippedBytes& lost) { skipped_.push_back(lost); }

  std::vector<SkippedBytes> take_skipped() { return std::move(skipped_); }

 private:
  std::string_view name_;
  std::span<const std::string> fields_;
  const std::optional<DataFlashInstance>& instance_;
  Act act_;
  std::vector<SkippedBytes> skipped_;
  std::array<const WantedFields*, 256> wanted_{};
  std::deque<WantedFields>
      kept_;  // also those no longer in force, which `act_` may still hold on to
};

}  // namespace

std::string message_words(const LogMessageType& type, const std::byte* message) {
  if (type.name != "MSG") return {};
  const LogField* const words = type.find("Message");
  return words != nullptr && !words->is_number() ? field_text(message, *words) : std::string();
}

std::size_t DataFlashContents::count(std::string_view name) const {
  std::size_t sum = 0;
  for (const Type& type : types) sum += type.format.name == name ? type.count : 0;
  return sum;
}

const DataFlashFormat* DataFlashContents::find(std::string_view name) const {
  const Type* best = nullptr;
  for (const Type& type : types) {
    if (type.format.name == name && (best == nullptr || type.count > best->count)) best = &type;
  }
  return best == nullptr ? nullptr : &best->format;
}

DataFlashContents scan_dataflash(std::span<const std::byte> log) {
  ContentsTaker taker;
  taker.contents.bytes = log.size();
  dataflash::walk(log, taker);
  return std::move(taker.contents);
}

void for_each_message(std::span<const std::byte> log, const MessageVisitor& visit) {
  FormatKeeper keeper(visit);
  dataflash::walk(log, keeper);
}

std::vector<std::vector<double>> extract_columns(std::span<const std::byte> log,
                                                 std::string_view name,
                                                 std::span<const std::string> fields,
                                                 const std::optional<DataFlashInstance>& instance) {
  // Counting first costs a walk, and saves the memory that growing columns would need beside them.
  std::size_t count = 0;
  Extractor counter(name, fields, instance,
                    [&count](const WantedFields&, const std::byte*) { ++count; });
  dataflash::walk(log, counter);
  const std::vector<SkippedBytes> skipped = counter.take_skipped();

  ColumnFiller columns(fields.size(), count);
  Extractor extractor(name, fields, instance,
                      [&columns](const WantedFields& wanted, const std::byte* message) {
                        columns.add(wanted, message);
                      });
  dataflash::walk_again(log, skipped, extractor);
  return columns.finish();
}

}  // namespace tethercalc
