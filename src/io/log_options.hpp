// What is said of logs beside them, as typed: which part of a flight is meant, and which effects
// are part of a diagnosis's base.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/identify/observations.hpp"

namespace tethercalc {

/// Where the part of the log begins or ends that `text`, as given to `option`, names: percent of
/// the samples with a "%", else seconds; nothing for an empty text. Throws InputError for anything
/// else.
[[nodiscard]] std::optional<LogPosition> log_position(const std::string& option,
                                                      const std::string& text);

/// Which kinds of logs there are.
struct GivenLogs {
  bool flight = false;
  bool power = false;
};

/// The effects among `base` that a log of `kind` can show; `own` are those of files.
[[nodiscard]] std::vector<std::string> base_effects(std::span<const std::string> base, LogKind kind,
                                                    std::span<const Effect> own);

/// Throws InputError where --base names what is no effect, or where it or --effects has one of a
/// log that is not given.
void check_effects(std::span<const std::string> base, std::span<const Effect> own, GivenLogs given);

}  // namespace tethercalc
