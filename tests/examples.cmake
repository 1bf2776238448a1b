# The programs of examples/cpp as tests.
add_subdirectory("${PROJECT_SOURCE_DIR}/examples/cpp" examples)
function(add_example_test name inputs printed)
  add_dependencies(test_programs example_${name})
  add_test(NAME "examples: ${name}" COMMAND example_${name} ${inputs})
  set_tests_properties("examples: ${name}" PROPERTIES PASS_REGULAR_EXPRESSION "${printed}")
endfunction()
set(published "${PROJECT_SOURCE_DIR}/examples/holybro-x500.json")
add_example_test(optimum "" "1.09 mm2, 405 W hover, 445 W forward")
add_example_test(evaluation "${published}" "1.00 mm2.*thrust_headroom\n1.50 mm2.*will do")
add_example_test(sizes "${published}" "optimum: 1.0886 mm2.*AWG 16: .* will do")
add_example_test(comparison "${published}" "holybro-air2216-920kv-10in: 1.0886 mm2, 444.9 W forward")
add_example_test(sweep "${published}" " 75 V 30 m: 1.0886 mm2, 444.9 W")
add_example_test(design "${published}" "120.0 V, aluminium.*one metre more: [+]")
add_example_test(envelope "${published}" "greatest height m: .*greatest airspeed m/s: ")
add_example_test(cable_shape "${published}" "tension .* instead of .*\na metre with the wind: ")
add_example_test(reference "${published}" "forward.total_power_W as recorded")
add_example_test(rules "${published}" "point \\(4\\) tether-length: pass")
# An ideal propeller of 10 inches: (5 N)^1.5 over the root of 2·ρ·A; a motor's part of the hover: 1710 g and
# (310 W - 15 W) over four.
add_example_test(motor "" "5 N take [0-9]+ W, 32 W with an ideal propeller")
add_example_test(flown_motor "${published}" "hover: 4.19 N and 73.8 W a motor")
add_example_test(drag "${PROJECT_SOURCE_DIR}/examples/simulated-flight.csv" "front_area_m2: .*rmse ")
add_example_test(diagnosis "${published};${PROJECT_SOURCE_DIR}/examples/simulated-flight.csv"
  "found: .*power at the optimum: ")
add_example_test(next_flight "${published};${PROJECT_SOURCE_DIR}/examples/simulated-flight.csv"
  "manoeuvres, .* minutes\n(settles|leaves open): ")
