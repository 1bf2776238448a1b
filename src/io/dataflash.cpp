#include "tethercalc/io/dataflash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <utility>

#include "io/dataflash_walk.hpp"
#include "tethercalc/io/input_error.hpp"

namespace tethercalc {
namespace {

using dataflash::read;

constexpr std::size_t most_told = 100;  // stretches skipped, and definitions rejected
constexpr std::size_t numbers_in_a = 32;

/// Reads numbers of one kind, which are stored as a T, in units of 1/Divisor.
template <char kind_, class T, int Divisor = 1>
struct NumberReader {
  static constexpr char kind = kind_;
  double operator()(const std::byte* at) const {
    const auto number = static_cast<double>(read<T>(at));
    return Divisor == 1 ? number : number / Divisor;
  }
};

/// Likewise of IEEE 754 binary16.
struct HalfReader {
  static constexpr char kind = 'g';
  double operator()(const std::byte* at) const {
    const auto bits = read<std::uint16_t>(at);
    const int exponent = (bits >> 10) & 0x1F;
    const int fraction = bits & 0x3FF;
    double magnitude = 0;
    if (exponent == 0x1F) {
      magnitude = fraction == 0 ? HUGE_VAL : std::nan("");
    } else if (exponent == 0) {
      magnitude = std::ldexp(fraction, -24);
    } else {
      magnitude = std::ldexp(fraction + 0x400, exponent - 25);
    }
    return (bits & 0x8000) != 0 ? -magnitude : magnitude;
  }
};

template <class... Readers>
struct AnyOf {
  template <class Use>
  static void use(char kind, const Use& use) {
    (void)((Readers::kind == kind && (use(Readers{}), true)) || ...);
  }
};

/// Of every kind that is one number. A loop over many messages in what is used with one of them is
/// compiled once for each kind, instead of asking for the kind in every message.
using Numbers =
    AnyOf<NumberReader<'b', std::int8_t>, NumberReader<'B', std::uint8_t>,
          NumberReader<'M', std::uint8_t>, NumberReader<'h', std::int16_t>,
          NumberReader<'H', std::uint16_t>, NumberReader<'i', std::int32_t>,
          NumberReader<'I', std::uint32_t>, NumberReader<'q', std::int64_t>,
          NumberReader<'Q', std::uint64_t>, NumberReader<'c', std::int16_t, 100>,
          NumberReader<'C', std::uint16_t, 100>, NumberReader<'e', std::int32_t, 100>,
          NumberReader<'E', std::uint32_t, 100>, NumberReader<'L', std::int32_t, 10'000'000>,
          NumberReader<'f', float>, NumberReader<'d', double>, HalfReader>;

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
    if (known == types.end()) types.push_back({std::move(format), 0});
  }
  void on_rejected(std::uint8_t type, const std::byte* fmt, std::string_view reason) {
    if (contents.rejected_definitions.size() >= most_told) return;
    contents.rejected_definitions.push_back(
        fmt::format("the definition of message {} (number {}) cannot be used: {}",
                    printable(dataflash::parse_format(fmt).name), type, reason));
  }
  void on_message(std::uint8_t type, const std::byte*) {
    ++contents.messages;
    ++contents.types[index_[type]].count;
  }
  void on_skipped(const SkippedBytes& lost) {
    contents.skipped_bytes += lost.bytes;
    contents.skipped_messages += lost.messages;
    if (contents.skipped.size() < most_told) contents.skipped.push_back(lost);
  }

  DataFlashContents contents;

 private:
  static std::string printable(std::string text) {
    for (char& c : text) {
      if (c < 0x21 || c > 0x7E) c = '?';
    }
    return text;
  }

  std::array<std::size_t, 256> index_{};  // of the type in contents.types
};

/// What to take from a message type.
struct Wanted {
  std::optional<DataFlashField> instance;
  std::vector<DataFlashField> fields;
};

