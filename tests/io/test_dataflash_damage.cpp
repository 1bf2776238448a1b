// Damaged logs: nothing crashes, nothing is invented, little is lost, and the loss is told.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "files/input_files.hpp"
#include "support/dataflash_writer.hpp"
#include "support/random.hpp"
#include "tethercalc/io/dataflash.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/log_readers.hpp"
#include "tethercalc/io/log_summary.hpp"

using namespace tethercalc;
using test::DataFlashWriter;

namespace {

using Bytes = std::vector<std::byte>;
using Generator = std::mt19937_64;

struct Message {
  std::size_t offset = 0;
  std::string name;
  Bytes bytes;
};

std::vector<Message> messages_of(const Bytes& log) {
  std::vector<Message> messages;
  for_each_message(log, [&](const DataFlashFormat& format, const std::byte* start) {
    messages.push_back({static_cast<std::size_t>(start - log.data()), format.name,
                        Bytes(start, start + format.length)});
  });
  return messages;
}

std::size_t below(Generator& random, std::size_t bound) {
  return std::uniform_int_distribution<std::size_t>(0, bound - 1)(random);
}

std::byte any_byte(Generator& random) { return static_cast<std::byte>(below(random, 256)); }

/// Messages of several lengths with random payloads, in random succession.
Bytes random_log(Generator& random) {
  DataFlashWriter log;
  test::define_xkf1(log);
  log.define(10, "BARO", "QffhB", "TimeUS,Alt,Press,Temp,Health");
  log.define(11, "MSG", "QZ", "TimeUS,Message");
  log.define(12, "EV", "QB", "TimeUS,Id");
  log.define(13, "IMU", "QBfff", "TimeUS,I,AccX,AccY,AccZ");
  std::uint64_t time = 1'000'000;
  const auto number = [&random] { return std::normal_distribution<double>(0, 10)(random); };
  for (int i = 0; i < 2000; ++i) {
    time += 1000 + below(random, 1000);
    const auto byte = static_cast<std::int64_t>(below(random, 256));
    switch (below(random, 5)) {
      case 0:
        test::add_xkf1(log, static_cast<int>(below(random, 2)),
                       {time, byte * 10, byte - 100, byte * 100, number(), number(), number()});
        break;
      case 1:
        log.add(10, {time, number(), number(), byte, std::int64_t{1}});
        break;
      case 2:
        log.add(11, {time, std::string(1 + below(random, 64), 'm')});
        break;
      case 3:
        log.add(12, {time, byte});
        break;
      default:
        log.add(13, {time, byte % 3, number(), number(), number()});
    }
  }
  return log.bytes();
}

/// Bytes of FMT messages at the log's beginning: damage there is another matter, see below.
std::size_t end_of_definitions(const std::vector<Message>& messages) {
  const auto first = std::find_if(messages.begin(), messages.end(),
                                  [](const Message& m) { return m.name != "FMT"; });
  return first == messages.end() ? 0 : first->offset;
}

/// Real logs where there are any, beside one of our own.
std::vector<Bytes> intact_logs(Generator& random) {
  std::vector<Bytes> logs = {random_log(random)};
  const auto folder = std::filesystem::path(TETHERCALC_REFERENCE_DATA) / "data" / "logs";
  for (const std::string name : {"lacondro_v463_log0", "erle_loiter_rtl", "pymavlink_test"}) {
    const auto path = folder / (name + ".bin");
    if (!std::filesystem::exists(path)) continue;
    const MappedFile file(path);
    logs.emplace_back(file.bytes().begin(), file.bytes().end());
  }
  return logs;
}

/// Messages lost, apart from those whose definition was lost with its FMT message: some firmware
/// writes definitions throughout the log.
std::size_t lost_though_defined(const std::vector<Message>& before,
                                const std::vector<Message>& after) {
  std::set<std::string> defined;
  for (const Message& message : after) defined.insert(message.name);
  const auto of_defined = [&defined](const Message& m) { return defined.count(m.name) != 0; };
  return static_cast<std::size_t>(std::count_if(before.begin(), before.end(), of_defined)) -
         after.size();
}

std::uint64_t new_seed() { return test::run_seed(); }

void check_accounted_for(const Bytes& log) {
  const DataFlashContents contents = scan_dataflash(log);
  std::size_t bytes = contents.skipped_bytes;
  std::size_t count = 0;
  for (const Message& message : messages_of(log)) {
    bytes += message.bytes.size();
    ++count;
  }
  CHECK(bytes == log.size());
  CHECK(count == contents.messages);
}

/// True where the message of `messages` around `place` would seem intact with `size` bytes inserted
/// or removed: when a header, or payload that looks like one, stands where it would then end.
bool seems_intact(const Bytes& intact, const std::vector<Message>& messages, std::size_t place,
                  std::size_t size, bool insert) {
  const auto next =
      std::upper_bound(messages.begin(), messages.end(), place,
                       [](std::size_t p, const Message& message) { return p < message.offset; });
  if (next == messages.begin()) return false;
  const std::size_t end = std::prev(next)->offset + std::prev(next)->bytes.size();
  const std::size_t seeming_end = insert ? end - size : end + size;
  return seeming_end + 1 < intact.size() && intact[seeming_end] == std::byte{0xA3} &&
         intact[seeming_end + 1] == std::byte{0x95};
}

/// Inserts or removes stretches of at most 10 bytes, `times` of them, far from each other behind
/// `from`. They are shorter than any message: where as many bytes are lost as a message has, one's
/// beginning can be joined to another's end, and no framing tells. Nor does it where a message
/// seems intact. Nor are they right at a type number: where a payload byte takes its place, about
/// one time in ten thousand it fits.
Bytes with_shifts(const Bytes& intact, const std::vector<Message>& messages, std::size_t from,
                  std::size_t times, bool insert, Generator& random) {
  std::size_t longest = 10;
  std::set<std::size_t> type_numbers;
  for (const Message& message : messages) {
    longest = std::min(longest, message.bytes.size() - 1);
    type_numbers.insert(message.offset + 2);
  }
  Bytes damaged = intact;
  const std::size_t part = (intact.size() - from) / times;
  REQUIRE(part > 1000);
  for (std::size_t i = times; i-- > 0;) {  // from the end, so that the positions before it stay
    std::size_t place = 0;
    std::size_t size = 0;
    do {
      place = from + i * part + below(random, part - 600);
      if (type_numbers.count(place) != 0) ++place;
      size = 1 + below(random, longest);
    } while (seems_intact(intact, messages, place, size, insert));
    const auto at = static_cast<std::ptrdiff_t>(place);
    if (insert) {
      Bytes junk(size);
      std::generate(junk.begin(), junk.end(), [&] { return any_byte(random); });
      damaged.insert(damaged.begin() + at, junk.begin(), junk.end());
    } else {
      damaged.erase(damaged.begin() + at, damaged.begin() + at + static_cast<std::ptrdiff_t>(size));
    }
  }
  return damaged;
}

}  // namespace

