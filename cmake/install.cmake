include(CMakePackageConfigHelpers)

# Two components, which are two packages: the program with its documents, and the library.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME development)
install(TARGETS tethercalc tethercalc_core EXPORT tethercalcTargets)
install(TARGETS tethercalc_command RUNTIME COMPONENT program)
if(TETHERCALC_WORDS)
  install(FILES "${TETHERCALC_WORDS}/tethercalc.1" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1"
    COMPONENT program)
  install(FILES "${TETHERCALC_WORDS}/tethercalc"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" COMPONENT program)
  install(FILES "${TETHERCALC_WORDS}/_tethercalc"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/site-functions" COMPONENT program)
  install(FILES "${TETHERCALC_WORDS}/tethercalc.fish"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d" COMPONENT program)
endif()
install(DIRECTORY include/tethercalc TYPE INCLUDE)
# Laid out as here, so that the README's links and commands hold where they are installed.
install(FILES LICENSE README.md CHANGELOG.md CONTRIBUTING.md CITATION.cff TYPE DOC COMPONENT program)
install(FILES page/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/page COMPONENT program)
install(DIRECTORY examples docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program
  PATTERN "Doxyfile" EXCLUDE PATTERN "*.dox" EXCLUDE)

set(package_folder "${CMAKE_INSTALL_LIBDIR}/cmake/tethercalc")
install(EXPORT tethercalcTargets NAMESPACE tethercalc:: DESTINATION "${package_folder}")
configure_package_config_file(cmake/tethercalcConfig.cmake.in
  "${PROJECT_BINARY_DIR}/tethercalcConfig.cmake" INSTALL_DESTINATION "${package_folder}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/tethercalcConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/tethercalcConfig.cmake"
  "${PROJECT_BINARY_DIR}/tethercalcConfigVersion.cmake" DESTINATION "${package_folder}")

# Relative to the .pc file, so that `cmake --install --prefix` and a moved tree both work.
set(pkgconfig_folder "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
file(RELATIVE_PATH prefix_from_pkgconfig "/prefix/${pkgconfig_folder}" "/prefix")
configure_file(cmake/tethercalc.pc.in "${PROJECT_BINARY_DIR}/tethercalc.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/tethercalc.pc" DESTINATION "${pkgconfig_folder}")