std::optional<Wanted> wanted_from(const DataFlashFormat& format, std::string_view name,
                                  std::span<const std::string> fields,
                                  const std::optional<DataFlashInstance>& instance) {
  if (format.name != name) return std::nullopt;
  Wanted wanted;
  if (instance) {
    const DataFlashField* const field = format.find_number(instance->field);
    if (field == nullptr) return std::nullopt;
    wanted.instance = *field;
  }
  for (const std::string& name_of_field : fields) {
    const DataFlashField* const field = format.find_number(name_of_field);
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
    const Wanted* const wanted = wanted_[type];
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
  std::array<const Wanted*, 256> wanted_{};
  std::deque<Wanted> kept_;  // also those no longer in force, which `act_` may still hold on to
};

/// Columns filled some hundred messages at a time, column by column.
class ColumnFiller {
 public:
  ColumnFiller(std::size_t columns, std::size_t rows) : columns_(columns) {
    for (auto& column : columns_) column.reserve(rows);
  }
  void add(const Wanted& wanted, const std::byte* message) {
    if (&wanted != wanted_ || waiting_ == batch_.size()) flush();
    wanted_ = &wanted;
    batch_[waiting_++] = message;
  }
  std::vector<std::vector<double>> finish() {
    flush();
    return std::move(columns_);
  }

 private:
  void flush() {
    for (std::size_t i = 0; waiting_ > 0 && i < columns_.size(); ++i) {
      append(columns_[i], wanted_->fields[i]);
    }
    waiting_ = 0;
  }
  void append(std::vector<double>& column, const DataFlashField& field) const {
    const std::size_t filled = column.size();
    column.resize(filled + waiting_);  // within what the constructor reserved
    Numbers::use(field.kind, [&](auto number_at) {
      for (std::size_t i = 0; i < waiting_; ++i) {
        column[filled + i] = number_at(batch_[i] + field.offset);
      }
    });
  }

  std::vector<std::vector<double>> columns_;
  std::array<const std::byte*, 256> batch_{};
  std::size_t waiting_ = 0;
  const Wanted* wanted_ = nullptr;  // what all messages of the batch are read by
};

}  // namespace

double field_value(const std::byte* message, const DataFlashField& field) {
  double value = std::nan("");
  Numbers::use(field.kind, [&](auto number_at) { value = number_at(message + field.offset); });
  return value;
}

bool DataFlashField::is_number() const {
  return dataflash::size_of_kind(kind) != 0 &&
         std::string_view("anNZ").find(kind) == std::string_view::npos;
}

const DataFlashField* DataFlashFormat::find(std::string_view field_name) const {
  const auto found = std::ranges::find(fields, field_name, &DataFlashField::name);
  return found == fields.end() ? nullptr : &*found;
}

const DataFlashField* DataFlashFormat::find_number(std::string_view field_name) const {
  const DataFlashField* const found = find(field_name);
  return found != nullptr && found->is_number() ? found : nullptr;
}

std::string field_text(const std::byte* message, const DataFlashField& field) {
  const std::byte* const at = message + field.offset;
  switch (field.kind) {
    case 'n':
    case 'N':
    case 'Z':
      return std::string(dataflash::text_at(at, dataflash::size_of_kind(field.kind)));
    case 'a': {
      std::string numbers;
      for (std::size_t i = 0; i < numbers_in_a; ++i) {
        if (i > 0) numbers += ' ';
        numbers += std::to_string(read<std::int16_t>(at + i * sizeof(std::int16_t)));
      }
      return numbers;
    }
    case 'q':
      return fmt::format("{}", read<std::int64_t>(at));
    case 'Q':
      return fmt::format("{}", read<std::uint64_t>(at));
    case 'f':
      return fmt::format("{}", read<float>(at));
    default:
      return fmt::format("{}", field_value(message, field));
  }
}

std::string message_words(const DataFlashFormat& format, const std::byte* message) {
  if (format.name != "MSG") return {};
  const DataFlashField* const words = format.find("Message");
  return words != nullptr && !words->is_number() ? field_text(message, *words) : std::string();
}

std::optional<DataFlashTime> time_of(const DataFlashFormat& format) {
  if (!format.fields.empty() && format.fields.front().is_number()) {
    if (format.fields.front().name == "TimeUS") return DataFlashTime{format.fields.front(), 1e6};
    if (format.fields.front().name == "TimeMS") return DataFlashTime{format.fields.front(), 1e3};
  }
  const DataFlashField* const since_start = format.find_number("T");
  const bool older_gps = format.name.starts_with("GPS") && format.find("TimeMS") != nullptr;
  if (!older_gps || since_start == nullptr) return std::nullopt;
  return DataFlashTime{*since_start, 1e3};
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

void require_messages(const DataFlashTotals& totals, const std::string& name) {
  if (totals.messages > 0) return;
  throw InputError(
      name,
      fmt::format("no DataFlash message found in {} bytes; expected an ArduPilot .bin log or CSV",
                  totals.bytes));
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
  Extractor counter(name, fields, instance, [&count](const Wanted&, const std::byte*) { ++count; });
  dataflash::walk(log, counter);
  const std::vector<SkippedBytes> skipped = counter.take_skipped();

  ColumnFiller columns(fields.size(), count);
  Extractor extractor(
      name, fields, instance,
      [&columns](const Wanted& wanted, const std::byte* message) { columns.add(wanted, message); });
  dataflash::walk_again(log, skipped, extractor);
  return columns.finish();
}

}  // namespace tethercalc
