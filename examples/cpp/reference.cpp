// The results of a design held against one on record.
#include <cstdio>
#include <tethercalc/files/read_files.hpp>
#include <tethercalc/study/results.hpp>

using namespace tethercalc;

int main(int, char** argv) {
  for (const NamedResult& result : reference_results(read_design(argv[1]).design)) {
    if (result.name != "forward.total_power_W") continue;
    // As published, to the last digit printed there.
    const RecordedResult held = held_against({result.name, 444.9}, result.value, 0, 0.05);
    std::printf("%s %s\n", held.name.c_str(), held.drifted ? "drifted" : "as recorded");
  }
}
