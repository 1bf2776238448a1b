#include "page/answer_call.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <charconv>

#include "io/closest_name.hpp"
#include "io/json_document.hpp"
#include "page/asks.hpp"

namespace tethercalc::page {
namespace {

ordered_json (*find_ask(const std::string& name))(const Request&) {
  static constexpr std::array general{Ask{"about", about}, Ask{"explain", explain}};
  std::vector<std::string> names;
  for (const std::span<const Ask> asks :
       {std::span<const Ask>(general), design_asks(), log_asks()}) {
    for (const Ask& ask : asks) {
      if (ask.name == name) return ask.answer;
      names.emplace_back(ask.name);
    }
  }
  throw InputError("ask", fmt::format("\"{}\" cannot be asked; allowed are {}{}", name,
                                      fmt::join(names, ", "), did_you_mean(name, names)));
}

/// Line and pointer out of the "file:line /pointer" with which readers name a place.
ordered_json problem_json(const InputProblem& problem) {
  ordered_json out{{"pointer", nullptr},
                   {"line", nullptr},
                   {"where", as_utf8(problem.where)},
                   {"message", as_utf8(problem.message)}};
  std::string_view rest = problem.where;
  if (const std::size_t slash = rest.find(" /"); slash != rest.npos) {
    out["pointer"] = as_utf8(std::string(rest.substr(slash + 1)));
    rest = rest.substr(0, slash);
  }
  const bool is_option = rest.starts_with("--");
  if (const std::size_t colon = rest.rfind(':'); colon != rest.npos && !is_option) {
    std::size_t line = 0;
    const char* const end = rest.data() + rest.size();
    const auto [stop, error] = std::from_chars(rest.data() + colon + 1, end, line);
    if (error == std::errc() && stop == end) out["line"] = line;
  }
  return out;
}

ordered_json problems_json(const std::vector<InputProblem>& problems) {
  ordered_json list = ordered_json::array();
  for (const InputProblem& problem : problems) list.push_back(problem_json(problem));
  return {{"problems", std::move(list)}};
}

ordered_json answered(std::string_view text, const NamedFiles& files) {
  JsonDocument document = parse_json(text, "request");
  if (!document.problems.empty()) throw InputError(std::move(document.problems));
  if (!document.root.is_object()) {
    throw InputError("request", "expected an object, found " + type_name(document.root));
  }
  const Request request(std::move(document.root), files);
  ordered_json answer = find_ask(request.text("ask"))(request);
  request.refuse_others();
  return {{"answer", std::move(answer)}};
}

/// Names of files and quoted cells may hold any bytes.
std::string answer_text(const ordered_json& value) {
  return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace

std::string answer_call(std::string_view request, const NamedFiles& files) noexcept {
  try {
    try {
      return answer_text(answered(request, files));
    } catch (const InputError& error) {
      return answer_text(problems_json(error.problems()));
    } catch (const std::bad_alloc&) {
      return answer_text(problems_json({{"memory", "does not suffice for this"}}));
    } catch (const std::exception& error) {
      return answer_text(problems_json({{"internal error", error.what()}}));
    }
  } catch (...) {
    // Not even room for words.
    return R"({"problems":[{"pointer":null,"line":null,"where":"memory","message":"is full"}]})";
  }
}

}  // namespace tethercalc::page
