#include "io/foreign_files.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

#include "io/log_bytes.hpp"

namespace tethercalc {
namespace {

constexpr std::size_t time_size = 8;  // a tlog has one before each packet, µs, big-endian

/// Bytes of the MAVLink packet at `at` (mavlink.io, "Packet Serialization"); nothing where none is.
std::optional<std::size_t> mavlink_packet(std::span<const std::byte> content, std::size_t at) {
  if (at + 3 > content.size()) return std::nullopt;
  const auto byte = [&](std::size_t i) { return std::to_integer<std::size_t>(content[at + i]); };
  constexpr std::size_t version_1 = 0xFE;
  constexpr std::size_t version_2 = 0xFD;
  constexpr std::size_t signature = 13;
  if (byte(0) == version_1) return 8 + byte(1);
  if (byte(0) == version_2) return 12 + byte(1) + ((byte(2) & 1U) != 0 ? signature : 0);
  return std::nullopt;
}

/// Whether packets succeed each other at the distances that they tell themselves.
bool is_telemetry(std::span<const std::byte> content, std::size_t before_each) {
  constexpr int enough = 3;
  std::size_t at = before_each;
  int packets = 0;
  for (; packets < enough; ++packets) {
    const auto size = mavlink_packet(content, at);
    if (!size) break;
    at += *size + before_each;
  }
  // A short one must end where a packet does.
  return packets == enough || (packets > 0 && at == content.size() + before_each);
}

/// No control characters but those that lay a text out.
bool is_text(std::string_view begin) {
  return std::all_of(begin.begin(), begin.end(), [](char c) {
    return static_cast<unsigned char>(c) >= ' ' ||
           std::string_view("\t\n\r\f").find(c) != std::string_view::npos;
  });
}

}  // namespace

std::string foreign_kind(std::span<const std::byte> content) {
  const std::string_view all(reinterpret_cast<const char*>(content.data()), content.size());
  constexpr std::size_t looked_at = 4096;
  const std::string_view head = all.substr(0, looked_at);
  const auto holds = [&](std::string_view text) {
    return head.find(text) != std::string_view::npos;
  };
  const std::size_t first = head.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  const char begin = first == std::string_view::npos ? '\0' : head[first];

  if (is_telemetry(content, time_size)) {
    return "is a MAVLink telemetry log (.tlog), of what was sent to the ground; give the "
           "autopilot's .bin or .ulg";
  }
  if (is_telemetry(content, 0)) {
    return "is a stream of MAVLink packets (.rlog); give the autopilot's .bin or .ulg";
  }
  if (holds("H Product:Blackbox")) {
    return "is a Betaflight or INAV blackbox log, which is not read; give its speed and attitude "
           "as CSV";
  }
  if (head.size() > 12 && head.substr(4, 4) == "ftyp") {
    return "is a video or picture (MP4, MOV or HEIF), not a log";
  }
  if (head.starts_with("RIFF") && head.size() > 12 && head.substr(8, 3) == "AVI") {
    return "is a video (AVI), not a log";
  }
  if (head.starts_with("\x1A\x45\xDF\xA3")) return "is a video (MKV or WebM), not a log";
  if (head.starts_with("\xFF\xFE") || head.starts_with("\xFE\xFF")) {
    return "is UTF-16; save it as UTF-8";
  }
  if (head.starts_with("\xFF\xD8\xFF")) return "is a JPEG picture, not a log";
  if (head.starts_with("\x89PNG")) return "is a PNG picture, not a log";
  if (head.starts_with("%PDF")) return "is a PDF document, not a log";
  if (head.starts_with("\x7F"
                       "ELF") ||
      head.starts_with("MZ"))
    return "is a program, not a log";
  if (head.starts_with("SQLite format 3")) return "is an SQLite database, not a log";
  if (head.starts_with("7z\xBC\xAF")) {
    return "is a 7z archive, which is not read; unpack it, or give .gz, .xz or .zip";
  }
  if (head.starts_with("BZh") || head.starts_with("\x28\xB5\x2F\xFD")) {
    return "is compressed in a way that is not read; unpack it, or give .gz, .xz or .zip";
  }
  if (holds("<kml")) {
    return "is a KML track, without attitude; give the autopilot's .bin or .ulg";
  }
  if (holds("<gpx")) {
    return "is a GPX track, without attitude; give the autopilot's .bin or .ulg";
  }
  if (!is_text(head.substr(0, 64))) return "";
  if (begin == '{' || begin == '[') return "is JSON, not a log";
  if (begin == '<') return "is XML or HTML, not a log";
  return "";
}

}  // namespace tethercalc