TEST_CASE("inserted or removed bytes invent no message and cost at most two each") {
  const auto seed = new_seed();
  INFO("seed " << seed);
  Generator random(seed);
  for (const Bytes& intact : intact_logs(random)) {
    const std::vector<Message> before = messages_of(intact);
    std::set<Bytes> known;
    for (const Message& message : before) known.insert(message.bytes);
    for (int round = 0; round < 20; ++round) {
      const std::size_t times = 1 + below(random, 20);
      const Bytes damaged =
          with_shifts(intact, before, end_of_definitions(before), times, round % 2 == 0, random);
      const std::vector<Message> after = messages_of(damaged);
      std::size_t invented = 0;
      for (const Message& message : after) invented += known.count(message.bytes) == 0 ? 1 : 0;
      CHECK(invented == 0);
      CHECK(lost_though_defined(before, after) <= 2 * times);
      check_accounted_for(damaged);
    }
  }
}

TEST_CASE("flipped bytes move no message and cost at most two each") {
  const auto seed = new_seed();
  INFO("seed " << seed);
  Generator random(seed);
  for (const Bytes& intact : intact_logs(random)) {
    const std::vector<Message> before = messages_of(intact);
    std::map<std::size_t, std::size_t> length_at;
    for (const Message& message : before) length_at[message.offset] = message.bytes.size();
    const std::size_t from = end_of_definitions(before);
    for (int round = 0; round < 20; ++round) {
      Bytes damaged = intact;
      const std::size_t times = 1 + below(random, 20);
      for (std::size_t i = 0; i < times; ++i) {
        damaged[from + below(random, damaged.size() - from)] = any_byte(random);
      }
      const std::vector<Message> after = messages_of(damaged);
      std::size_t moved = 0;
      for (const Message& message : after) {
        const auto intact_one = length_at.find(message.offset);
        const bool same =
            intact_one != length_at.end() && intact_one->second == message.bytes.size();
        moved += same ? 0 : 1;
      }
      CHECK(moved == 0);
      CHECK(lost_though_defined(before, after) <= 2 * times);
      check_accounted_for(damaged);
    }
  }
}

TEST_CASE("one flipped byte in a mark costs that message alone, and it is counted") {
  Generator random(1);
  const Bytes intact = random_log(random);
  const std::vector<Message> before = messages_of(intact);
  for (std::size_t i = 100; i < 130; ++i) {
    for (const std::size_t byte : {0, 1}) {
      Bytes damaged = intact;
      damaged[before[i].offset + byte] ^= std::byte{0x10};
      const DataFlashContents contents = scan_dataflash(damaged);
      CHECK(contents.messages == before.size() - 1);
      CHECK(contents.skipped_messages == 1);
      CHECK(contents.skipped_bytes == before[i].bytes.size());
      REQUIRE(contents.skipped.size() == 1);
      CHECK(contents.skipped[0].offset == before[i].offset);
    }
  }
}

