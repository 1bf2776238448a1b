#include "io/log_damage.hpp"

#include <fmt/format.h>

namespace tethercalc {

std::string samples_left_out(std::size_t count) {
  return fmt::format("{} sample{} left out", count, count == 1 ? "" : "s");
}

void note_damage(const LogContents& contents, std::vector<Warning>& notes) {
  if (contents.skipped_bytes > 0) {
    notes.push_back(
        {WarningKind::log_damaged,
         fmt::format("the log is damaged or cut: {} bytes and at least {} message{} were skipped",
                     contents.skipped_bytes, contents.skipped_messages,
                     contents.skipped_messages == 1 ? "" : "s")});
  }
  for (const std::string& sentence : contents.rejected_definitions) {
    notes.push_back({WarningKind::log_definition_rejected, sentence});
  }
}

}  // namespace tethercalc
