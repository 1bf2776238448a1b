// One field of a spec changed in its text, the rest left as somebody laid it out.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace tethercalc {

/// `text`, a spec called `file` in messages, with `value` at `path` ("supply.voltage_V" or
/// "/supply/voltage_V"; "drone.motor/points/2/thrust_g" within lists and objects). Where there was
/// none it comes last in its group, indented as its neighbours are, groups that are missing around
/// it. A null takes an optional field away, and nothing else changes where there is none.
///
/// The value is left to the reader, as are other faults of the spec. Throws InputError where the
/// text is no JSON object, where no spec has such a field (with the closest that one has), and
/// where the way leads through what is no object or list.
[[nodiscard]] std::string spec_with_value(std::string_view text, const std::string& file,
                                          const std::string& path,
                                          const nlohmann::ordered_json& value);

}  // namespace tethercalc
