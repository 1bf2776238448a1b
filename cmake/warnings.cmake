# Every target of this project is built with these; in the build with tests a warning is an error.
add_library(tethercalc_warnings INTERFACE)
target_compile_options(tethercalc_warnings INTERFACE
  -Wall -Wextra -Wconversion -Wshadow -Wpedantic)
# Optimisers and sanitizers see code that nobody wrote and warn of it; the suite's own build decides.
if(TETHERCALC_BUILD_TESTS AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  target_compile_options(tethercalc_warnings INTERFACE -Werror)
endif()
# GCC warns of uninitialized members inside std::regex, std::optional and the like as soon as
# sanitizers rewrite the code (GCC bug 105562). The builds without sanitizers keep the warning.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  target_compile_options(tethercalc_warnings INTERFACE -Wno-maybe-uninitialized)
endif()
# GCC 12 at -O3 takes "literal" + std::string for overlapping memory (GCC bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(tethercalc_warnings INTERFACE -Wno-restrict)
endif()
