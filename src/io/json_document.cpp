#include "io/json_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

namespace tethercalc {
namespace {

using Json = nlohmann::ordered_json;

// Specs nest five levels; unbounded nesting would exhaust the stack where values are written.
constexpr std::size_t deepest_nesting = 32;
// Of a faulty line; enough to recognise the place on an 80 column terminal.
constexpr std::size_t excerpt_width = 60;

/// Iterates over text and leaves word of how far it went: the SAX interface passes no positions.
class CountingIterator {
 public:
  using iterator_category = std::forward_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator() = default;
  CountingIterator(const char* at, const char* begin, std::size_t* consumed)
      : at_(at), begin_(begin), consumed_(consumed) {}

  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    ++at_;
    *consumed_ = static_cast<std::size_t>(at_ - begin_);
    return *this;
  }
  CountingIterator operator++(int) {
    CountingIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }

 private:
  const char* at_ = nullptr;
  const char* begin_ = nullptr;
  std::size_t* consumed_ = nullptr;
};

/// The line around `offset` with a caret below it.
std::string excerpt_at(std::string_view text, std::size_t offset) {
  std::size_t begin = text.substr(0, offset).rfind('\n') + 1;
  if (offset - begin > excerpt_width / 2) begin = offset - excerpt_width / 2;
  const std::size_t end = std::min(text.find('\n', offset), begin + excerpt_width);
  std::string line(text.substr(begin, end == std::string_view::npos ? end : end - begin));
  if (line.size() > excerpt_width) line.resize(excerpt_width);
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e) c = ' ';
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return fmt::format("\n    {}\n    {}^", line, std::string(offset - begin, ' '));
}

/// Receives the parser's events, builds the value and notes where each part of it stands.
class Builder {
 public:
  using number_integer_t = Json::number_integer_t;
  using number_unsigned_t = Json::number_unsigned_t;
  using number_float_t = Json::number_float_t;
  using string_t = Json::string_t;
  using binary_t = Json::binary_t;

  Builder(JsonDocument& document, std::string_view text, const std::size_t& consumed,
          Quoting quoting)
      : document_(document), text_(text), consumed_(consumed), quoting_(quoting) {}

  bool null() { return add(nullptr); }
  bool boolean(bool value) { return add(value); }
  bool number_integer(number_integer_t value) { return add_number(value); }
  bool number_unsigned(number_unsigned_t value) { return add_number(value); }
  bool number_float(number_float_t value, const string_t&) { return add_number(value); }
  bool string(string_t& value) { return add(std::move(value)); }
  bool binary(binary_t&) { return false; }  // JSON text has none

  bool start_object(std::size_t) { return open(Json::object()); }
  bool start_array(std::size_t) { return open(Json::array()); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }

