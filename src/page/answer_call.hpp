// What the page in the browser asks of the calculator, and its answers, as JSON texts; docs/page.md
// lists both.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace tethercalc::page {

/// Contents of what a request names: motor tables, logs (not compressed).
using NamedFiles = std::map<std::string, std::span<const std::byte>, std::less<>>;

/// The answer to a `request` {"ask": NAME, "spec": text, …}: {"answer": {…}}, or {"problems":
/// [{`pointer`, `line`, `where`, `message`}]} with the words of the program, where `pointer` and
/// `line` are null for what stands in no text. Sentences, tables, numbers and files are those of
/// the commands. Throws nothing, whatever it is given.
[[nodiscard]] std::string answer_call(std::string_view request, const NamedFiles& files) noexcept;

}  // namespace tethercalc::page
