// How a cable of 1.5 mm² with 5 % of slack hangs in 8 m/s of wind, and what the drone feels when it
// drifts a metre with it.
#include <cstdio>
#include <tethercalc/files/read_files.hpp>
#include <tethercalc/study/cable_shape.hpp>

using namespace tethercalc;

int main(int, char** argv) {
  const Design design = read_design(argv[1]).design;
  const double area = 1.5 * unit::square_millimetre;
  ShapeRequest request{.height = design.tether.length, .wind = 8};
  request.paid_out.length = 1.05 * request.height;
  const ShapeStudy study = study_cable_shape(design, area, request);
  if (study.outcome != CableOutcome::hangs) return 1;
  std::printf("tension %.2f N at the drone, %.1f W instead of %.1f W\n",
              study.loads.tension_at_drone, study.solved.total_power, study.straight.total_power);
  // A controller keeps the solver: each answer starts from the last.
  CableSolver solver;
  solver.solve(study.cable, study.air, request.paid_out, study.drone);
  const Vector3 before = solver.result().on_drone;
  const Vector3 slope = solver.derivatives().by_position[0];
  solver.solve(study.cable, study.air, request.paid_out,
               {study.drone.x - 1, study.drone.y, study.drone.z});
  std::printf("a metre with the wind: %+.2f N along x, %+.2f N by the derivative\n",
              solver.result().on_drone.x - before.x, -slope.x);
}
