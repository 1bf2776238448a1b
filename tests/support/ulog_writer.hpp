// Writes PX4 logs for tests. Shares no code with the reader: it was written from the format's
// description alone (docs.px4.io, "ULog File Format").
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace tethercalc::test {

/// The content of a message, value by value.
class ULogContent {
 public:
  template <class T>
  ULogContent& put(T value) {
    const auto* const bytes = reinterpret_cast<const std::byte*>(&value);
    bytes_.insert(bytes_.end(), bytes, bytes + sizeof value);
    return *this;
  }
  ULogContent& text(const std::string& text) {
    for (const char c : text) bytes_.push_back(static_cast<std::byte>(c));
    return *this;
  }
  ULogContent& append(const ULogContent& more) {
    bytes_.insert(bytes_.end(), more.bytes_.begin(), more.bytes_.end());
    return *this;
  }
  [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

class ULogWriter {
 public:
  /// Begins with the file's header and flags; `incompatible` are the first eight of these.
  explicit ULogWriter(std::uint64_t start_us = 0, std::uint8_t incompatible = 0) {
    for (const unsigned byte : {0x55U, 0x4CU, 0x6FU, 0x67U, 0x01U, 0x12U, 0x35U, 0x01U}) {
      bytes_.push_back(static_cast<std::byte>(byte));
    }
    append(ULogContent().put(start_us).bytes());
    ULogContent flags;
    flags.put(std::uint64_t{0}).put(std::uint64_t{incompatible});
    for (int i = 0; i < 3; ++i) flags.put(std::uint64_t{0});
    add('B', flags);
  }

  void format(const std::string& text) { add('F', ULogContent().text(text)); }
  void subscribe(std::uint16_t number, const std::string& name, std::uint8_t instance = 0) {
    add('A', ULogContent().put(instance).put(number).text(name));
  }
  void data(std::uint16_t number, const ULogContent& content) {
    add('D', ULogContent().put(number).append(content));
  }
  void information(const std::string& key, const ULogContent& value) {
    add('I', ULogContent().put(static_cast<std::uint8_t>(key.size())).text(key).append(value));
  }
  void information(const std::string& key, const std::string& value) {
    information("char[" + std::to_string(value.size()) + "] " + key, ULogContent().text(value));
  }
  void multiple(bool continued, const std::string& key, const std::string& value) {
    const std::string typed = "char[" + std::to_string(value.size()) + "] " + key;
    add('M', ULogContent()
                 .put(static_cast<std::uint8_t>(continued))
                 .put(static_cast<std::uint8_t>(typed.size()))
                 .text(typed)
                 .text(value));
  }
  void parameter(const std::string& name, float value) {
    const std::string key = "float " + name;
    add('P', ULogContent().put(static_cast<std::uint8_t>(key.size())).text(key).put(value));
  }
  void words(char level, std::uint64_t time_us, const std::string& text) {
    add('L', ULogContent().put(level).put(time_us).text(text));
  }
  void dropout(std::uint16_t milliseconds) { add('O', ULogContent().put(milliseconds)); }
  void sync() {
    ULogContent magic;
    for (const unsigned byte : {0x2FU, 0x73U, 0x13U, 0x20U, 0x25U, 0x0CU, 0xBBU, 0x12U}) {
      magic.put(static_cast<std::uint8_t>(byte));
    }
    add('S', magic);
  }
  /// From here on data is appended, as after a crash: the flags tell where it begins.
  void begin_appended() {
    constexpr std::size_t flags_at = 16 + 3;
    bytes_[flags_at + 8] |= std::byte{1};
    const std::uint64_t offset = bytes_.size();
    std::memcpy(bytes_.data() + flags_at + 16, &offset, sizeof offset);
  }

  void add(char letter, const ULogContent& content) {
    starts_.push_back(bytes_.size());
    append(ULogContent().put(static_cast<std::uint16_t>(content.bytes().size())).bytes());
    bytes_.push_back(static_cast<std::byte>(letter));
    append(content.bytes());
  }
  void append(std::span<const std::byte> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }

  [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }
  /// Where each message begins.
  [[nodiscard]] const std::vector<std::size_t>& starts() const { return starts_; }

 private:
  std::vector<std::byte> bytes_;
  std::vector<std::size_t> starts_;
};

/// The topics that a flight is read from.
inline constexpr std::uint16_t local_position_number = 1;
inline constexpr std::uint16_t attitude_number = 2;

inline void define_flight_topics(ULogWriter& log) {
  log.format(
      "vehicle_local_position:uint64_t timestamp;float vx;float vy;float vz;bool v_xy_valid;"
      "bool v_z_valid;uint8_t[2] _padding0;");
  log.format("vehicle_attitude:uint64_t timestamp;float[4] q;");
  log.subscribe(local_position_number, "vehicle_local_position");
  log.subscribe(attitude_number, "vehicle_attitude");
}

inline void add_local_position(ULogWriter& log, std::uint64_t time_us, double north, double east,
                               double down, bool valid = true) {
  ULogContent content;
  content.put(time_us).put(static_cast<float>(north)).put(static_cast<float>(east));
  content.put(static_cast<float>(down)).put(valid).put(true);
  log.data(local_position_number, content);  // without the padding at its end, as PX4 does
}

inline void add_attitude(ULogWriter& log, std::uint64_t time_us, double w, double x, double y,
                         double z) {
  ULogContent content;
  content.put(time_us);
  for (const double part : {w, x, y, z}) content.put(static_cast<float>(part));
  log.data(attitude_number, content);
}

}  // namespace tethercalc::test
