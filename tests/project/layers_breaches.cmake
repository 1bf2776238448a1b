# Proves that layers.cmake can fail: a tree that keeps the rules passes, and each single breach of
# one is named.
#
# cmake -DWORK=… -P layers_breaches.cmake
cmake_minimum_required(VERSION 3.25)
function(check_layers result complaint)
  execute_process(COMMAND "${CMAKE_COMMAND}" "-DROOT=${WORK}" -P "${CMAKE_CURRENT_LIST_DIR}/layers.cmake"
    RESULT_VARIABLE code ERROR_VARIABLE text)
  string(REGEX REPLACE "[ \n]+" " " text "${text}")
  set(${result} ${code} PARENT_SCOPE)
  set(${complaint} "${text}" PARENT_SCOPE)
endfunction()

function(write_lawful_tree)
  file(REMOVE_RECURSE "${WORK}")
  file(WRITE "${WORK}/include/tethercalc/io/spec.hpp"
    "#include <nlohmann/json_fwd.hpp>\n#include <vector>\n#include \"tethercalc/model/design.hpp\"\n")
  file(WRITE "${WORK}/include/tethercalc/model/design.hpp" "#include <memory>\n")
  file(WRITE "${WORK}/src/solve/optimum.cpp" "#include <Eigen/Core>\n#include \"solve/bracket.hpp\"\n")
  file(WRITE "${WORK}/src/solve/bracket.hpp" "#include <cmath>\n")
  file(WRITE "${WORK}/src/files/files.cpp" "#include <unistd.h>\n#include <thread>\n#include \"tethercalc/io/spec.hpp\"\n")
  file(WRITE "${WORK}/src/cli/main.cpp" "#include <CLI/CLI.hpp>\n#include <csignal>\n#include \"files/files.hpp\"\n")
endfunction()

write_lawful_tree()
check_layers(code complaint)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "a lawful tree is refused:\n${complaint}")
endif()

function(expect_breach file content expected)
  write_lawful_tree()
  file(WRITE "${WORK}/${file}" "${content}\n")
  check_layers(code complaint)
  if(code EQUAL 0 OR NOT complaint MATCHES "${expected}")
    message(SEND_ERROR "${file} with '${content}' passes or is blamed for something else:\n${complaint}")
  endif()
endfunction()

expect_breach(src/model/tether.cpp "#include \"io/spec.hpp\"" "includes io/spec.hpp, a room above it")
expect_breach(src/report/x.cpp "#include \"tethercalc/solve/optimum.hpp\"" "report words what studies answer")
expect_breach(include/tethercalc/solve/x.hpp "  # include <tethercalc/report/table.hpp>" "a room above it")
expect_breach(src/diagnose/x.cpp "#include <nlohmann/json.hpp>" "JSON belongs to")
expect_breach(src/io/x.cpp "#include <filesystem>" "operating systems belong to")
expect_breach(include/tethercalc/solve/x.hpp "#include <thread>" "operating systems belong to")
expect_breach(src/report/x.cpp "#include <sys/wait.h>" "operating systems belong to")
expect_breach(src/cli/sweep.cpp "#include <CLI/App.hpp>" "exactly one")
expect_breach(src/cli/main.cpp "" "exactly one")
expect_breach(src/helpers/x.cpp "" "no room 'helpers'")
expect_breach(src/x.cpp "" "is in no room")
expect_breach(include/tethercalc/solve/x.hpp "#include <Eigen/Core>" "a private dependency")
expect_breach(include/tethercalc/solve/x.hpp "#include \"solve/bracket.hpp\"" "not installed")
