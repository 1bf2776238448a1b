#include "identify/slow_log.hpp"

#include <fmt/format.h>

namespace tethercalc {

std::optional<Warning> slow_log_warning(double step) {
  constexpr double slowest = 0.75;  // s; two a second, and jitter
  if (!(step > slowest)) return std::nullopt;
  return Warning{WarningKind::log_slow,
                 fmt::format("one sample every {:.3g} s: what the drone did between them is lost, "
                             "and drag with it; log twice a second or faster",
                             step)};
}

}  // namespace tethercalc
