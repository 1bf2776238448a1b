// What the page may ask, an ask a function.
#pragma once

#include <span>
#include <string_view>

#include "page/request.hpp"

namespace tethercalc::page {

struct Ask {
  std::string_view name;
  ordered_json (*answer)(const Request& request);
};

/// What the calculator knows without a spec: its fields, its library, examples.
[[nodiscard]] ordered_json about(const Request& request);

/// The page of a code of the answers, as `explain` prints it.
[[nodiscard]] ordered_json explain(const Request& request);

/// Those about designs, and about specs and their files.
[[nodiscard]] std::span<const Ask> design_asks();

/// Those about logs.
[[nodiscard]] std::span<const Ask> log_asks();

}  // namespace tethercalc::page
