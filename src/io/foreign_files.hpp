// What a file is that is no log of an autopilot, by its content.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace tethercalc {

/// What it is, as the end of a sentence: "is a MAVLink telemetry log (.tlog), ...". Empty where
/// nothing known is recognised.
[[nodiscard]] std::string foreign_kind(std::span<const std::byte> content);

}  // namespace tethercalc
