// Values as JSON and CSV write them: what does not exist is null there and empty here.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "io/json_document.hpp"
#include "tethercalc/io/library.hpp"
#include "tethercalc/model/warning.hpp"
#include "tethercalc/study/results.hpp"

namespace tethercalc {

using nlohmann::ordered_json;

/// The number, or null where it does not exist: JSON knows neither NaN nor infinity.
[[nodiscard]] ordered_json number_or_null(double value);
[[nodiscard]] ordered_json number_or_null(const std::optional<double>& value);

/// A list of what `of` makes of each of `values`.
template <typename Values, typename Of>
[[nodiscard]] ordered_json json_list(const Values& values, const Of& of) {
  ordered_json out = ordered_json::array();
  for (const auto& value : values) out.push_back(of(value));
  return out;
}

/// An operating point under the keys of `operating_point_fields`.
[[nodiscard]] ordered_json operating_point_json(const OperatingPoint& point);

/// Percent by which the motors' power may be off either way where their curve is an estimate, and
/// the factor by which the drag may be where that is one; nothing where they are not.
[[nodiscard]] std::optional<double> power_uncertainty_percent(const Design& design);
[[nodiscard]] std::optional<double> drag_uncertainty_factor(const Design& design);

/// Both with their names, as columns and keys.
[[nodiscard]] std::array<std::pair<const char*, std::optional<double>>, 2> estimates_of(
    const Design& design);

/// Puts both into an answer, as `power_uncertainty_percent` and `drag_uncertainty_factor`, null
/// where nothing is estimated.
void add_estimates(ordered_json& answer, const Design& design);

/// Puts the sentences of `warnings` into an answer as `warnings`, and beside them, in the same
/// order, the codes of what they are about as `warning_codes`.
void add_warnings(ordered_json& answer, std::span<const Warning> warnings);

/// The same of what was noticed in a log, as `notes` and `note_codes`.
void add_notes(ordered_json& answer, std::span<const Warning> notes);

/// What sentences call a conductor: its id, else its name; one that a spec describes may have
/// neither.
[[nodiscard]] std::string conductor_words(const ConductorEntry& conductor);

/// What a cable "breaks at": `load` N, and how many times the `tension` that `of_what` names, where
/// it has one; 0 N are a load that nobody knows.
[[nodiscard]] std::string strength_words(double load, double tension, std::string_view of_what);

/// A sentence that ends in a full stop, whether it did or not.
[[nodiscard]] std::string with_stop(std::string sentence);

/// A text as one cell of CSV, quoted where it has to be (RFC 4180).
[[nodiscard]] std::string csv_text(std::string_view text);

/// The shortest text that reads back as the same number; empty where it does not exist.
[[nodiscard]] std::string csv_number(double value);

/// A line of CSV of these texts, numbers, truth values and nulls.
[[nodiscard]] std::string csv_line(const ordered_json& values);

}  // namespace tethercalc
