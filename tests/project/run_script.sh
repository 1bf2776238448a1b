#!/bin/sh
# run_script.sh SCRIPT WORK: puts SCRIPT into a project of one source file in WORK and checks when it
# builds, what it prints where, and what it returns.
set -eu
script=$1
work=$2

rm -rf "$work"
mkdir -p "$work/scripts" "$work/src" "$work/data" "$work/include" "$work/cmake" "$work/elsewhere"
cp "$script" "$work/scripts/run"
cat >"$work/scripts/setup" <<'END'
#!/bin/sh
echo "setup $*" >&2
END
chmod +x "$work/scripts/setup"
cat >"$work/CMakePresets.json" <<'END'
{ "version": 5,
  "configurePresets": [ { "name": "release", "generator": "Ninja", "binaryDir": "${sourceDir}/build/release" } ],
  "buildPresets": [ { "name": "release", "configurePreset": "release" } ] }
END
cat >"$work/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(probe LANGUAGES CXX)
file(GLOB data CONFIGURE_DEPENDS data/*)
list(LENGTH data data_count)
add_executable(tethercalc src/main.cpp)
target_compile_definitions(tethercalc PRIVATE DATA=${data_count})
END
# write_program CODE: a program that prints the number of data files and its arguments.
write_program() {
  cat >"$work/src/main.cpp" <<END
#include <cstdio>
int main(int count, char** arguments) {
  std::printf("data %d:", DATA);
  for (int i = 1; i < count; ++i) std::printf(" <%s>", arguments[i]);
  return $1;
}
END
}

# expect NAME CODE OUTPUT BUILDS: what `run a "b c"` did last; BUILDS is yes or no.
expect() {
  code=0
  output=$(cd "$work/elsewhere" && "$work/scripts/run" a "b c" 2>"$work/errors") || code=$?
  builds=no
  [ -s "$work/errors" ] && builds=yes
  if [ "$code/$output/$builds" != "$2/$3/$4" ]; then
    echo "$1: expected code/output/builds $2/$3/$4, got $code/$output/$builds" >&2
    cat "$work/errors" >&2
    exit 1
  fi
}

write_program 7
expect "first call" 7 "data 0: <a> <b c>" yes
expect "nothing changed" 7 "data 0: <a> <b c>" no
write_program 0
expect "source edited" 0 "data 0: <a> <b c>" yes
touch "$work/data/motor.json"
expect "data file added" 0 "data 1: <a> <b c>" yes
expect "nothing changed again" 0 "data 1: <a> <b c>" no
rm "$work/data/motor.json"
expect "data file removed" 0 "data 0: <a> <b c>" yes
rm "$work/build/release/tethercalc"
expect "program removed" 0 "data 0: <a> <b c>" yes
write_program "broken("
expect "source does not compile" 3 "" yes
expect "source still does not compile" 3 "" yes
write_program 2
expect "source repaired" 2 "data 0: <a> <b c>" yes
ln -s ../scripts/run "$work/elsewhere/tc"
[ "$("$work/elsewhere/tc" x || true)" = "data 0: <x>" ] || { echo "symbolic link" >&2; exit 1; }
