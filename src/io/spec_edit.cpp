#include "io/spec_edit.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "io/checked_values.hpp"
#include "io/spec_paths.hpp"

namespace tethercalc {
namespace {

constexpr std::string_view blanks = " \t\r\n";

/// From the first character to behind the last.
struct Extent {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// A key (of an element of a list: nothing) with its value.
struct Member {
  Extent key;  ///< with its quotes
  Extent value;
};

/// Finds its way in a text that is known to be JSON.
class JsonText {
 public:
  explicit JsonText(std::string_view text) : text_(text) {}

  [[nodiscard]] std::size_t skip_space(std::size_t at) const {
    return std::min(text_.find_first_not_of(blanks, at), text_.size());
  }

  [[nodiscard]] Extent value_at(std::size_t at) const {
    const std::size_t begin = skip_space(at);
    const char first = text_[begin];
    if (first == '"') return {begin, end_of_string(begin)};
    if (first != '{' && first != '[') {
      return {begin, std::min(text_.find_first_of(",]} \t\r\n", begin), text_.size())};
    }
    std::size_t depth = 0;
    for (std::size_t i = begin;; ++i) {
      const char c = text_[i];
      if (c == '"') i = end_of_string(i) - 1;
      if (c == '{' || c == '[') ++depth;
      if ((c == '}' || c == ']') && --depth == 0) return {begin, i + 1};
    }
  }

  /// Of the object or list there.
  [[nodiscard]] std::vector<Member> members(Extent holder) const {
    std::vector<Member> found;
    const bool keys = text_[holder.begin] == '{';
    std::size_t at = skip_space(holder.begin + 1);
    while (at + 1 < holder.end) {
      Member member;
      if (keys) {
        member.key = {at, end_of_string(at)};
        at = skip_space(member.key.end) + 1;  // behind the colon
      }
      member.value = value_at(at);
      found.push_back(member);
      at = skip_space(member.value.end);
      if (text_[at] != ',') break;
      at = skip_space(at + 1);
    }
    return found;
  }

  /// The last of that key or index, which is the one that counts.
  [[nodiscard]] std::optional<Member> find(Extent holder, const std::string& key) const {
    const std::vector<Member> all = members(holder);
    std::optional<Member> found;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto [begin, end] = all[i].key;
      const bool same = begin == end
                            ? key == std::to_string(i)
                            : json_of(text_.substr(begin, end - begin)).get<std::string>() == key;
      if (same) found = all[i];
    }
    return found;
  }

  [[nodiscard]] char at(std::size_t place) const { return text_[place]; }
  [[nodiscard]] std::string_view between(std::size_t begin, std::size_t end) const {
    return text_.substr(begin, end - begin);
  }

 private:
  [[nodiscard]] std::size_t end_of_string(std::size_t quote) const {
    std::size_t i = quote + 1;
    while (text_[i] != '"') i += text_[i] == '\\' ? 2 : 1;
    return i + 1;
  }

  std::string_view text_;
};

/// The white space before the last member, by which a further one is laid out; of an empty object
/// that before the object itself, one step deeper where it begins a line.
std::string gap_of(const JsonText& json, Extent holder, const std::vector<Member>& members) {
  if (!members.empty()) {
    const std::size_t before = members.size() == 1
                                   ? holder.begin + 1
                                   : json.skip_space(members[members.size() - 2].value.end) + 1;
    const std::size_t key = members.back().key.begin;
    return before < key ? std::string(json.between(before, key)) : std::string();
  }
  return " ";
}

std::string with_new_member(std::string_view text, Extent holder, std::span<const std::string> keys,
                            const nlohmann::ordered_json& value) {
  const JsonText json(text);
  const std::vector<Member> members = json.members(holder);
  std::string written;
  for (const std::string& key : keys) {
    written += json_line(key) + ": " + (&key == &keys.back() ? "" : "{ ");
  }
  written += json_line(value);
  for (std::size_t i = 1; i < keys.size(); ++i) written += " }";
  const std::string gap = gap_of(json, holder, members);
  std::string out(text);
  if (members.empty()) {
    out.replace(holder.begin, holder.end - holder.begin, "{ " + written + " }");
  } else {
    out.insert(members.back().value.end, "," + gap + written);
  }
  return out;
}

/// Without the member, and without the comma and white space that belong to it.
std::string without_member(std::string_view text, Extent holder, const Member& gone) {
  const JsonText json(text);
  std::size_t begin = gone.key.begin;
  std::size_t end = gone.value.end;
  const std::vector<Member> members = json.members(holder);
  if (members.back().value.begin != gone.value.begin) {
    end = json.skip_space(json.skip_space(end) + 1);  // to the next one
  } else if (members.size() > 1) {
    begin = members[members.size() - 2].value.end;
  } else {
    begin = holder.begin + 1;
    end = holder.end - 1;
  }
  std::string out(text);
  return out.erase(begin, end - begin);
}

}  // namespace

std::string spec_with_value(std::string_view text, const std::string& file, const std::string& path,
                            const nlohmann::ordered_json& value) {
  const JsonDocument document = parse_json(text, file);
  if (!document.root.is_object()) {
    throw InputError(document.where(""),
                     fmt::format("expected an object, found {}", type_name(document.root)));
  }
  const std::string pointer = pointer_of(path);
  if (!may_be_in_spec(pointer)) throw InputError(path, no_such_field(path));
  std::vector<std::string> keys;
  for (const std::string_view part : split(std::string_view(pointer).substr(1), '/')) {
    keys.emplace_back(part);
  }
  const JsonText json(text);
  Extent holder = json.value_at(text.starts_with("\xef\xbb\xbf") ? 3 : 0);
  std::string walked;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const char opening = json.at(holder.begin);
    const std::optional<Member> member =
        opening == '{' || opening == '[' ? json.find(holder, keys[i]) : std::nullopt;
    const bool is_null = member && json.at(member->value.begin) == 'n';
    if (member && i + 1 < keys.size() && !is_null) {
      holder = member->value;
      walked += "/" + keys[i];
      continue;
    }
    if (member && i + 1 == keys.size() && !value.is_null()) {
      return std::string(text).replace(member->value.begin, member->value.end - member->value.begin,
                                       json_line(value));
    }
    if (value.is_null() && (!member || i + 1 < keys.size())) return std::string(text);
    if (opening != '{') {
      throw InputError(
          document.where(walked),
          fmt::format("there is no {} in {}, which is {}", shown(keys[i]),
                      walked.empty() ? "the spec" : dot_path(walked),
                      type_name(document.root.at(nlohmann::ordered_json::json_pointer(walked)))));
    }
    if (value.is_null()) return without_member(text, holder, *member);
    if (is_null) {
      const std::string rest = without_member(text, holder, *member);
      return spec_with_value(rest, file, path, value);
    }
    return with_new_member(text, holder, std::span(keys).subspan(i), value);
  }
  return std::string(text);
}

}  // namespace tethercalc
