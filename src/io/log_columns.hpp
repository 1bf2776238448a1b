// Fields of many messages as columns of numbers.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "io/log_bytes.hpp"
#include "tethercalc/io/log_messages.hpp"

namespace tethercalc {

/// Reads numbers of one kind, which are stored as a T, in units of 1/Divisor.
template <char kind_, class T, int Divisor = 1>
struct NumberReader {
  static constexpr char kind = kind_;
  double operator()(const std::byte* at) const {
    const auto number = static_cast<double>(log_bytes::read<T>(at));
    return Divisor == 1 ? number : number / Divisor;
  }
};

/// Likewise of IEEE 754 binary16.
struct HalfReader {
  static constexpr char kind = 'g';
  double operator()(const std::byte* at) const {
    const auto bits = log_bytes::read<std::uint16_t>(at);
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

/// What to take from a message type.
struct WantedFields {
  std::optional<LogField> instance{};
  std::vector<LogField> fields{};
};

/// Columns filled some hundred messages at a time, column by column.
class ColumnFiller {
 public:
  ColumnFiller(std::size_t columns, std::size_t rows) : columns_(columns) {
    for (auto& column : columns_) column.reserve(rows);
  }
  void add(const WantedFields& wanted, const std::byte* message) {
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
  void append(std::vector<double>& column, const LogField& field) const {
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
  const WantedFields* wanted_ = nullptr;  // what all messages of the batch are read by
};

}  // namespace tethercalc