TEST_CASE("a damaged definition costs its own messages, whichever byte is hit") {
  Generator random(new_seed());
  const Bytes intact = random_log(random);
  const std::vector<Message> before = messages_of(intact);
  std::set<std::size_t> starts;
  std::map<std::string, std::size_t> counts;
  for (const Message& message : before) {
    starts.insert(message.offset);
    ++counts[message.name];
  }
  const std::size_t end = end_of_definitions(before);
  for (std::size_t at = 0; at < end; ++at) {
    INFO("byte " << at);
    Bytes damaged = intact;
    damaged[at] ^= std::byte{0x01};
    const std::vector<Message> after = messages_of(damaged);
    std::map<std::string, std::size_t> counts_after;
    for (const Message& message : after) {
      REQUIRE(starts.count(message.offset) == 1);
      ++counts_after[message.name];
    }
    // Of messages that kept their name there are no more than before: none took another's.
    for (const auto& [name, count] : counts_after) {
      if (counts.count(name) != 0) REQUIRE(count <= counts[name]);
    }
    check_accounted_for(damaged);
  }
}

TEST_CASE("a definition that takes another's number or name costs the messages of both") {
  DataFlashWriter log;
  log.define(20, "AAA", "f", "Value");
  log.define(21, "BBB", "f", "Value");
  log.define(22, "CCC", "f", "Value");
  log.define(20, "DDD", "f", "Value");  // was 23 before a bit flipped
  log.define(24, "BBB", "f", "Value");  // was EEE
  for (const int type : {20, 21, 22, 24}) log.add(type, {1.0});
  const DataFlashContents contents = scan_dataflash(log.bytes());
  CHECK(contents.count("AAA") == 0);
  CHECK(contents.count("BBB") == 0);
  CHECK(contents.count("CCC") == 1);
  CHECK(contents.count("DDD") == 0);
  CHECK(contents.rejected_definitions.size() == 2);
  CHECK(contents.skipped_messages == 3);
}

TEST_CASE("a definition whose length is not that of its fields is not used") {
  DataFlashWriter log;
  log.define_as(20, 9, "AAA", "f", "Value");
  log.add(20, {1.0});
  const DataFlashContents contents = scan_dataflash(log.bytes());
  CHECK(contents.count("AAA") == 0);
  REQUIRE(contents.rejected_definitions.size() == 1);
  CHECK(contents.rejected_definitions[0].find("AAA") != std::string::npos);
}

TEST_CASE("a log cut anywhere gives the messages that are whole") {
  Generator random(2);
  const Bytes intact = random_log(random);
  const std::vector<Message> before = messages_of(intact);
  for (std::size_t size = 0; size < 2000; ++size) {
    const Bytes cut(intact.begin(), intact.begin() + static_cast<std::ptrdiff_t>(size));
    const auto whole = static_cast<std::size_t>(
        std::count_if(before.begin(), before.end(),
                      [size](const Message& m) { return m.offset + m.bytes.size() <= size; }));
    const std::size_t end =
        whole == 0 ? 0 : before[whole - 1].offset + before[whole - 1].bytes.size();
    const DataFlashContents contents = scan_dataflash(cut);
    // With one byte of the next message's mark left, nothing shows that the last one is whole.
    const std::size_t expected = size - end == 1 && whole > 0 ? whole - 1 : whole;
    REQUIRE(contents.messages == expected);
    REQUIRE(contents.skipped_messages == (size > end ? 1U : 0U));
  }
}

TEST_CASE("unwritten memory behind the last message is skipped, and no message is lost for it") {
  for (const std::byte filler : {std::byte{0x00}, std::byte{0xFF}}) {
    DataFlashWriter log;
    log.define(20, "AAA", "b", "Value");
    log.add(20, {std::int64_t{7}});
    Bytes bytes = log.bytes();
    bytes.resize(bytes.size() + 4096, filler);
    const DataFlashContents contents = scan_dataflash(bytes);
    CHECK(contents.count("AAA") == 1);
    CHECK(contents.skipped_bytes == 4096);
    CHECK(contents.skipped_messages == 0);
  }
}

TEST_CASE("any bytes at all are read without a crash, and accounted for") {
  const auto seed = new_seed();
  INFO("seed " << seed);
  Generator random(seed);
  for (int round = 0; round < 300; ++round) {
    // Few different bytes, so that marks and types come up again and again.
    Bytes bytes(below(random, 3000));
    DataFlashWriter log;
    log.define(0xA3, "AAA", "", "");
    log.define(0x95, "BBB", "Q", "TimeUS");
    const Bytes alphabet = {std::byte{0xA3}, std::byte{0x95}, std::byte{128}, std::byte{0}};
    std::generate(bytes.begin(), bytes.end(), [&] { return alphabet[below(random, 4)]; });
    log.add_bytes(bytes);
    check_accounted_for(log.bytes());
    try {
      (void)summarize_log(AutopilotLog(log.bytes(), "log"));
      (void)parse_flight_log(log.bytes(), "log", {});
    } catch (const InputError& error) {
      CHECK_FALSE(error.problems().empty());
    }
  }
}
