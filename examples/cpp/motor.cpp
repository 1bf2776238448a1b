// What a motor that is known by its propeller alone would draw, and how far that may be off.
#include <cstdio>
#include <tethercalc/io/library.hpp>
#include <tethercalc/study/motor.hpp>

using namespace tethercalc;

int main() {
  const FigureOfMeritSpread measured = figure_of_merit_spread(library_motors());
  const GenericMotorRequest request{
      .diameter = 10 * metres_per_inch, .figure_of_merit = measured.median, .max_thrust = 12};
  const double power = generic_motor_curve(request).power(5);
  const double ideal = ideal_hover_power(5, request.diameter, request.air_density);
  std::printf("5 N take %.0f W, %.0f W with an ideal propeller, give or take %.0f %%\n", power,
              ideal, 100 * measured.power_band);
}
