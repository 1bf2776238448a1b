#include "io/log_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "io/closest_name.hpp"
#include "tethercalc/diagnose/hypothesis.hpp"
#include "tethercalc/io/input_error.hpp"

namespace tethercalc {
namespace {

[[noreturn]] void fail_without_log(const char* option, const std::string& id, LogKind kind) {
  const bool flight = kind == LogKind::flight;
  throw InputError(option,
                   fmt::format("\"{}\" is an effect of {} logs; give one with {}", id,
                               flight ? "flight" : "power", flight ? "--flight" : "--power"));
}

}  // namespace

std::optional<LogPosition> log_position(const std::string& option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const std::string suffix = end;
  if (end == text.c_str() || !std::isfinite(value) ||
      !(suffix.empty() || suffix == "s" || suffix == "%")) {
    throw InputError(option,
                     "\"" + text +
                         "\" is not a place in a log; allowed are seconds (120 or 120s) and "
                         "percent of the samples (25%)");
  }
  return LogPosition{value, suffix == "%"};
}

std::vector<std::string> base_effects(std::span<const std::string> base, LogKind kind,
                                      std::span<const Effect> own) {
  std::vector<std::string> chosen;
  for (const Effect* effect : effects_for(kind, own)) {
    if (std::ranges::find(base, effect->id) != base.end()) {
      chosen.push_back(effect->id);
    }
  }
  return chosen;
}

void check_effects(std::span<const std::string> base, std::span<const Effect> own,
                   GivenLogs given) {
  const auto is_given = [&](LogKind kind) {
    return kind == LogKind::flight ? given.flight : given.power;
  };
  for (const Effect& effect : own) {
    if (!is_given(effect.log)) fail_without_log("--effects", effect.id, effect.log);
  }
  std::vector<std::string> known;
  for (const LogKind kind : {LogKind::flight, LogKind::power}) {
    for (const Effect* effect : effects_for(kind, own)) {
      if (is_given(kind)) known.push_back(effect->id);
    }
  }
  for (const std::string& id : base) {
    if (std::find(known.begin(), known.end(), id) != known.end()) continue;
    if (const Effect* effect = find_effect(id)) fail_without_log("--base", id, effect->log);
    throw InputError("--base", fmt::format("\"{}\" is not an effect; allowed are {}{}", id,
                                           fmt::join(known, ", "), did_you_mean(id, known)));
  }
}

}  // namespace tethercalc
