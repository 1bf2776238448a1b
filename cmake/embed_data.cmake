# embed_data(TARGET FILES...) compiles data files into TARGET, so that the installed program finds
# its library from any folder. Each file becomes one entry of tethercalc::embedded_files(), named by
# its path below the data folder.
function(embed_data target)
  set(generated "${CMAKE_CURRENT_BINARY_DIR}/embedded_files.cpp")
  set(script "${PROJECT_SOURCE_DIR}/cmake/write_embedded_files.cmake")
  add_custom_command(
    OUTPUT "${generated}"
    COMMAND ${CMAKE_COMMAND} "-DOUTPUT=${generated}" "-DROOT=${PROJECT_SOURCE_DIR}/data"
            "-DFILES=${ARGN}" -P "${script}"
    DEPENDS ${ARGN} "${script}"
    VERBATIM)
  target_sources(${target} PRIVATE "${generated}")
endfunction()
