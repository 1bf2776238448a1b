// Where a command's answer goes and in which form.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tethercalc/report/text_table.hpp"

namespace tethercalc::cli {

enum class Format { table, json, csv };

struct Output {
  Format format = Format::table;
  std::string file;  ///< empty: standard output
};

/// Exit codes of the program; scripts rely on them.
enum ExitCode : int { done = 0, answer_is_no = 1, bad_input = 2, internal_error = 3 };

/// Colours where the answer goes to a terminal that wants them: TERM is not "dumb" and NO_COLOR is
/// not set (no-color.org).
[[nodiscard]] TextStyle style_for(const Output& output);

/// How figures and pages name a file that they are made of: without folders, which say nothing to
/// others.
[[nodiscard]] std::string base_name(const std::string& file);

/// Writes the answer, to the file whole or not at all. Throws InputError where it cannot.
void emit(const Output& output, const std::string& text);

/// The text of a JSON answer.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& json);

/// Writes the answer in the form that was asked for, of which alone it is made.
void emit(const Output& output, const std::function<std::string()>& text,
          const std::function<nlohmann::ordered_json()>& json,
          const std::function<std::string()>& csv);

}  // namespace tethercalc::cli
