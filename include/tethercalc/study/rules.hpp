// What published rules ask of a tethered drone, and how a design stands to each clause. It compares
// figures and says nothing beyond the text of a clause: whether a flight is allowed, or harms
// nobody, no figure shows.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/model/design.hpp"

namespace tethercalc {

/// What of a design a clause is about.
enum class RuleFigure {
  takeoff_mass,          ///< kg of the drone; up to that with the tether it lifts
  mass_with_tether,      ///< kg, with the tether it lifts
  mass_without_tether,   ///< kg
  tether_length,         ///< m in the air; up to all of the cable
  attainable_height,     ///< m over the station that all of the cable reaches
  flight_height,         ///< m over the ground that the design flies at
  strength_over_weight,  ///< breaking load of the tether over the weight of what flies
  supply_voltage,        ///< V, direct
  ground_speed,          ///< m/s in forward flight in still air
  electric_power,        ///< no number: a design is electric
  largest_dimension,     ///< m of the drone; no design states it
  discharge_time,        ///< s to 60 V once switched off; no design states what it follows from
  load_rating,           ///< that somebody rated the tether; no design states it
};

/// How many there are.
inline constexpr std::size_t rule_figure_count = 13;

/// "takeoff_mass" …: the name of the enumerator, as files of rules have it.
[[nodiscard]] std::string_view rule_figure_name(RuleFigure figure);

/// "kg" …: the unit of the figure's numbers; empty for a plain number.
[[nodiscard]] std::string_view rule_figure_unit(RuleFigure figure);

/// What a clause asks of its figure.
enum class RuleComparison {
  less_than,
  at_most,
  at_least,
  is_so,  ///< no number: it is so, or nothing says that it is
};

/// One clause.
struct RuleClause {
  std::string id;         ///< "tether-strength", unique in its book
  std::string document;   ///< the rule it stands in
  std::string clause;     ///< its number there
  std::string edition;    ///< of the document
  std::string text;       ///< its words, or what they say where they could not be compared
  bool is_quote = false;  ///< whether `text` is the clause's own words
  std::string checked;    ///< against which copy the words were compared; empty: against none
  RuleFigure figure = RuleFigure::takeoff_mass;             ///< what it is about
  RuleComparison comparison = RuleComparison::at_most;      ///< what it asks
  double limit = std::numeric_limits<double>::quiet_NaN();  ///< in the figure's unit
  std::string otherwise;  ///< another way to meet it that no design states; empty: there is none
};

/// The clauses that one --rules names.
struct RuleBook {
  std::string id;                   ///< "eu-c3"
  std::string title;                ///< what people call it
  std::string scope;                ///< to whom it applies, in sentences
  std::string left_out;             ///< what it asks that no figure here is about
  std::vector<RuleClause> clauses;  ///< in the order they are told
};

/// How a design stands to a clause.
enum class RuleVerdict {
  pass,     ///< the figure is within the clause's limit
  fail,     ///< it is not
  unknown,  ///< a figure is missing, or the text leaves open which of two counts
};

/// "pass", "fail" or "unknown".
[[nodiscard]] std::string_view rule_verdict_name(RuleVerdict verdict);

/// A figure of a design. Where a clause leaves open which of two numbers counts, both.
struct RuleValue {
  double lo = std::numeric_limits<double>::quiet_NaN();  ///< NaN where the figure is missing
  double hi = std::numeric_limits<double>::quiet_NaN();  ///< the same where there is one
  std::string because{};  ///< what is missing, or between what the two numbers lie
};

/// One clause and our figure.
struct RuleCheck {
  RuleClause clause;                           ///< as in the book
  RuleValue value;                             ///< of the design
  RuleVerdict verdict = RuleVerdict::unknown;  ///< what follows
  std::optional<double> margin;  ///< relative to the limit, ≥ 0 where met, of the worse number;
                                 ///< nothing where a number is missing
  std::string because{};         ///< of an unknown: why; else empty
};

/// Which design with which conductor.
struct RuleRequest {
  Design design;               ///< SI
  std::optional<double> area;  ///< m² of one conductor; nothing: what needs it is missing
};

struct DesignOptimum;

/// The conductor that rules are held against: the spec's own, else the optimum, if there is one.
[[nodiscard]] std::optional<double> ruled_area(const DesignOptimum& optimum);

/// The answer.
struct RuleStudy {
  RuleBook book;                  ///< as asked about
  std::optional<double> area;     ///< m²
  std::vector<RuleCheck> checks;  ///< one a clause, in the book's order

  /// How many have that verdict.
  [[nodiscard]] std::size_t count(RuleVerdict verdict) const;
};

/// The figure of a design. Masses are those of the hover with that conductor; weights are at
/// standard gravity.
[[nodiscard]] RuleValue rule_value(const RuleRequest& request, RuleFigure figure);

/// Compares the design with each clause. Where two numbers lie on both sides of the limit, or one
/// does not meet it and the clause knows `otherwise`, the verdict is unknown.
[[nodiscard]] RuleStudy study_rules(const RuleRequest& request, const RuleBook& book);

}  // namespace tethercalc
