#include "report/characters.hpp"

#include <rapidcheck.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <regex>

using namespace tethercalc;

namespace {

/// `text` with every reference that `markup_text` writes taken back.
std::string unescaped(std::string text) {
  const std::pair<const char*, const char*> references[]{
      {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}, {"&amp;", "&"}};
  for (const auto& [reference, character] : references) {
    text = std::regex_replace(text, std::regex(reference), character);
  }
  return text;
}

std::string any_bytes() { return *rc::gen::container<std::string>(rc::gen::arbitrary<char>()); }

/// Texts that are more often markup than arbitrary bytes are.
std::string any_markup() {
  return *rc::gen::container<std::string>(
      rc::gen::element('<', '>', '&', '"', '\'', ';', '#', 'l', 't', '\n', ' ', ']', '-', '!'));
}

}  // namespace

TEST_CASE("whatever bytes a text has, its markup holds no markup") {
  CHECK(rc::check([] {
    const std::string text = any_bytes() + any_markup();
    const std::string markup = markup_text(text);
    RC_ASSERT(markup.find_first_of("<>\"'") == std::string::npos);
    RC_ASSERT(std::regex_replace(markup, std::regex("&(lt|gt|quot|amp|#39);"), "").find('&') ==
              std::string::npos);
  }));
}

TEST_CASE("markup is read as the text that it was made of") {
  CHECK(rc::check([] {
    const std::string text = any_markup();
    RC_ASSERT(unescaped(markup_text(text)) == text);
  }));
  CHECK(markup_text("Ünïcödé 無人機 🚁") == "Ünïcödé 無人機 🚁");
}

TEST_CASE("a printable text is one line of valid UTF-8, never longer than asked") {
  CHECK(rc::check([] {
    const auto longest = *rc::gen::inRange<std::size_t>(1, 20);
    const std::string line = printable(any_bytes(), longest);
    RC_ASSERT(std::none_of(line.begin(), line.end(),
                           [](char c) { return static_cast<unsigned char>(c) < 0x20; }));
    const auto characters =
        std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; });
    RC_ASSERT(static_cast<std::size_t>(characters) <= longest);
    RC_ASSERT(nlohmann::json::parse(nlohmann::json(line).dump()) == line);
  }));
}

TEST_CASE("marks that turn the direction of writing are not printed") {
  for (const char* mark : {"\u061c", "\u200e", "\u200f", "\u202a", "\u202e", "\u2066", "\u2069"}) {
    CHECK(printable(mark) == "\ufffd");
    CHECK(markup_text(mark) == "\ufffd");
  }
}

TEST_CASE("JSON made visible says the same, with nothing hidden in it") {
  const nlohmann::json value{{"name", "a\u202eb\u2028c\u007fd"}, {"plain", "Ü\t\n\"\\"}};
  const std::string visible = visible_json(value.dump(2));
  CHECK(nlohmann::json::parse(visible) == value);
  CHECK(printable(visible).find("\ufffd") == std::string::npos);
  CHECK_THAT(visible, Catch::Contains("a\\u202eb\\u2028c\\u007fd"));
}
