// Where in a spec something may stand.
#pragma once

#include <string>
#include <string_view>

namespace tethercalc {

/// "/supply/voltage_V" of "supply.voltage_V"; what begins with a slash is one already.
[[nodiscard]] std::string pointer_of(std::string_view dotted);

/// Whether what `pointer` leads to is `top` or within it.
[[nodiscard]] bool is_at_or_below(std::string_view pointer, std::string_view top);

/// Whether some spec may have a value at `pointer`: a field, a group of them, or what stands within
/// the object or list of a field.
[[nodiscard]] bool may_be_in_spec(std::string_view pointer);

}  // namespace tethercalc
