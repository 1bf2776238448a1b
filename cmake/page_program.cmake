# The page's program for browsers, with Emscripten: page_program.wasm and the module that loads it.
# scripts/build-page configures this; nothing here asks for the libraries of the host but headers.
set(headers "${PROJECT_BINARY_DIR}/headers")
file(MAKE_DIRECTORY "${headers}")
# These folders alone: the host's own C library must not be found beside them.
foreach(library fmt nlohmann boost eigen3)
  if(NOT EXISTS "/usr/include/${library}")
    message(FATAL_ERROR "/usr/include/${library} is missing: scripts/setup page installs it")
  endif()
  file(CREATE_LINK "/usr/include/${library}" "${headers}/${library}" SYMBOLIC)
endforeach()

include(cmake/embed_data.cmake)
set(source "${PROJECT_SOURCE_DIR}/src")
file(GLOB room_sources CONFIGURE_DEPENDS "${source}/model/*.cpp" "${source}/solve/*.cpp"
  "${source}/study/*.cpp" "${source}/identify/*.cpp" "${source}/diagnose/*.cpp" "${source}/io/*.cpp"
  "${source}/report/*.cpp" "${source}/page/*.cpp")
# The search for a whole design is NLopt's, which is a library of the host.
list(FILTER room_sources EXCLUDE REGEX
  "/(solve/constrained_minimum|study/design_search|study/design|page/browser_program)\\.cpp$")
file(GLOB_RECURSE data_files CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/data/*")
list(FILTER data_files EXCLUDE REGEX "/(schema|rules)/")
# Of codes the page and its report explain limits, warnings and effects, but none of bench runs.
list(FILTER data_files EXCLUDE REGEX "/explain/(answers|cable|motor-warnings|records|rule-verdicts|verdicts|voltages)\\.md$")
list(SORT data_files)

# A tenth of the program would be the destruction of what an exception leaves behind on its way. Where none is
# caught that is left out; page/call.js begins anew with a fresh program before what is left over counts.
set(catches "catch \\(|succeeds\\(")
set(catching_sources)
foreach(file IN LISTS room_sources)
  file(STRINGS "${file}" caught REGEX "${catches}")
  if(caught)
    list(APPEND catching_sources "${file}")
  endif()
endforeach()
list(REMOVE_ITEM room_sources ${catching_sources})
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
  ${room_sources} ${catching_sources})
set(without_cleaning -fignore-exceptions)
# A header's catch would be lost in the files that include it; this one is told by its function's name.
file(GLOB_RECURSE headers_of_rooms "${source}/*.hpp" "${PROJECT_SOURCE_DIR}/include/*.hpp")
list(REMOVE_ITEM headers_of_rooms "${source}/io/checked_values.hpp")
foreach(file IN LISTS headers_of_rooms)
  file(STRINGS "${file}" caught REGEX "catch \\(")
  if(caught)
    message(FATAL_ERROR "${file} catches an exception: it belongs into a .cpp, see catches above")
  endif()
endforeach()

# A room is compiled as one file, as in src/CMakeLists.txt.
function(compile_for_page target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  foreach(file IN LISTS sources)
    get_filename_component(folder "${file}" DIRECTORY)
    get_filename_component(room "${folder}" NAME)
    if(folder STREQUAL "${source}/${room}")
      set_source_files_properties("${file}" PROPERTIES UNITY_GROUP ${room})
    endif()
  endforeach()
  target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}/include" "${source}")
  target_include_directories(${target} SYSTEM PRIVATE "${headers}" "${headers}/eigen3")
  target_compile_definitions(${target} PRIVATE TETHERCALC_VERSION="${PROJECT_VERSION}"
    FMT_HEADER_ONLY FMT_USE_LONG_DOUBLE=0 FMT_USE_FLOAT=0
    EIGEN_UNROLLING_LIMIT=16 TETHERCALC_WITHOUT_DESIGN_SEARCH NDEBUG)
  # Emscripten 3.1.6 inlines nothing at -Oz unless told to, and calls are larger than most of what they call. So
  # told it makes smaller programs than at -Os that are no slower.
  target_compile_options(${target} PRIVATE -Oz -finline-functions)
  # Exceptions are caught by their types without RTTI, too. There is one thread, which never ends.
  target_compile_options(${target} PRIVATE -flto -fwasm-exceptions -fno-rtti -fno-math-errno
    -fno-threadsafe-statics -fno-c++-static-destructors
    -Wno-defaulted-function-deleted "SHELL:-include ${PROJECT_SOURCE_DIR}/cmake/page/newer_library.hpp"
    "SHELL:-include ${PROJECT_SOURCE_DIR}/cmake/page/smaller_library.hpp")
endfunction()

add_library(page_rooms STATIC ${room_sources})
embed_data(page_rooms ${data_files})
include(src/page/example_specs.cmake)
embed_files(page_rooms example_specs "${PROJECT_SOURCE_DIR}/examples" ${example_specs})
compile_for_page(page_rooms)
target_compile_options(page_rooms PRIVATE ${without_cleaning})
add_library(page_catching STATIC ${catching_sources})
compile_for_page(page_catching)

add_executable(page_program "${source}/page/browser_program.cpp")
compile_for_page(page_program)
target_link_libraries(page_program PRIVATE page_rooms page_catching)
set_target_properties(page_program PROPERTIES SUFFIX .js LINK_DEPENDS "${source}/page/call.js")
target_link_options(page_program PRIVATE -Oz -flto -fwasm-exceptions --no-entry
  "SHELL:--extern-post-js ${source}/page/call.js"
  -sMODULARIZE=1 -sEXPORT_NAME=createProgram -sENVIRONMENT=web,worker -sFILESYSTEM=0
  -sALLOW_MEMORY_GROWTH=1 -sMAXIMUM_MEMORY=2GB -sINITIAL_MEMORY=16MB -sTOTAL_STACK=1MB
  -sALLOW_TABLE_GROWTH=0 -sDYNAMIC_EXECUTION=0 -sSUPPORT_ERRNO=0 -sMALLOC=emmalloc
  -sEXPORTED_FUNCTIONS=_malloc,_free,_name_file,_call_page,_answer_text,_answer_size,_forget
  -sEXPORTED_RUNTIME_METHODS=HEAPU8)
