// Whatever bytes a spec holds, its page is whole or refused, and holds nothing that a browser would
// fetch or run.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/library.hpp"
#include "tethercalc/report/report_page.hpp"

namespace {

using namespace tethercalc;

void require(bool holds) {
  if (!holds) std::abort();
}

/// True where the text might name a file outside the test: by a slash, plain or escaped.
bool may_leave_the_folder(std::string_view text) {
  return text.find('/') != text.npos || text.find("\\u") != text.npos;
}

/// No tag of the page is a script, and none has a reference to somewhere else.
void require_quiet(const std::string& page) {
  require(page.ends_with("</html>\n"));
  for (std::size_t at = page.find('<'); at != page.npos; at = page.find('<', at + 1)) {
    const std::string_view tag = std::string_view(page).substr(at, page.find('>', at) - at);
    require(!tag.starts_with("<script"));
    for (const char* fetching : {" src=", " onload=", " onclick=", "href=\"http"}) {
      require(tag.find(fetching) == tag.npos);
    }
  }
}

void make_page(const std::string& text) {
  const DesignFile file = parse_design(text, "spec.json");
  const std::vector<MotorEntry> all = library_motors();
  require_quiet(
      report_page({study_overview(file.design, wire_sizes(), {all.begin(), all.begin() + 2}),
                   file,
                   {},
                   {},
                   {},
                   "tethercalc report spec.json"}));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (may_leave_the_folder(text)) return 0;
  try {
    make_page(text);
  } catch (const InputError& error) {
    require(!error.problems().empty());
  }
  return 0;
}
