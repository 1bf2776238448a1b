# embed_data(TARGET FILES...) compiles data files into TARGET, so that the installed program finds
# its library from any folder. Each file becomes one entry of tethercalc::embedded_files(), named by
# its path below the data folder.
function(embed_data target)
  embed_files(${target} embedded_files "${PROJECT_SOURCE_DIR}/data" ${ARGN})
endfunction()

# embed_files(TARGET FUNCTION ROOT FILES...): the same for entries of tethercalc::FUNCTION(), named
# by their paths below ROOT.
function(embed_files target function root)
  set(generated "${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp")
  set(script "${PROJECT_SOURCE_DIR}/cmake/write_embedded_files.cmake")
  add_custom_command(
    OUTPUT "${generated}"
    COMMAND ${CMAKE_COMMAND} "-DOUTPUT=${generated}" "-DFUNCTION=${function}" "-DROOT=${root}"
            "-DFILES=${ARGN}" -P "${script}"
    DEPENDS ${ARGN} "${script}"
    VERBATIM)
  target_sources(${target} PRIVATE "${generated}")
endfunction()
