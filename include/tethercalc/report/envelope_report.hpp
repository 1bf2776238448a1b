// The answer of `envelope`: how high, how heavy, how fast and in how much wind a given cable flies.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/report/text_table.hpp"
#include "tethercalc/study/envelope.hpp"

namespace tethercalc {

/// A sentence a reach, then a table a curve.
[[nodiscard]] std::string envelope_text(const DesignFile& file, const EnvelopeStudy& study,
                                        const TextStyle& style);

/// `greatest` {`height_m`, `payload_g`, `headwind_m_s`, `airspeed_m_s`: {`value`, `limited_by`,
/// `limiting_condition`, `sentence`}}, `curves` [{`of`, `against`, `points`}].
[[nodiscard]] nlohmann::ordered_json envelope_json(const DesignFile& file,
                                                   const EnvelopeStudy& study);

/// A row a point of a curve.
[[nodiscard]] std::string envelope_csv(const EnvelopeStudy& study);

}  // namespace tethercalc
