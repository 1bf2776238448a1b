#include "page/request.hpp"

#include <fmt/format.h>

#include <cmath>

#include "io/checked_values.hpp"
#include "io/closest_name.hpp"

namespace tethercalc::page {

const ordered_json* Request::member(const std::string& name) const {
  known_.insert(name);
  const auto found = members_.find(name);
  return found == members_.end() || found->is_null() ? nullptr : &*found;
}

void Request::fail(const std::string& name, std::string_view expected, const ordered_json& found) {
  throw InputError(name, fmt::format("expected {}, found {}", expected, type_name(found)));
}

bool Request::has(const std::string& name) const { return member(name) != nullptr; }

const ordered_json& Request::value(const std::string& name) const {
  static const ordered_json null;
  const ordered_json* found = member(name);
  return found == nullptr ? null : *found;
}

std::string Request::text(const std::string& name) const {
  const ordered_json* found = member(name);
  if (found == nullptr) throw InputError(name, "is needed");
  if (!found->is_string()) fail(name, "a text", *found);
  return found->get<std::string>();
}

std::string Request::text_or(const std::string& name, const std::string& otherwise) const {
  return has(name) ? text(name) : otherwise;
}

std::optional<std::string> Request::typed(const std::string& name) const {
  const ordered_json* found = member(name);
  if (found == nullptr) return std::nullopt;
  if (found->is_number()) return found->dump();
  if (!found->is_string()) fail(name, "a text or a number", *found);
  return found->get<std::string>();
}

std::optional<double> Request::number(const std::string& name) const {
  const ordered_json* found = member(name);
  if (found == nullptr) return std::nullopt;
  if (!found->is_number()) fail(name, "a number", *found);
  return found->get<double>();
}

int Request::whole(const std::string& name, int otherwise) const {
  const std::optional<double> found = number(name);
  if (!found) return otherwise;
  constexpr double most = 1e9;
  if (!(std::abs(*found) <= most) || *found != std::floor(*found)) {
    throw InputError(name, fmt::format("{} is not a whole number", *found));
  }
  return static_cast<int>(*found);
}

bool Request::flag(const std::string& name) const {
  const ordered_json* found = member(name);
  if (found == nullptr) return false;
  if (!found->is_boolean()) fail(name, "true or false", *found);
  return found->get<bool>();
}

std::vector<std::string> Request::list(const std::string& name) const {
  const ordered_json* found = member(name);
  if (found == nullptr) return {};
  std::vector<std::string> texts;
  for (const ordered_json& value : found->is_array() ? *found : ordered_json{*found}) {
    if (!value.is_string() && !value.is_number()) fail(name, "a list of texts", value);
    texts.push_back(value.is_string() ? value.get<std::string>() : json_line(value));
  }
  return texts;
}

DesignFile Request::design() const {
  const std::string spec = text("spec");
  if (spec.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw InputError(std::string(spec_file), "is empty");
  }
  return parse_design(spec, std::string(spec_file), loader(), list("set"));
}

std::span<const std::byte> Request::file(const std::string& name) const {
  if (const auto found = files_.find(name); found != files_.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [known, content] : files_) names.push_back(known);
  throw InputError(name, "no such file" + did_you_mean(name, names));
}

TextLoader Request::loader() const {
  return [this](const std::string& reference) {
    const std::span<const std::byte> bytes = file(reference);
    return LoadedText{reference, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}};
  };
}

void Request::refuse_others() const {
  Problems problems;
  const std::vector<std::string> known(known_.begin(), known_.end());
  for (const auto& [name, value] : members_.items()) {
    if (known_.contains(name)) continue;
    problems.add(name, "is nothing that this ask takes" + did_you_mean(name, known));
  }
  problems.throw_if_any();
}

}  // namespace tethercalc::page
