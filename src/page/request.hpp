// A request of the page, member by member.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "page/answer_call.hpp"
#include "tethercalc/io/design_reader.hpp"

namespace tethercalc::page {

using nlohmann::ordered_json;

/// What messages call the spec of a request.
inline constexpr std::string_view spec_file = "spec.json";

/// The members of a request's object. Each getter throws InputError where the member is of another
/// type, and remembers that it was asked for.
class Request {
 public:
  Request(ordered_json members, const NamedFiles& files)
      : members_(std::move(members)), files_(files) {}

  [[nodiscard]] bool has(const std::string& name) const;
  /// Any value; null where it is not given.
  [[nodiscard]] const ordered_json& value(const std::string& name) const;
  /// Throws where it is not given.
  [[nodiscard]] std::string text(const std::string& name) const;
  [[nodiscard]] std::string text_or(const std::string& name, const std::string& otherwise) const;
  /// As typed: a text, or a number as JSON writes it.
  [[nodiscard]] std::optional<std::string> typed(const std::string& name) const;
  [[nodiscard]] std::optional<double> number(const std::string& name) const;
  [[nodiscard]] int whole(const std::string& name, int otherwise) const;
  [[nodiscard]] bool flag(const std::string& name) const;
  /// A list of texts and numbers as typed, or a single one; empty where it is not given.
  [[nodiscard]] std::vector<std::string> list(const std::string& name) const;

  /// The design in "spec", with "set", a list of "path=value", in it. Files that it names are those
  /// of the request.
  [[nodiscard]] DesignFile design() const;

  /// The bytes of a file. Throws InputError, naming the closest one, where there is none.
  [[nodiscard]] std::span<const std::byte> file(const std::string& name) const;
  /// Reads them as texts.
  [[nodiscard]] TextLoader loader() const;

  /// Throws InputError with every member that no getter was called for.
  void refuse_others() const;

 private:
  [[nodiscard]] const ordered_json* member(const std::string& name) const;
  [[noreturn]] static void fail(const std::string& name, std::string_view expected,
                                const ordered_json& found);

  ordered_json members_;
  const NamedFiles& files_;
  mutable std::set<std::string, std::less<>> known_{"ask"};
};

}  // namespace tethercalc::page
