// A drag fit in the terms of autopilots that estimate the wind from drag.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tethercalc/identify/drag_fit.hpp"

namespace tethercalc {

/// An autopilot whose estimator takes drag as a measurement of the wind.
enum class Autopilot {
  ardupilot,  ///< EKF3, `NavEKF3_core::FuseDragForces`
  px4         ///< EKF2, `Ekf::fuseDrag`
};

/// One of its parameters.
struct AutopilotParameter {
  std::string name;                 ///< as the autopilot spells it
  std::string unit;                 ///< "kg/m²" or "1/s"
  std::optional<Estimate> value{};  ///< nothing where the fit does not determine it
  std::string left_out_because{};   ///< then why
};

/// The same steady flight by the fit and by the autopilot's law.
struct AutopilotDragCheck {
  double airspeed = 0;      ///< m/s
  double tilt = 0;          ///< rad
  double by_fit = 0;        ///< m/s², of drag along the drone's forward axis
  double by_autopilot = 0;  ///< m/s², by the parameters that are not left out
};

/// A fit in an autopilot's terms.
struct AutopilotDrag {
  Autopilot autopilot = Autopilot::ardupilot;  ///< whose terms these are
  std::vector<AutopilotParameter> parameters;  ///< ballistic coefficients X and Y, momentum drag
  std::optional<AutopilotDragCheck> check;     ///< at the fastest speed flown, to a whole m/s
};

/// The parameters by which `autopilot` expects the drag that `fit` found, near level attitude.
///
/// Both expect, along the forward axis of the drone (to the right alike), the specific force
/// −½·ρ·v|v|/B − c·v·s with the ballistic coefficient B (`…_BCOEF_X`), the momentum drag c
/// (`…_MCOEF`) and s = ρ/ρ₀ (ArduPilot, AP_NavEKF3_AirDataFusion.cpp) or √(ρ/ρ₀) (PX4,
/// drag_fusion.cpp), ρ₀ = 1.225 kg/m³. The fit's ½·ρ·A_f·(v|v| + j·v)/m at small tilts is that law
/// with B = m/A_f, to the right m/A_s, and c = ½·ρ·A_f·j/(m·s). Of B the 95 % interval is that of
/// the area turned over, of c it follows from the covariance of A_f and j.
///
/// A parameter is left out where the fit holds what it is made of at a bound, where its area or
/// itself might be zero (95 % interval), where no flight shows the side, and where it lies outside
/// the autopilot's own range.
[[nodiscard]] AutopilotDrag autopilot_drag(const DragFit& fit, Autopilot autopilot);

}  // namespace tethercalc
