# What Debian's policy asks of a package and other systems do not: compressed manual pages and a
# changelog, a copyright file, and zsh's completions in its own folder. CPack runs this on the
# installed files of each component before it packs them.
file(GLOB trees "${CPACK_TEMPORARY_DIRECTORY}/*/usr")
foreach(tree IN LISTS trees)
  get_filename_component(component "${tree}" DIRECTORY)
  get_filename_component(component "${component}" NAME)
  string(TOUPPER "${component}" component)
  set(package "${CPACK_DEBIAN_${component}_PACKAGE_NAME}")
  set(doc "${tree}/share/doc/${package}")
  file(MAKE_DIRECTORY "${doc}")
  configure_file("${CPACK_TETHERCALC_SOURCE}/packaging/copyright" "${doc}/copyright" COPYONLY)
  set(maintainer "${CPACK_PACKAGE_CONTACT}")
  configure_file("${CPACK_TETHERCALC_SOURCE}/packaging/changelog.in" "${doc}/changelog" @ONLY)
  file(GLOB to_compress "${tree}/share/man/man1/*.1" "${doc}/changelog")
  execute_process(COMMAND gzip -9nf ${to_compress} COMMAND_ERROR_IS_FATAL ANY)
  if(EXISTS "${tree}/share/zsh/site-functions")
    file(RENAME "${tree}/share/zsh/site-functions" "${tree}/share/zsh/vendor-completions")
  endif()
  # The copyright file says it.
  file(REMOVE "${doc}/LICENSE")
  file(GLOB archives "${tree}/lib/*/*.a")
  if(archives)
    execute_process(COMMAND strip --strip-debug --enable-deterministic-archives ${archives}
      COMMAND_ERROR_IS_FATAL ANY)
  endif()
  file(GLOB_RECURSE files "${tree}/share/*")
  file(CHMOD ${files} FILE_PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
endforeach()
