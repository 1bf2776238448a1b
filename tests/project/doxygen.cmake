# Doxygen reads the public headers without a warning: nothing public is undocumented, and no comment
# names a parameter that does not exist.
#
# cmake -DROOT=… -P doxygen.cmake
cmake_minimum_required(VERSION 3.25)
find_program(doxygen doxygen)
if(NOT doxygen)
  message("SKIPPED: doxygen is not installed")
  return()
endif()
file(MAKE_DIRECTORY "${ROOT}/build")
execute_process(COMMAND "${doxygen}" docs/Doxyfile WORKING_DIRECTORY "${ROOT}"
  RESULT_VARIABLE code OUTPUT_QUIET ERROR_VARIABLE warnings)
if(NOT code EQUAL 0 OR NOT warnings STREQUAL "")
  message("${warnings}")
  message(FATAL_ERROR "doxygen docs/Doxyfile complains")
endif()
