# Every target of this project is built with these; in the build with tests a warning is an error.
# Sanitizers rewrite code and have compilers warn of what nobody wrote: there it is none.
add_library(tethercalc_warnings INTERFACE)
target_compile_options(tethercalc_warnings INTERFACE
  -Wall -Wextra -Wconversion -Wshadow -Wpedantic)
if(TETHERCALC_BUILD_TESTS AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  target_compile_options(tethercalc_warnings INTERFACE -Werror)
endif()
# GCC 12 at -O3 takes "literal" + std::string for overlapping memory (GCC bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(tethercalc_warnings INTERFACE -Wno-restrict)
endif()
