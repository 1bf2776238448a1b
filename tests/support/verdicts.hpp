// The verdicts of a diagnosis, effect by effect.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "tethercalc/diagnose/diagnosis.hpp"

namespace tethercalc::test {

/// Whether one of the list's entries is about the effect.
template <class List>
bool lists(const List& list, const std::string& effect) {
  return std::any_of(list.begin(), list.end(),
                     [&effect](const auto& entry) { return entry.effect == effect; });
}

/// True where the finding names the effect, alone or in a set of at most three.
inline bool names(const Finding& finding, const std::string& effect) {
  const auto& others = finding.indistinguishable_from;
  return finding.effect == effect ||
         (others.size() <= 2 && std::find(others.begin(), others.end(), effect) != others.end());
}

/// How many verdicts each effect got. Being a rival of several findings is one.
inline std::map<std::string, int> verdict_counts(const Diagnosis& d) {
  std::map<std::string, int> verdicts;
  for (const Finding& f : d.findings) {
    ++verdicts[f.effect];
    for (const auto& other : f.indistinguishable_from) verdicts[other] = 1;
  }
  for (const auto& s : d.suspected) ++verdicts[s.effect];
  for (const auto& n : d.not_testable) ++verdicts[n.effect];
  for (const auto& n : d.not_identifiable) ++verdicts[n.effect];
  std::set<std::string> ruled_out;  // has an entry a size
  for (const RuledOut& r : d.ruled_out) ruled_out.insert(r.effect);
  for (const auto& effect : ruled_out) ++verdicts[effect];
  return verdicts;
}

}  // namespace tethercalc::test
