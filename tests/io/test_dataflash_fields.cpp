// What is written into a log is what is read from it, for every kind of field.
#include <rapidcheck.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "support/dataflash_writer.hpp"
#include "tethercalc/io/dataflash.hpp"

using namespace tethercalc;
using test::DataFlashWriter;

namespace {

constexpr int test_type = 200;

/// A log with one message of one field.
std::vector<std::byte> log_of(char kind, const test::LoggedValue& value) {
  DataFlashWriter log;
  log.define(test_type, "TEST", std::string(1, kind), "Field");
  log.add(test_type, {value});
  return log.bytes();
}

double number_read(char kind, const test::LoggedValue& value) {
  const std::vector<std::string> field = {"Field"};
  const auto columns = extract_columns(log_of(kind, value), "TEST", field);
  REQUIRE(columns[0].size() == 1);
  return columns[0][0];
}

std::string text_read(char kind, const test::LoggedValue& value) {
  std::string text;
  for_each_message(log_of(kind, value), [&](const DataFlashFormat& format, const std::byte* m) {
    if (format.name == "TEST") text = field_text(m, format.fields.at(0));
  });
  return text;
}

template <class Integer>
void check_integers_return(const char* kinds, double divisor) {
  for (const char* kind = kinds; *kind != '\0'; ++kind) {
    const bool holds = rc::check(std::string("integers return from kind ") + *kind, [=] {
      const auto value = *rc::gen::arbitrary<Integer>();
      const auto logged = std::is_signed_v<Integer>
                              ? test::LoggedValue(static_cast<std::int64_t>(value))
                              : test::LoggedValue(static_cast<std::uint64_t>(value));
      RC_ASSERT(number_read(*kind, logged) == static_cast<double>(value) / divisor);
      if (divisor == 1) RC_ASSERT(text_read(*kind, logged) == std::to_string(value));
    });
    CHECK(holds);
  }
}

}  // namespace

TEST_CASE("integers of every kind return, hundredths and degrees scaled") {
  check_integers_return<std::int8_t>("b", 1);
  check_integers_return<std::uint8_t>("BM", 1);
  check_integers_return<std::int16_t>("h", 1);
  check_integers_return<std::uint16_t>("H", 1);
  check_integers_return<std::int32_t>("i", 1);
  check_integers_return<std::uint32_t>("I", 1);
  check_integers_return<std::int64_t>("q", 1);
  check_integers_return<std::uint64_t>("Q", 1);
  check_integers_return<std::int16_t>("c", 100);
  check_integers_return<std::uint16_t>("C", 100);
  check_integers_return<std::int32_t>("e", 100);
  check_integers_return<std::uint32_t>("E", 100);
  check_integers_return<std::int32_t>("L", 1e7);
}

TEST_CASE("floating point returns bit for bit") {
  const bool singles = rc::check("singles return", [] {
    const auto value = *rc::gen::arbitrary<float>();
    RC_ASSERT(number_read('f', static_cast<double>(value)) == static_cast<double>(value));
    RC_ASSERT(std::stof(text_read('f', static_cast<double>(value))) == value);
  });
  const bool doubles = rc::check("doubles return", [] {
    const auto value = *rc::gen::arbitrary<double>();
    RC_ASSERT(number_read('d', value) == value);
  });
  CHECK(singles);
  CHECK(doubles);
  CHECK(std::isnan(number_read('f', std::nan(""))));
  CHECK(number_read('d', -std::numeric_limits<double>::infinity()) == -HUGE_VAL);
}

TEST_CASE("half precision has the values of IEEE 754 binary16") {
  const auto half = [](std::uint64_t bits) { return number_read('g', bits); };
  CHECK(half(0x3C00) == 1.0);
  CHECK(half(0xC000) == -2.0);
  CHECK(half(0x7BFF) == 65504.0);               // the largest
  CHECK(half(0x0001) == std::ldexp(1.0, -24));  // the smallest subnormal
  CHECK(half(0x0400) == std::ldexp(1.0, -14));  // the smallest normal
  CHECK(half(0x3555) == 0.333251953125);        // nearest to 1/3
  CHECK(half(0x7C00) == HUGE_VAL);
  CHECK(std::isnan(half(0x7E00)));
  CHECK((half(0x8000) == 0.0 && std::signbit(half(0x8000))));
}

