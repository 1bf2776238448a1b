#include "io/log_damage.hpp"

#include <fmt/format.h>

namespace tethercalc {

void note_damage(const LogContents& contents, std::vector<std::string>& notes) {
  if (contents.skipped_bytes > 0) {
    notes.push_back(
        fmt::format("the log is damaged or cut: {} bytes and at least {} message{} were skipped",
                    contents.skipped_bytes, contents.skipped_messages,
                    contents.skipped_messages == 1 ? "" : "s"));
  }
  notes.insert(notes.end(), contents.rejected_definitions.begin(),
               contents.rejected_definitions.end());
}

}  // namespace tethercalc
