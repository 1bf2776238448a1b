// The answer of `envelope`: how high, how heavy, how fast and in how much wind a given cable flies.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/report/text_table.hpp"
#include "tethercalc/solve/envelope.hpp"

namespace tethercalc {

/// One reach and its end.
struct ReachResult {
  Reach reach = Reach::height;  ///< which
  std::optional<ReachEnd> end;  ///< nothing: the cable flies at no value of it
};

/// The greatest of one reach against another.
struct EnvelopeCurve {
  Reach of = Reach::payload;          ///< what is pushed as far as it goes
  Reach against = Reach::height;      ///< at values of this
  std::vector<EnvelopePoint> points;  ///< by rising `against`
};

/// Everything `envelope` says.
struct EnvelopeStudy {
  DesignFile file;                    ///< what was asked about
  std::vector<ReachResult> greatest;  ///< each with the others as the spec has them
  std::vector<EnvelopeCurve> curves;  ///< payload and wind against height, payload against wind

  /// Whether the cable flies at all.
  [[nodiscard]] bool any() const;
};

/// For a design with a cross-section.
[[nodiscard]] EnvelopeStudy study_envelope(DesignFile file);

/// A sentence a reach, then a table a curve.
[[nodiscard]] std::string envelope_text(const EnvelopeStudy& study, const TextStyle& style);

/// `greatest` {`height_m`, `payload_g`, `headwind_m_s`, `airspeed_m_s`: {`value`, `limited_by`,
/// `limiting_condition`, `sentence`}}, `curves` [{`of`, `against`, `points`}].
[[nodiscard]] nlohmann::ordered_json envelope_json(const EnvelopeStudy& study);

/// A row a point of a curve.
[[nodiscard]] std::string envelope_csv(const EnvelopeStudy& study);

}  // namespace tethercalc
