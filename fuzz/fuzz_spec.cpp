// Whatever bytes a spec and an override hold, the reader gives a usable design or an InputError.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "io/json_document.hpp"
#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/model/demands.hpp"
#include "tethercalc/model/operating_point.hpp"

namespace {

using namespace tethercalc;

void require(bool holds) {
  if (!holds) std::abort();
}

void require_usable(const DesignFile& file) {
  for (const SpecField& field : spec_fields()) {
    const auto value = field_value(file.design, field);
    if (!value) continue;
    // From the practical unit to SI and back costs a rounding, which may step over the range's end.
    const double slack = 1e-12 * std::fabs(*value);
    require(field.range.contains(*value) || field.range.contains(*value + slack) ||
            field.range.contains(*value - slack));
  }
  require(find_conflicts(file.design).empty());
  require(file.design.drone.motor.vertices().size() >= 3);
  for (const Condition condition : {Condition::hover, Condition::forward}) {
    const OperatingPoint point = evaluate(file.design, 1e-6, condition);
    require(!demand_margins(file.design, point, condition).met() ||
            std::isfinite(point.total_power));
  }
}

/// True where the text might name a file outside the test: by a slash, plain or escaped.
bool may_leave_the_folder(std::string_view text) {
  return text.find('/') != text.npos || text.find("\\u") != text.npos;
}

}  // namespace

// The input is a spec, then, behind a zero byte each, overrides.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  const std::string_view text = rest.substr(0, rest.find('\0'));
  std::vector<std::string> overrides;
  for (std::size_t zero = rest.find('\0'); zero != rest.npos; zero = rest.find('\0')) {
    rest.remove_prefix(zero + 1);
    overrides.emplace_back(rest.substr(0, rest.find('\0')));
  }
  try {
    if (may_leave_the_folder({reinterpret_cast<const char*>(data), size})) {
      (void)parse_json(text, "spec.json");
    } else {
      require_usable(parse_design(text, "spec.json", {}, overrides));
    }
  } catch (const InputError& error) {
    require(!error.problems().empty());
  }
  return 0;
}
