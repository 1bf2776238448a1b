# Debian packages, by `cpack` in the build folder: the program, the library, and the Python package
# where that is built. Their folders are Debian's where CMAKE_INSTALL_PREFIX is /usr.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME tethercalc)
set(CPACK_PACKAGE_VENDOR "The tethercalc authors")
set(TETHERCALC_MAINTAINER "The tethercalc authors <tethercalc@users.noreply.github.com>" CACHE STRING
  "Who answers for the Debian packages: Name <address>")
set(CPACK_PACKAGE_CONTACT "${TETHERCALC_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

# The first line of a description is the project's, the same in all three.
string(CONCAT design_words
  "It finds the conductor cross-section to fly, says what limits it and what\n"
  "it costs in power, learns a drone's drag from flight logs, and tells from\n"
  "measured flights what the calculation gets wrong, why, and how far the\n"
  "design moves once that is repaired.\n.\nThis package has ")

set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "design calculator for drones powered through a tether")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME tethercalc)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS gnuplot-nox)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "${design_words}the program and its documents.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libtethercalc-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF) # static
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "nlohmann-json3-dev, libfmt-dev, libnlopt-dev, libnlopt-cxx-dev, libmuparser-dev, zlib1g-dev, liblzma-dev, libzip-dev, pkg-config")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "${design_words}the C++ library and its headers.")

if(TETHERCALC_BUILD_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-tethercalc)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  math(EXPR next_minor "${TETHERCALC_PYTHON_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= 3.${TETHERCALC_PYTHON_MINOR}~), python3 (<< 3.${next_minor}), python3-numpy")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "${design_words}the Python module tethercalc.")
endif()

set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_SOURCE_DIR}/packaging/debian_layout.cmake")
set(CPACK_TETHERCALC_SOURCE "${PROJECT_SOURCE_DIR}")
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
include(CPack)
