// Writes DataFlash logs for tests. Shares no code with the reader: it was written from the format's
// description alone (ArduPilot, libraries/AP_Logger/LogStructure.h).
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tethercalc::test {

/// A field's content: what is in the log, so that hundredths are given as integers of hundredths.
using LoggedValue =
    std::variant<std::int64_t, std::uint64_t, double, std::string, std::vector<std::int16_t>>;

class DataFlashWriter {
 public:
  /// Begins with the definition of FMT, as every log does.
  DataFlashWriter() { define(128, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns"); }

  void define(int type, const std::string& name, const std::string& format,
              const std::string& labels) {
    std::size_t length = 3;
    for (const char kind : format) length += size_of(kind);
    define_as(type, length, name, format, labels);
  }

  /// A definition that may be wrong on purpose.
  void define_as(int type, std::size_t length, const std::string& name, const std::string& format,
                 const std::string& labels) {
    formats_[128] = "BBnNZ";
    if (type != 128) formats_[type] = format;
    add(128, {std::int64_t{type}, static_cast<std::int64_t>(length), name, format, labels});
  }

  void add(int type, const std::vector<LoggedValue>& values) {
    const std::string& format = formats_.at(type);
    if (values.size() != format.size()) throw std::logic_error("wrong number of values");
    starts_.push_back(bytes_.size());
    put_byte(0xA3);
    put_byte(0x95);
    put_byte(static_cast<unsigned>(type));
    for (std::size_t i = 0; i < values.size(); ++i) put(format[i], values[i]);
  }

  void add_bytes(std::span<const std::byte> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }

  [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }
  /// Where each message begins.
  [[nodiscard]] const std::vector<std::size_t>& starts() const { return starts_; }

 private:
  static std::size_t size_of(char kind) {
    static const std::map<char, std::size_t> sizes = {
        {'a', 64}, {'b', 1}, {'B', 1}, {'h', 2},  {'H', 2},  {'i', 4}, {'I', 4},
        {'f', 4},  {'d', 8}, {'n', 4}, {'N', 16}, {'Z', 64}, {'c', 2}, {'C', 2},
        {'e', 4},  {'E', 4}, {'L', 4}, {'M', 1},  {'q', 8},  {'Q', 8}, {'g', 2}};
    return sizes.at(kind);
  }

  void put_byte(unsigned value) { bytes_.push_back(static_cast<std::byte>(value)); }

  void put_integer(std::uint64_t value, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i)
      put_byte(static_cast<unsigned>(value >> (8 * i)) & 0xFFU);
  }

  void put(char kind, const LoggedValue& value) {
    if (const auto* text = std::get_if<std::string>(&value)) {
      for (std::size_t i = 0; i < size_of(kind); ++i) {
        put_byte(i < text->size() ? static_cast<unsigned char>((*text)[i]) : 0U);
      }
    } else if (const auto* numbers = std::get_if<std::vector<std::int16_t>>(&value)) {
      for (std::size_t i = 0; i < 32; ++i)
        put_integer(static_cast<std::uint16_t>(numbers->at(i)), 2);
    } else if (kind == 'f') {
      const auto single = static_cast<float>(std::get<double>(value));
      std::uint32_t bits = 0;
      std::memcpy(&bits, &single, sizeof bits);
      put_integer(bits, 4);
    } else if (kind == 'd') {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &std::get<double>(value), sizeof bits);
      put_integer(bits, 8);
    } else if (const auto* positive = std::get_if<std::uint64_t>(&value)) {
      put_integer(*positive, size_of(kind));
    } else {
      put_integer(static_cast<std::uint64_t>(std::get<std::int64_t>(value)), size_of(kind));
    }
  }

  std::vector<std::byte> bytes_;
  std::vector<std::size_t> starts_;
  std::map<int, std::string> formats_;
};

/// A sample of an estimator as the log holds it: µs, hundredths of a degree, m/s.
struct LoggedEstimate {
  std::uint64_t time_us = 0;
  std::int64_t roll_cdeg = 0;
  std::int64_t pitch_cdeg = 0;
  std::int64_t yaw_cdeg = 0;
  double vn = 0;
  double ve = 0;
  double vd = 0;
};

inline constexpr int xkf1_type = 64;

inline void define_xkf1(DataFlashWriter& log) {
  log.define(xkf1_type, "XKF1", "QBccCfff", "TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD");
}

inline void add_xkf1(DataFlashWriter& log, int core, const LoggedEstimate& s) {
  log.add(xkf1_type,
          {s.time_us, std::int64_t{core}, s.roll_cdeg, s.pitch_cdeg, s.yaw_cdeg, s.vn, s.ve, s.vd});
}

}  // namespace tethercalc::test
