# Writes OUTPUT: a C++ file with the bytes of every one of FILES, named relative to ROOT,
# as entries of tethercalc::FUNCTION().
set(body "#include \"io/embedded_files.hpp\"\n\n#include <array>\n\nnamespace tethercalc {\nstd::span<const EmbeddedFile> ${FUNCTION}();\nnamespace {\n")
set(entries "")
set(index 0)
foreach(file IN LISTS FILES)
  file(RELATIVE_PATH name "${ROOT}" "${file}")
  file(READ "${file}" hex HEX)
  # A literal a line of 16 bytes; compilers join adjacent ones.
  string(REGEX REPLACE "(................................)" "\\1\"\n    \"" lines "${hex}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" literal "${lines}")
  file(SIZE "${file}" size)
  string(APPEND body "constexpr char file_${index}[] =\n    \"${literal}\";\n")
  string(APPEND entries "    {\"${name}\", {file_${index}, ${size}}},\n")
  math(EXPR index "${index} + 1")
endforeach()
string(APPEND body "constexpr std::array<EmbeddedFile, ${index}> files{{\n${entries}}};\n}  // namespace\n\n")
string(APPEND body "std::span<const EmbeddedFile> ${FUNCTION}() { return files; }\n\n}  // namespace tethercalc\n")
file(WRITE "${OUTPUT}" "${body}")
