// How a design's figures stand to published rules.
#include <cstdio>
#include <tethercalc/files/read_files.hpp>
#include <tethercalc/io/rule_books.hpp>
#include <tethercalc/study/optimum.hpp>
#include <tethercalc/study/rules.hpp>

using namespace tethercalc;

int main(int, char** argv) {
  const Design design = read_design(argv[1]).design;
  const double area = optimum_of(design).result.area;
  for (const RuleCheck& check : study_rules({design, area}, rule_book("eu-c3")).checks) {
    std::printf("%s %s: %s\n", check.clause.clause.c_str(), check.clause.id.c_str(),
                rule_verdict_name(check.verdict).data());
  }
}
