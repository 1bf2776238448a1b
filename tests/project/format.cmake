# Every C++ file of ROOT is laid out as .clang-format says. Versions of clang-format differ in
# detail, so only Debian 12's (14) is asked.
#
# cmake -DROOT=… -P format.cmake
cmake_minimum_required(VERSION 3.25)
find_program(clang_format NAMES clang-format-14 clang-format)
if(clang_format)
  execute_process(COMMAND "${clang_format}" --version OUTPUT_VARIABLE version)
endif()
if(NOT version MATCHES "version 14\\.")
  message("SKIPPED: clang-format 14 is not installed")
  return()
endif()

file(GLOB_RECURSE files "${ROOT}/include/*.hpp" "${ROOT}/src/*.[ch]pp" "${ROOT}/tests/*.[ch]pp"
  "${ROOT}/fuzz/*.[ch]pp" "${ROOT}/python/*.[ch]pp" "${ROOT}/bench/*.[ch]pp")
execute_process(COMMAND "${clang_format}" --dry-run -Werror ${files}
  RESULT_VARIABLE code ERROR_VARIABLE differences)
if(NOT code EQUAL 0)
  string(REGEX MATCHALL "[^\n]*: error:" places "${differences}")
  list(TRANSFORM places REPLACE "^(.*):[0-9]+:[0-9]+: error:" "\\1")
  list(REMOVE_DUPLICATES places)
  list(JOIN places " " places)
  message("${differences}")
  message(FATAL_ERROR "Put right with: clang-format -i ${places}")
endif()
