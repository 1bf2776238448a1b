#include "tethercalc/study/diagnosis.hpp"

#include <algorithm>
#include <utility>

#include "study/as_flown.hpp"
#include "tethercalc/model/units.hpp"
#include "tethercalc/solve/optimize.hpp"

namespace tethercalc {
namespace {

/// The optimum of one conductor and the supply power there; neither where there is none.
void record(const Design& design, std::optional<double>& area, std::optional<double>& power) {
  const Optimization result = optimize(design);
  if (!result.feasible) return;
  const bool hover = design.requirements.power_at == Condition::hover;
  area = result.area / unit::square_millimetre;
  power = (hover ? result.hover : result.forward).total_power;
}

/// What `diagnose` says, which throws std::invalid_argument where the log will not do.
template <typename Diagnose>
auto of_suitable(LogKind kind, const Diagnose& diagnose) {
  try {
    return diagnose();
  } catch (const std::invalid_argument& error) {
    throw UnsuitableLog(kind, error.what());
  }
}

Warning no_tilt() {
  return {WarningKind::tilt_missing,
          "the flight is too short to say how the drone leans, so mass and motors are told apart "
          "by the "
          "power alone"};
}

/// What was found of the design as it flew, in the design itself: only the day's own mass and air
/// are not its.
Design as_designed(Design found, const Design& flown, const Design& design) {
  found.drone.mass += design.drone.mass - flown.drone.mass;
  found.flight.air_density *= design.flight.air_density / flown.flight.air_density;
  return found;
}

/// `drag` with what a flight says of it.
AirframeDrag with_changes(AirframeDrag drag, const std::vector<SpecChange>& changes) {
  const std::pair<std::string_view, double*> members[] = {
      {"drone.drag.front_area_m2", &drag.front_area},
      {"drone.drag.top_area_m2", &drag.top_area},
      {"drone.drag.linear_m_s", &drag.linear_speed},
      {"drone.drag.fore_aft_asymmetry", &drag.fore_aft_asymmetry}};
  for (const SpecChange& change : changes) {
    for (const auto& [field, member] : members) {
      if (change.field == field) *member = change.value;
    }
  }
  drag.is_estimate = drag.is_estimate && changes.empty();
  return drag;
}

}  // namespace

FlightDiagnosisOptions flight_options(const DiagnosisQuestion& question) {
  FlightDiagnosisOptions options = question.flight->options;
  options.hypotheses.insert(options.hypotheses.end(), question.hypotheses.begin(),
                            question.hypotheses.end());
  return options;
}

DesignImpact design_impact(const Design& before, const Design& after) {
  DesignImpact impact;
  record(before, impact.cross_section_mm2.before, impact.total_power_W.before);
  record(after, impact.cross_section_mm2.after, impact.total_power_W.after);
  return impact;
}

DiagnosisStudy study_diagnosis(const DiagnosisQuestion& question,
                               const SelectionProgress& progress) {
  const Design& design = question.design;
  DiagnosisStudy study{{}, {}, design};
  if (const auto& flight = question.flight) {
    study.flight = of_suitable(LogKind::flight, [&] {
      return diagnose_flights(as_flown(design, *flight), flight->flights, flight_options(question),
                              progress);
    });
  }
  bool keeps_drag = false;
  if (const auto& power = question.power) {
    const bool one_flight = question.one_flight && study.flight;
    Design flown = as_flown(design, *power);
    std::optional<DragByTilt> tilt;
    if (one_flight) {
      flown = as_flown(flown, *question.flight);
      tilt = study.flight->drag_by_tilt;
    }
    PowerDiagnosis found = of_suitable(LogKind::power, [&] {
      return diagnose_power(flown, power->log, power->base, progress, question.hypotheses, tilt);
    });
    study.power = std::move(found.diagnosis);
    study.extended = as_designed(std::move(found.extended), flown, design);
    // The power log's model holds the drag that the tilt of the same flight shows, or the tilt
    // tells none from it.
    keeps_drag =
        study.power->drag_by_tilt.has_value() ||
        std::ranges::count(study.power->notes, WarningKind::tilt_tells_nothing, &Warning::kind) > 0;
    if (one_flight && !tilt) study.power->notes.push_back(no_tilt());
  }
  if (study.flight && !study.flight->spec_changes.empty() && !keeps_drag) {
    study.extended.drone.drag = with_changes(design.drone.drag, study.flight->spec_changes);
  }
  if (study.flight && study.power) {
    // What a flight can never show the power log may.
    std::erase_if(study.flight->not_identifiable, [](const NotIdentifiable& n) {
      const Effect* effect = find_effect(n.effect);
      return effect != nullptr && effect->log == LogKind::power;
    });
  }
  std::optional<Diagnosis>& last = study.power ? study.power : study.flight;
  if (last) last->design_impact = design_impact(design, study.extended);
  return study;
}

}  // namespace tethercalc
