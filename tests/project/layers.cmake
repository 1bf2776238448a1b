# Holds the rooms of ROOT apart: a room includes only rooms below it (model at the bottom, cli on
# top), JSON stays at the edge, CLI11 in one file, only the rooms files and cli need an operating
# system, and a public header needs no library that the installed package does not bring.
#
# cmake -DROOT=… -P layers.cmake
cmake_minimum_required(VERSION 3.25)
set(rooms model solve identify diagnose study io report files cli)
set(json_rooms io report files cli)
# Files, processes, threads and signals; <iostream> and <cstdio> bring the standard streams.
set(host_rooms files cli)
string(JOIN "|" host_headers filesystem fstream iostream cstdio thread mutex shared_mutex
  condition_variable future semaphore barrier latch stop_token csignal "[a-z]+\\.h" "sys/.*")
set(problems "")
set(cli11_files "")

file(GLOB_RECURSE files RELATIVE "${ROOT}" "${ROOT}/include/*.hpp" "${ROOT}/src/*.hpp" "${ROOT}/src/*.cpp")
foreach(file IN LISTS files)
  if(NOT file MATCHES "^(include/tethercalc|src)/([a-z_]+)/.")
    list(APPEND problems "${file} is in no room")
    continue()
  endif()
  set(folder "${CMAKE_MATCH_1}")
  set(room "${CMAKE_MATCH_2}")
  list(FIND rooms ${room} height)
  if(height EQUAL -1)
    list(APPEND problems "${file}: there is no room '${room}'")
    continue()
  endif()

  file(STRINGS "${ROOT}/${file}" includes REGEX "^[ \t]*#[ \t]*include[ \t]*[<\"]")
  foreach(line IN LISTS includes)
    string(REGEX REPLACE ".*include[ \t]*[<\"]([^>\"]+).*" "\\1" included "${line}")
    if(included MATCHES "^(${host_headers})$" AND NOT room IN_LIST host_rooms)
      list(APPEND problems "${file} (room ${room}) includes ${included}: operating systems belong to ${host_rooms}")
    endif()
    if(included MATCHES "^(tethercalc/)?([a-z_]+)/" AND CMAKE_MATCH_2 IN_LIST rooms)
      list(FIND rooms ${CMAKE_MATCH_2} included_height)
      if(included_height GREATER height)
        list(APPEND problems "${file} (room ${room}) includes ${included}, a room above it")
      endif()
      if(folder STREQUAL "include/tethercalc" AND NOT included MATCHES "^tethercalc/")
        list(APPEND problems "${file} is public and includes ${included}, which is not installed")
      endif()
    elseif(included MATCHES "^nlohmann/" AND NOT room IN_LIST json_rooms)
      list(APPEND problems "${file} (room ${room}) includes ${included}: JSON belongs to ${json_rooms}")
    elseif(included MATCHES "^CLI/")
      list(APPEND cli11_files "${file}")
    elseif(included MATCHES "/" AND folder STREQUAL "include/tethercalc"
           AND NOT included MATCHES "^nlohmann/")
      list(APPEND problems "${file} is public and includes ${included}, a private dependency")
    endif()
  endforeach()
endforeach()

list(REMOVE_DUPLICATES cli11_files)
list(LENGTH cli11_files cli11_count)
if(NOT cli11_count EQUAL 1 OR NOT cli11_files MATCHES "^src/cli/.*\\.cpp$")
  list(APPEND problems "CLI11 takes 10 s to compile: exactly one src/cli/*.cpp may include it, not: ${cli11_files}")
endif()

if(problems)
  list(JOIN problems "\n  " text)
  message(FATAL_ERROR "  ${text}")
endif()
