// The best whole design, what binds it, and what more of something would change.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tethercalc/study/design_search.hpp"

namespace tethercalc {

/// What a price is that of.
enum class Priced {
  limit,      ///< a demand of the user that binds
  range_end,  ///< an end of a range at which the optimum lies
  demand,     ///< a demand of the design that binds
  field,      ///< a field of the design that is not free
};

/// What one more of something costs at the optimum, everything that is free adapting to it.
struct ShadowPrice {
  Priced of = Priced::field;                ///< what kind
  bool high_end = false;                    ///< of a range
  Demand demand = Demand::thrust_headroom;  ///< which binds
  std::string name{};  ///< that of the limit, or the dot path of the field that is moved
  double step = 1;     ///< by how much, in the unit of the field
  double price = 0;    ///< change of the objective; NaN where no design is left

  /// Whether it binds; a field is just there.
  [[nodiscard]] bool active() const { return of != Priced::field; }
};

/// One point of a Pareto front.
struct FrontPoint {
  double first = 0;            ///< the first quantity, which was minimised
  double second = 0;           ///< the second, which was bounded
  std::vector<double> values;  ///< as in DesignAnswer
};

/// What is asked.
struct DesignQuestion {
  DesignProblem problem;  ///< what is searched
  /// Two quantities of which a front is wanted.
  std::optional<std::array<CandidateQuantity, 2>> front{};
  MinimumOptions search{};  ///< how hard
};

/// The answer.
struct DesignStudy {
  DesignProblem problem;            ///< as searched: with the cross-section freed where it decides
  DesignAnswer answer;              ///< the best design
  std::vector<ShadowPrice> prices;  ///< what binds first; empty where infeasible
  std::vector<FrontPoint> front;    ///< by falling second quantity; empty where none was asked for
};

/// Searches the design and prices what holds it. A cross-section that is neither given nor free is
/// the one of least power that meets the requirements where that is what is asked for, else it is
/// searched beside the free fields from 0.01 to 100 mm².
[[nodiscard]] DesignStudy study_design(const DesignQuestion& question);

}  // namespace tethercalc
