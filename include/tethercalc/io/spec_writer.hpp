// A design back into the spec it was read from.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tethercalc/identify/drag_fit.hpp"
#include "tethercalc/io/design_reader.hpp"

namespace tethercalc {

/// The document of `file` with every field in which `design` differs from the one that was read
/// written over; everything else stays as it stands there. Read again it is `design`, number by
/// number: each is written with as few digits as give it back.
///
/// A motor or material is written as the library's name, or as `references` calls it (by the path
/// of its field: {"drone.motor", "motors/mine.csv"}, a name or file as specs hold it) where that is
/// what it is; otherwise as an object with its numbers.
///
/// Whether the values are in range is not looked at: `read_design_document` does.
[[nodiscard]] nlohmann::ordered_json spec_with(
    const DesignFile& file, const Design& design,
    const std::map<std::string, std::string>& references = {});

/// The document of `file` with the drag that flights show in place of its own, checked as if a
/// person had edited it; the asymmetry, which `fit` knows nothing of, stays.
[[nodiscard]] nlohmann::ordered_json spec_with_drag(const DesignFile& file, const DragFit& fit);

}  // namespace tethercalc
