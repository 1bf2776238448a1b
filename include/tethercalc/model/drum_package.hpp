// The wound part of a tether as one body: how thick it lies on its drum, how much of its surface
// each metre of conductor has, and how warm it is inside.
#pragma once

#include "tethercalc/model/tether.hpp"

namespace tethercalc {

/// A length of tether wound on a cylindrical core between two flanges, as what one of the two
/// conductors has of it, with derivatives by the conductors' radius.
///
/// Geometry: the tether takes a square of side a = √8·(r + s) plus the width of a strength
/// member and a cover, as wires do that lie in a square pattern; a length L fills L·a², in layers
/// between core and outer radius, one layer at least. Flanges closer than a hold one turn a layer.
///
/// Heat inside: made evenly, led off to the outside and to the faces at the flanges, none to the
/// core. Alone, the way outwards leaves the turns at the core q‴/(4k)·(r_o² − r_i² −
/// 2·r_i²·ln(r_o/r_i)) warmer than the surface, the way to the faces leaves the middle q‴·w²/(8k)
/// warmer (steady conduction with a source in an annulus and in a plate: Carslaw and Jaeger,
/// Conduction of Heat in Solids, 2nd ed., sections 7.2 and 3.14); together they leave the product
/// over the sum of both, which is low by at most a seventh (in a square package).
///
/// Conductivity across the wires, unless stated: each wire's metal and insulation λ are one
/// cylinder of λ·(1 + c)/(1 − c), c = r²/(r + s)² (exact for metal that leads heat far better), and
/// those fill π/4 of air of 0.026 W/(m·K) by the lower bound of Hashin and Shtrikman (1962, J.
/// Appl. Phys. 33, 3125–3131, doi:10.1063/1.1728579), which Simpson, Wrobel and Mellor (2013, IEEE
/// Trans. Ind. Appl. 49, 2505–2515, doi:10.1109/TIA.2013.2263271) use for windings. Wires that
/// touch lead a little better, carelessly wound ones worse.
struct DrumPackage {
  double outer_radius = 0;        ///< m, of the package
  double outer_radius_slope = 0;  ///< m of it per m of the conductors' radius
  double layers = 0;              ///< of tether, at least 1, not rounded
  double conductivity = 0;        ///< W/(m·K) across the wires
  double surface = 0;             ///< m² of outside and faces per m of one conductor
  double surface_slope = 0;       ///< per m of the conductors' radius
  double thermal_resistance = 0;  ///< K·m/W: hottest turn over surface, per W/m of a conductor
  double thermal_resistance_slope = 0;  ///< per m of the conductors' radius
};

/// Whether the drum is described well enough for `drum_package`.
[[nodiscard]] bool is_package_known(const Drum& drum);

/// Whether anything is known of how the wound part is cooled: a derating, a package or layers.
[[nodiscard]] bool is_cooling_known(const Drum& drum);

/// m, the side of the square that `tether` takes in its package, and the least width of a drum that
/// holds it, with conductors of `radius` m (≥ 0) in walls of `wall` m.
[[nodiscard]] double wound_side(const Tether& tether, double radius, double wall);

/// m, the radius of the thickest conductors in walls of `wall` m of which the drum's flanges hold a
/// turn; below 0 where they hold none, infinite where no width is stated.
[[nodiscard]] double widest_wound_radius(const Tether& tether, double wall);

/// `length` m (> 0) of `tether` with conductors of `radius` m in walls of `wall` m, on its drum.
[[nodiscard]] DrumPackage drum_package(const Tether& tether, double radius, double wall,
                                       double length);

/// Conductivity in W/(m·K) that is taken for insulation of unknown material: the least of common
/// ones (PVC).
[[nodiscard]] double insulation_conductivity(const Insulation& insulation);

}  // namespace tethercalc