  bool key(string_t& name) {
    key_ = std::move(name);
    const std::string pointer = child_pointer(levels_.back().pointer, key_);
    const std::size_t line = current_line();
    key_repeated_ = !levels_.back().keys.insert(key_).second;
    if (key_repeated_) {
      document_.problems.push_back(
          {fmt::format("{}:{} {}", document_.name, line, pointer),
           fmt::format("the key {} stands here and in line {}; give it once", shown(key_),
                       document_.lines[pointer])});
    } else {
      document_.lines[pointer] = line;
    }
    return seen(Event::key);
  }

  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) {
    fail(error.what());
    return false;
  }

  [[nodiscard]] const InputProblem& failure() const { return failure_; }

 private:
  /// What the parser last reported, on which depends what may follow.
  enum class Event { none, opened, key, value };

  struct Level {
    Json* value;
    std::string pointer;
    std::set<std::string> keys;
  };

  bool seen(Event event) {
    last_event_ = event;
    last_end_ = consumed_;
    return true;
  }

  // The parser has consumed a token, and one character more after a number.
  std::size_t current_line() {
    const std::size_t end = consumed_ == 0 ? 0 : consumed_ - 1;
    for (; counted_ < end; ++counted_) {
      if (text_[counted_] == '\n') ++line_;
    }
    return line_;
  }

  /// Puts `value` where it belongs and returns its place and pointer.
  std::pair<Json*, std::string> place(Json value) {
    if (levels_.empty()) {
      document_.root = std::move(value);
      document_.lines[""] = current_line();
      return {&document_.root, ""};
    }
    Level& level = levels_.back();
    if (level.value->is_array()) {
      std::string pointer = fmt::format("{}/{}", level.pointer, level.value->size());
      document_.lines[pointer] = current_line();
      level.value->push_back(std::move(value));
      return {&level.value->back(), std::move(pointer)};
    }
    std::string pointer = child_pointer(level.pointer, key_);
    if (key_repeated_) {
      Json& member = (*level.value)[key_];
      member = std::move(value);
      return {&member, std::move(pointer)};
    }
    // ordered_json searches all members at every insertion; of a new key it need not.
    std::vector<std::pair<const std::string, Json>>& members =
        level.value->get_ref<Json::object_t&>();
    members.emplace_back(key_, std::move(value));
    return {&members.back().second, std::move(pointer)};
  }

  template <typename Value>
  bool add(Value&& value) {
    place(Json(std::forward<Value>(value)));
    return seen(Event::value);
  }

  template <typename Number>
  bool add_number(Number number) {
    add(number);
    --last_end_;  // the parser has looked at the character behind it
    return true;
  }

  bool open(Json empty) {
    if (levels_.size() == deepest_nesting) {
      failure_ = {fmt::format("{}:{}", document_.name, current_line()),
                  fmt::format("is nested deeper than {} levels", deepest_nesting)};
      return false;
    }
    auto [value, pointer] = place(std::move(empty));
    levels_.push_back({value, std::move(pointer), {}});
    return seen(Event::opened);
  }

  bool close() {
    levels_.pop_back();
    return seen(Event::value);
  }

  /// Where the token stands that the parser refused, and whether a comma precedes it.
  struct Fault {
    std::size_t offset = 0;
    bool after_comma = false;
  };

  [[nodiscard]] Fault find_fault() const {
    Fault fault{last_end_, false};
    if (last_event_ == Event::none && text_.starts_with("\xef\xbb\xbf")) fault.offset = 3;
    if (last_event_ == Event::value && fault.offset + 1 == text_.size() && is_digit(fault.offset)) {
      ++fault.offset;  // a number that ends the text: there was nothing behind it to look at
    }
    fault.offset = skip_space(fault.offset);
    const char separator = last_event_ == Event::key ? ':' : ',';
    const bool may_be_separated =
        last_event_ == Event::key || (last_event_ == Event::value && !levels_.empty());
    if (may_be_separated && text_.substr(fault.offset).starts_with(separator)) {
      fault.after_comma = separator == ',';
      fault.offset = skip_space(fault.offset + 1);
    }
    return fault;
  }

  void fail(const std::string& what) {
    Fault fault = find_fault();
    const std::string text = reason(fault, what);
    const bool in_string = what.find("invalid string") != std::string::npos;
    if (in_string && consumed_ > fault.offset) fault.offset = consumed_ - 1;
    fault.offset = std::min(fault.offset, text_.size());
    if (skip_space(fault.offset) == text_.size()) fault.offset = end_of_content();
    const std::string_view before = text_.substr(0, fault.offset);
    const auto line = 1 + std::ranges::count(before, '\n');
    const std::size_t column = fault.offset - (before.rfind('\n') + 1) + 1;
    failure_ = {fmt::format("{}:{}", document_.name, line),
                fmt::format("column {}: {}{}", column, text,
                            quoting_ == Quoting::line ? excerpt_at(text_, fault.offset) : "")};
  }

  [[nodiscard]] std::string reason(const Fault& fault, const std::string& what) const {
    if (fault.offset >= text_.size()) {
      return "the file ends before the JSON does; is it cut off, or a bracket missing?";
    }
    if (what.find("missing closing quote") != std::string::npos) {
      return "the file ends inside a text; is it cut off, or a closing quote missing?";
    }
    if (what.find("UTF-8") != std::string::npos) return "this is not valid UTF-8";
    if (what.find("control character") != std::string::npos) {
      return "a text may not hold line ends or other control characters; is a closing quote "
             "missing?";
    }
    if (what.find("number overflow") != std::string::npos) return "this number is too large";
    const std::string_view rest = text_.substr(fault.offset);
    for (const std::string_view word : {"NaN", "nan", "-NaN", "Infinity", "-Infinity", "inf"}) {
      if (rest.starts_with(word)) {
        return fmt::format("{} is not a number in JSON; give a finite one", word);
      }
    }
    if (rest.starts_with("//") || rest.starts_with("/*") || rest.starts_with("#")) {
      return "JSON has no comments; put remarks under the key \"notes\"";
    }
    if (what.find("invalid number") != std::string::npos) {
      return "this is no number as JSON writes it, with digits after a sign and a point";
    }
    if (rest.starts_with("'")) return "JSON wants double quotes (\") around keys and texts";
    if (last_event_ == Event::value && !fault.after_comma && is_digit(fault.offset) &&
        text_[fault.offset - 1] == '0') {
      return "a number may not begin with a zero before other digits";
    }
    if (fault.after_comma && (rest.starts_with("}") || rest.starts_with("]"))) {
      return "this bracket is not expected here; is there a comma too many before it?";
    }
    if (levels_.empty() && last_event_ == Event::value) {
      return "the JSON is complete before this; nothing may follow it";
    }
    if (what.find("invalid string") != std::string::npos) {
      return "this escape in a text is none that JSON knows";
    }
    return "this is not JSON: expected " + expectation(fault);
  }

  [[nodiscard]] std::string expectation(const Fault& fault) const {
    if (last_event_ == Event::key && skip_space(last_end_) == fault.offset) return "a colon";
    if (levels_.empty()) return "an object";
    const bool in_object = levels_.back().value->is_object();
    if (last_event_ == Event::value && !fault.after_comma) {
      return in_object ? "a comma or a closing brace" : "a comma or a closing bracket";
    }
    if (in_object && last_event_ != Event::key) return "a key in double quotes";
    return "a value: a number, a text in double quotes, true, false, an object or a list";
  }

  [[nodiscard]] std::size_t skip_space(std::size_t offset) const {
    return std::min(text_.find_first_not_of(" \t\r\n", offset), text_.size());
  }
  [[nodiscard]] std::size_t end_of_content() const {
    const std::size_t last = text_.find_last_not_of(" \t\r\n");
    return last == std::string_view::npos ? 0 : last + 1;
  }
  [[nodiscard]] bool is_digit(std::size_t offset) const {
    return text_[offset] >= '0' && text_[offset] <= '9';
  }

  JsonDocument& document_;
  std::string_view text_;
  const std::size_t& consumed_;
  Quoting quoting_;
  std::size_t counted_ = 0;
  std::size_t line_ = 1;
  Event last_event_ = Event::none;
  std::size_t last_end_ = 0;  ///< behind what it was about
  std::string key_;
  bool key_repeated_ = false;
  std::vector<Level> levels_;
  InputProblem failure_;
};

