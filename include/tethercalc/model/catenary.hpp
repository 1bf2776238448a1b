// A cable between two points in still air, in closed form.
#pragma once

#include <optional>

namespace tethercalc {

/// A cable that hangs by its weight alone, in the vertical plane through its ends: x horizontally
/// from the ground end towards the other, z up; H and V are the parts of the tension along the
/// cable, directed from the ground end on.
struct Catenary {
  double horizontal = 0;         ///< N, H ≥ 0, the same everywhere
  double vertical_at_start = 0;  ///< N, V at the ground end; < 0: it leaves downwards
  double vertical_at_end = 0;    ///< N, at the other end
};

/// The catenary of a cable of `length` m (> 0, without tension), `weight` N/m of that length (> 0)
/// and stiffness EA = `axial_stiffness` in N (> 0; nothing: it does not stretch), between (0, 0)
/// and (`x`, `z`) in m, x ≥ 0. Nothing where it does not reach and does not stretch. With x = 0 and
/// length to spare it hangs as a fold, H = 0.
///
/// Unstretched: 2a·sinh(x/2a) = √(L² − z²), H = w·a, V = w/2·(z·coth(x/2a) − L) at the start
/// (Irvine 1981, "Cable Structures", 1.2). Elastic: x = H·L/EA + H/w·[asinh(V/H)], z = (V1² −
/// V0²)/(2w·EA) + [√(H² + V²)]/w (ibid. 1.3). Correct to a few times the digits that the difference
/// of length and distance leaves.
[[nodiscard]] std::optional<Catenary> catenary(double x, double z, double length, double weight,
                                               std::optional<double> axial_stiffness = {});

/// How a catenary's tension at both ends changes with its end's place.
struct CatenaryStiffness {
  double horizontal_by_x = 0;  ///< N/m, ∂H/∂x
  double horizontal_by_z = 0;  ///< ∂H/∂z = ∂V/∂x
  double vertical_by_z = 0;    ///< ∂V/∂z
};

/// The stiffness of `catenary(…)`, by the derivatives of its equations; of a fold, the limit.
[[nodiscard]] CatenaryStiffness catenary_stiffness(const Catenary& shape, double length,
                                                   double weight,
                                                   std::optional<double> axial_stiffness = {});

/// A point of a cable.
struct CatenaryPoint {
  double x = 0;        ///< m
  double z = 0;        ///< m
  double tension = 0;  ///< N
};

/// The point `s` m along the unstretched cable from its start.
[[nodiscard]] CatenaryPoint catenary_point(const Catenary& shape, double s, double weight,
                                           std::optional<double> axial_stiffness = {});

}  // namespace tethercalc
