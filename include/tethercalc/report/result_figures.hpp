// Pictures of results: of designs, of measured flights, and of what the simulation gets wrong.
#pragma once

#include <span>
#include <string>

#include "tethercalc/diagnose/diagnosis.hpp"
#include "tethercalc/report/design_report.hpp"
#include "tethercalc/report/figure.hpp"
#include "tethercalc/study/cable_shape.hpp"
#include "tethercalc/study/drag.hpp"

namespace tethercalc {

/// Thrust (available, necessary and required, per motor) and power from the supply over the
/// conductor's cross-section, in hover and in forward flight. The feasible range is shaded, the
/// least power and the optimum are marked; along the upper edges stand the sizes that can be
/// bought, AWG over thrust and IEC 60228 over power. An infeasible design is drawn as well, with
/// its best headroom marked. The axis is logarithmic where what matters spans more than a factor of
/// eight.
[[nodiscard]] Figure optimum_figure(const std::string& name, const OptimumStudy& study,
                                    const AreaCurve& curve);

/// Efficiency over thrust of every motor in `ranking`, with the thrust that its optimum needs in
/// hover (circle), the thrust demanded with headroom (dot) and, where the least power decides, the
/// thrust in the condition in which power is judged (plus).
[[nodiscard]] Figure motors_figure(const DesignFile& file, std::span<const MotorOptimum> ranking);

/// "at 8 m/s: …" of each cable without a shape, with why.
[[nodiscard]] std::vector<std::string> undrawn_sentences(std::span<const ShapeRequest> requests,
                                                         std::span<const ShapeStudy> studies);

/// The cable as it hangs, from the side and, where a wind presses it aside, from above, to scale,
/// one line a request (as `studies`, at most 35). Those without a shape are left out and named in
/// the description. Throws std::invalid_argument where none has one.
[[nodiscard]] Figure shape_figure(const std::string& name, std::span<const ShapeRequest> requests,
                                  std::span<const ShapeStudy> studies);

/// Over time: the forward acceleration expected from the attitude and the one observed; the drag
/// per mass, which is their difference; and the forward speed that it follows. `name` is the log's.
[[nodiscard]] Figure log_figure(const std::string& name, const Observations& flight);

/// Over airspeed: measured drag, the fitted model at every sample, its line in steady flight with
/// the 95 % interval and the line without a linear term; below, what the fit leaves. Long flights
/// are thinned evenly to 700 samples.
[[nodiscard]] Figure drag_figure(const DragStudy& drag);

/// Over airspeed and tilt: the fitted drag as a surface, steady flight as a line in it, and the
/// measured drag as dots, with stalks to the surface where they are farthest from it.
[[nodiscard]] Figure drag_surface_figure(const DragStudy& drag);

/// From top to bottom: for every compared quantity, predicted against measured before and after the
/// findings, held out; for every finding, what is left of the measurement without and with it,
/// against the channel that gave it away, as dots and as means over equally many samples; and the
/// error budget, its findings in the order of the chain. `name` is the log's. Needs
/// `diagnosis.compared`, which logs too short to judge do not have: throws std::invalid_argument.
[[nodiscard]] Figure diagnosis_figure(const std::string& name, const Diagnosis& diagnosis);

}  // namespace tethercalc
