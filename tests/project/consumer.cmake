# Installs the build tree BUILD to a fresh prefix below WORK and uses the result as a stranger would:
# the command from another folder, the library through find_package and through pkg-config, and
# every public header on its own.
#
# cmake -DBUILD=… -DSOURCE=… -DWORK=… -DCXX=… -DPKG_CONFIG=… -DVERSION=… -P consumer.cmake
cmake_minimum_required(VERSION 3.25)
function(run)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "WORKING_DIRECTORY;PRINTS" "COMMAND")
  if(NOT arg_WORKING_DIRECTORY)
    set(arg_WORKING_DIRECTORY "${WORK}")
  endif()
  execute_process(COMMAND ${arg_COMMAND} WORKING_DIRECTORY "${arg_WORKING_DIRECTORY}"
    OUTPUT_VARIABLE printed ERROR_VARIABLE complained RESULT_VARIABLE code)
  list(JOIN arg_COMMAND " " line)
  if(NOT code EQUAL 0)
    message("${printed}${complained}")
    message(FATAL_ERROR "ended with ${code}: ${line}")
  endif()
  if(arg_PRINTS AND NOT printed MATCHES "${arg_PRINTS}")
    message("${printed}${complained}")
    message(FATAL_ERROR "does not print ${arg_PRINTS}: ${line}")
  endif()
  set(printed "${printed}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE "${WORK}")
file(MAKE_DIRECTORY "${WORK}/elsewhere")
set(installed "${WORK}/as installed")
run(COMMAND "${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${installed}")
# Moved after installation: nothing in it may remember where it was put first.
set(prefix "${WORK}/moved")
file(RENAME "${installed}" "${prefix}")

run(COMMAND "${prefix}/bin/tethercalc" list motors WORKING_DIRECTORY "${WORK}/elsewhere"
    PRINTS "holybro-air2216-920kv-10in")

# Where man and the shells look.
foreach(words IN ITEMS
    "man/man1/tethercalc.1=man"
    "bash-completion/completions/tethercalc=completion;bash"
    "zsh/site-functions/_tethercalc=completion;zsh"
    "fish/vendor_completions.d/tethercalc.fish=completion;fish")
  string(REGEX MATCH "^([^=]*)=(.*)$" ignored "${words}")
  file(READ "${prefix}/share/${CMAKE_MATCH_1}" there)
  set(where "${CMAKE_MATCH_1}")
  run(COMMAND "${prefix}/bin/tethercalc" ${CMAKE_MATCH_2})
  if(NOT there STREQUAL printed)
    message(FATAL_ERROR "share/${where} is not what the program prints")
  endif()
endforeach()

# The published optimum (Beffert and Zell, 2025), to every digit printed there.
set(expected "1.09 mm2, 405 W hover, 445 W forward")
run(COMMAND "${CMAKE_COMMAND}" -S "${SOURCE}/tests/consumer" -B "${WORK}/build" -G Ninja
            "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER=${CXX}")
run(COMMAND "${CMAKE_COMMAND}" --build "${WORK}/build")
run(COMMAND "${WORK}/build/consumer" PRINTS "${expected}")

file(GLOB_RECURSE pc_file "${prefix}/*/tethercalc.pc")
get_filename_component(pc_folder "${pc_file}" DIRECTORY)
set(ENV{PKG_CONFIG_PATH} "${pc_folder}")
run(COMMAND "${PKG_CONFIG}" --modversion tethercalc PRINTS "^${VERSION}\n")
run(COMMAND "${PKG_CONFIG}" --cflags --libs tethercalc)
separate_arguments(flags UNIX_COMMAND "${printed}")
run(COMMAND "${CXX}" "${SOURCE}/examples/cpp/optimum.cpp" -o "${WORK}/consumer" ${flags})
run(COMMAND "${WORK}/consumer" PRINTS "${expected}")

run(COMMAND "${PKG_CONFIG}" --cflags tethercalc)
separate_arguments(flags UNIX_COMMAND "${printed}")
file(GLOB_RECURSE headers RELATIVE "${prefix}/include" "${prefix}/include/*.hpp")
foreach(header IN LISTS headers)
  string(MAKE_C_IDENTIFIER "${header}" name)
  file(WRITE "${WORK}/headers/${name}.cpp" "#include <${header}>\n")
  list(APPEND users "${WORK}/headers/${name}.cpp")
endforeach()
run(COMMAND "${CXX}" -fsyntax-only -Wall -Wextra -Wpedantic -Werror ${flags} ${users})