std::string_view parent(std::string_view pointer) { return pointer.substr(0, pointer.rfind('/')); }

}  // namespace

std::string JsonDocument::where(std::string_view pointer) const {
  for (std::string_view at = pointer;; at = parent(at)) {
    if (const auto option = options.find(at); option != options.end()) return option->second;
    if (const auto line = lines.find(at); line != lines.end()) {
      return fmt::format("{}:{}{}{}", name, line->second, pointer.empty() ? "" : " ", pointer);
    }
    if (at.empty()) return fmt::format("{}{}{}", name, pointer.empty() ? "" : " ", pointer);
  }
}

JsonDocument parse_json(std::string_view text, std::string name, Quoting quoting) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
    throw InputError(name + ":1", "is UTF-16; save it as UTF-8");
  }
  if (const std::size_t nul = text.find('\0'); nul != text.npos) {
    // The parser would take it for the end.
    const auto line = 1 + std::ranges::count(text.substr(0, nul), '\n');
    throw InputError(fmt::format("{}:{}", name, line),
                     "holds a NUL character, which no JSON does; is it another kind of file?");
  }
  JsonDocument document{std::move(name), {}, {}, {}, {}};
  std::size_t consumed = 0;
  const char* begin = text.data();
  Builder builder(document, text, consumed, quoting);
  const bool parsed =
      Json::sax_parse(CountingIterator(begin, begin, &consumed),
                      CountingIterator(begin + text.size(), begin, &consumed), &builder);
  if (!parsed) {
    document.problems.push_back(builder.failure());
    throw InputError(std::move(document.problems));
  }
  return document;
}

Json json_of(std::string_view text) { return parse_json(text, "").root; }

std::string json_text(const Json& json) { return json.dump(2) + "\n"; }

std::string json_line(const Json& json) { return json.dump(); }

Json result_json(const ResultValue& value) {
  if (const auto* word = std::get_if<std::string>(&value)) return *word;
  return value.index() == 0 ? Json(nullptr) : Json(std::get<double>(value));
}

std::string child_pointer(std::string_view pointer, std::string_view key) {
  return (Json::json_pointer(std::string(pointer)) / std::string(key)).to_string();
}

std::string_view last_key(std::string_view pointer) {
  return pointer.substr(pointer.rfind('/') + 1);
}

bool is_below(std::string_view pointer, std::string_view top) {
  return pointer.size() > top.size() && pointer.starts_with(top) && pointer[top.size()] == '/';
}

std::string shown(const nlohmann::ordered_json& value) {
  constexpr std::size_t longest = 60;
  std::string text =
      value.dump(-1, ' ', /*ensure_ascii=*/true, nlohmann::ordered_json::error_handler_t::replace);
  if (text.size() > longest) text = text.substr(0, longest - 1) + "…";
  return text;
}

bool is_utf8(const std::string& text) { return as_utf8(text) == text; }

std::string file_stem(std::string_view name) {
  name.remove_prefix(name.rfind('/') + 1);
  const std::size_t dot = name.rfind('.');
  return std::string(name.substr(0, dot == 0 ? name.npos : dot));
}

std::string as_utf8(const std::string& text) {
  const Json value(text);
  return json_of(value.dump(-1, ' ', true, Json::error_handler_t::replace)).get<std::string>();
}

std::string type_name(const nlohmann::ordered_json& value) {
  if (value.is_null()) return "null";
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number()) return "the number " + shown(value);
  if (value.is_string()) return "the text " + shown(value);
  return value.is_array() ? "a list" : "an object";
}

}  // namespace tethercalc
