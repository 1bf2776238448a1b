# Every target of this project is built with these; a warning is an error.
add_library(tethercalc_warnings INTERFACE)
target_compile_options(tethercalc_warnings INTERFACE
  -Wall -Wextra -Wconversion -Wshadow -Wpedantic -Werror)
