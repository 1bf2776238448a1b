#include <catch2/catch.hpp>

#include <random>
#include <string>

#include "io/closest_name.hpp"
#include "io/json_document.hpp"

using namespace tethercalc;
using Json = nlohmann::ordered_json;

TEST_CASE("every value knows its line") {
  const JsonDocument document = parse_json(
      "{\n"                   // 1
      "  \"a\": 1,\n"         // 2
      "  \"b\": {\n"          // 3
      "    \"c\": [1,\n"      // 4
      "      2\n"             // 5
      "      , 3], \"d\":\n"  // 6
      "      null },\n"       // 7
      "  \"x/y~\": true\n"    // 8
      "}\n",
      "f.json");
  CHECK(document.where("") == "f.json:1");
  CHECK(document.where("/a") == "f.json:2 /a");
  CHECK(document.where("/b/c") == "f.json:4 /b/c");
  CHECK(document.where("/b/c/0") == "f.json:4 /b/c/0");
  CHECK(document.where("/b/c/1") == "f.json:5 /b/c/1");
  CHECK(document.where("/b/c/2") == "f.json:6 /b/c/2");
  CHECK(document.where("/b/d") == "f.json:6 /b/d");
  CHECK(document.where("/x~1y~0") == "f.json:8 /x~1y~0");
  CHECK(document.where("/b/missing/deeper") == "f.json:3 /b/missing/deeper");
}

TEST_CASE("what is parsed with lines equals what the library parses without") {
  const std::string text =
      R"({"z": [1, -2, 3.5e-7, [], {}], "a": {"b": "ü\n\u00e9", "c": [true, false, null]},
         "big": 18446744073709551615, "": 0})";
  CHECK(parse_json(text, "f").root.dump() == Json::parse(text).dump());
}

TEST_CASE("text cut anywhere is refused with a place inside it") {
  const std::string text = "{\"a\": [1, 2.5, \"x\\u00e9\"],\n \"b\": {\"c\": true}}";
  for (std::size_t length = 1; length < text.size(); ++length) {
    INFO(text.substr(0, length));
    try {
      (void)parse_json(text.substr(0, length), "cut.json");
      FAIL_CHECK("was accepted");
    } catch (const InputError& error) {
      CHECK_THAT(error.what(), Catch::StartsWith("cut.json:"));
      CHECK_THAT(error.what(), Catch::Contains("^"));
    }
  }
}

TEST_CASE("a caret points at the fault in a long line") {
  const std::string text =
      "{\"a\": [" + std::string(500, ' ') + "1 2" + std::string(500, ' ') + "]}";
  try {
    (void)parse_json(text, "long.json");
    FAIL("was accepted");
  } catch (const InputError& error) {
    const std::string message = error.what();
    CHECK_THAT(message, Catch::Contains("column 510"));
    const std::size_t excerpt = message.find('\n');
    const std::size_t caret = message.rfind('\n');
    CHECK(message[excerpt + (message.find('^') - caret)] == '2');
    CHECK(caret - excerpt < 80);
  }
}

TEST_CASE("a value is shown on one short line without bytes that disturb a terminal") {
  CHECK(shown("\x1b[31m") == "\"\\u001b[31m\"");
  CHECK(shown(std::string("\xff")) == "\"\\ufffd\"");
  CHECK(shown(std::string(1000, 'a')).size() < 70);
}

TEST_CASE("the edit distance counts slips of the pen") {
  CHECK(edit_distance("mass_g", "mass_g") == 0);
  CHECK(edit_distance("MASS_G", "mass_g") == 0);
  CHECK(edit_distance("mas_g", "mass_g") == 1);
  CHECK(edit_distance("masss_g", "mass_g") == 1);
  CHECK(edit_distance("mass-g", "mass_g") == 1);
  CHECK(edit_distance("amss_g", "mass_g") == 1);
  CHECK(edit_distance("", "abc") == 3);
  CHECK(edit_distance("ca", "abc") == 3);  // optimal string alignment; 2 without its restriction
}