TEST_CASE("text ends at its first zero byte or fills its field") {
  CHECK(text_read('n', std::string("ab")) == "ab");
  CHECK(text_read('n', std::string("abcd")) == "abcd");
  CHECK(text_read('N', std::string("0123456789abcdef")) == "0123456789abcdef");
  CHECK(text_read('Z', std::string(64, 'x')) == std::string(64, 'x'));
  CHECK(text_read('Z', std::string("before\0after", 12)) == "before");
}

TEST_CASE("the 32 numbers of kind a return in order") {
  std::vector<std::int16_t> numbers(32);
  std::string expected;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = static_cast<std::int16_t>(1000 * static_cast<int>(i) - 15000);
    expected += (i == 0 ? "" : " ") + std::to_string(numbers[i]);
  }
  CHECK(text_read('a', numbers) == expected);
}

TEST_CASE("columns come from the wanted instance alone, in the order asked for") {
  DataFlashWriter log;
  test::define_xkf1(log);
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const double speed = static_cast<double>(i);
    test::add_xkf1(log, 0, {.time_us = i, .vn = speed});
    test::add_xkf1(log, 1, {.time_us = i, .vn = -speed});
  }
  const std::vector<std::string> fields = {"VN", "TimeUS"};
  const auto columns = extract_columns(log.bytes(), "XKF1", fields, DataFlashInstance{"C", 1});
  REQUIRE(columns.size() == 2);
  REQUIRE(columns[0].size() == 1000);
  for (std::size_t i = 0; i < 1000; ++i) {
    REQUIRE(columns[0][i] == -static_cast<double>(i));
    REQUIRE(columns[1][i] == static_cast<double>(i));
  }
  CHECK(columns[0].capacity() == 1000);  // no more memory than the values
}

TEST_CASE("columns that a message lacks, or that are text, come out empty") {
  DataFlashWriter log;
  log.define(test_type, "TEST", "fZ", "Number,Text");
  log.add(test_type, {1.0, std::string("x")});
  for (const std::string field : {"Nothing", "Text"}) {
    const std::vector<std::string> fields = {"Number", field};
    const auto columns = extract_columns(log.bytes(), "TEST", fields);
    REQUIRE(columns.size() == 2);
    CHECK(columns[0].empty());
    CHECK(columns[1].empty());
  }
}

TEST_CASE("fields before a kind that is not known are read, and the message is passed over whole") {
  DataFlashWriter log;
  log.define_as(test_type, 3 + 4 + 5, "TEST", "f?", "Known,Unknown");
  std::vector<std::byte> bytes = log.bytes();
  for (const unsigned byte : {0xA3U, 0x95U, 200U, 0U, 0U, 0x80U, 0x3FU, 1U, 2U, 3U, 4U, 5U}) {
    bytes.push_back(static_cast<std::byte>(byte));
  }
  const std::vector<std::string> fields = {"Known"};
  const auto columns = extract_columns(bytes, "TEST", fields);
  REQUIRE(columns[0].size() == 1);
  CHECK(columns[0][0] == 1.0);
  CHECK(scan_dataflash(bytes).skipped_bytes == 0);
}

TEST_CASE("a log behind another in the same file defines its messages anew") {
  DataFlashWriter first;
  first.define(test_type, "OLD", "B", "Value");
  first.add(test_type, {std::int64_t{1}});
  DataFlashWriter second;
  second.define(test_type, "NEW", "f", "Value");
  second.add(test_type, {2.5});
  first.add_bytes(second.bytes());
  const DataFlashContents contents = scan_dataflash(first.bytes());
  CHECK(contents.count("OLD") == 1);
  CHECK(contents.count("NEW") == 1);
  CHECK(contents.rejected_definitions.empty());
  const std::vector<std::string> fields = {"Value"};
  CHECK(extract_columns(first.bytes(), "NEW", fields)[0] == std::vector<double>{2.5});
}
