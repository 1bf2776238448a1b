// The answer of `design`: the best whole design among those that free fields allow.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tethercalc/io/design_request.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc {

/// Opens with the answer, then what binds, how sure it is, the front and the spec.
[[nodiscard]] std::string design_text(const DesignFile& file, const DesignRequest& request,
                                      const DesignStudy& study, const TextStyle& style);
/// The same for programs.
[[nodiscard]] nlohmann::ordered_json design_json(const DesignFile& file,
                                                 const DesignRequest& request,
                                                 const DesignStudy& study);

/// A header and one row: the free fields, whether the design is feasible, and the objective.
[[nodiscard]] std::string design_csv(const DesignRequest& request, const DesignStudy& study);

}  // namespace tethercalc
