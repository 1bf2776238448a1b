#include "io/column_choice.hpp"

#include <algorithm>

#include "io/letters.hpp"

namespace tethercalc {

std::optional<ColumnChoice> column_choice(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  ColumnChoice choice{std::string(trimmed(text.substr(0, equals))),
                      std::string(trimmed(text.substr(equals + 1)))};
  if (choice.quantity.empty() || choice.header.empty()) return std::nullopt;
  return choice;
}

std::optional<ChosenColumn> chosen_column(const ColumnChoice& choice,
                                          std::span<const std::string> header) {
  const auto find = [&](std::string_view name, double sign) -> std::optional<ChosenColumn> {
    const auto at = std::ranges::find(header, name);
    if (at == header.end()) return std::nullopt;
    return ChosenColumn{static_cast<std::size_t>(at - header.begin()), sign};
  };
  const std::string_view name = choice.header;
  const auto as_named = find(name, 1);
  return as_named || !name.starts_with('-') ? as_named : find(trimmed(name.substr(1)), -1);
}

}  // namespace tethercalc
