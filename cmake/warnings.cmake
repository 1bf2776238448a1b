# Every target of this project is built with these.
add_library(tethercalc_warnings INTERFACE)
target_compile_options(tethercalc_warnings INTERFACE
  -Wall -Wextra -Wconversion -Wshadow -Wpedantic)
# An error with the compiler that the project is held to; others may warn of what nobody has seen yet.
# GCC 12 at -O3 takes "literal" + std::string for overlapping memory (GCC bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(tethercalc_warnings INTERFACE -Wno-restrict)
  if(PROJECT_IS_TOP_LEVEL)
    target_compile_options(tethercalc_warnings INTERFACE -Werror)
  endif()
endif()
