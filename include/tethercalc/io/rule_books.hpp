// The published rules that come with the program, as data: each clause with its number, its edition
// and its words.
#pragma once

#include <string>
#include <vector>

#include "tethercalc/study/rules.hpp"

namespace tethercalc {

/// "electrical", "eu-c3", "uk", "us": what `rule_book` knows, in alphabetical order.
[[nodiscard]] std::vector<std::string> rule_book_ids();

/// The book of that id, of `data/rules/`, with the clauses of the books that it takes in.
/// Throws InputError with the closest id where there is none; `where` is what its message calls the
/// place of the id.
[[nodiscard]] RuleBook rule_book(const std::string& id, const std::string& where = "--rules");

}  // namespace tethercalc
