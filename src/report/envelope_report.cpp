#include "tethercalc/report/design_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "model/constants.hpp"
#include "report/result_values.hpp"

namespace tethercalc {
namespace {

struct ReachWords {
  const char* key;
  const char* noun;
  const char* unit;
  double si_factor;
  int decimals;
};

ReachWords words_of(Reach reach) {
  constexpr ReachWords all[] = {{"height_m", "height", "m", 1, 1},
                                {"payload_g", "payload", "g", unit::gram, 0},
                                {"headwind_m_s", "headwind", "m/s", 1, 2},
                                {"airspeed_m_s", "airspeed", "m/s", 1, 2},
                                {"offset_m", "distance upwind", "m", 1, 1}};  // as in Reach
  return all[static_cast<std::size_t>(reach)];
}

/// What a limit means to somebody who pushes one of these further.
std::string beyond_end(const Design& design, const ReachEnd& end) {
  if (end.drum_is_empty) return "the drum is empty";
  if (end.bounded) return beyond_words(design, end.limit, end.condition);
  return "nothing ends it within the search";
}

/// Whether less than that does not meet the demands somewhere.
bool begins_later(Reach reach, const ReachEnd& end) { return end.from > search_start(reach); }

/// Towards where the demands are met: what is shown can be flown.
std::string reached(double value, const ReachWords& words, double (*towards)(double)) {
  constexpr double rounding = 1e-6;  // of the last digit
  const double scale = std::pow(10, words.decimals);
  const double digits = value / words.si_factor * scale;
  const double nearest = std::round(digits);
  const double shown = std::abs(digits - nearest) < rounding ? nearest : towards(digits);
  return fixed(shown / scale, words.decimals);
}

std::string greatest(double value, const ReachWords& words) {
  return reached(value, words, [](double x) { return std::floor(x); });
}

std::string least(double value, const ReachWords& words) {
  return reached(value, words, [](double x) { return std::ceil(x); });
}

std::string sentence_of(const Design& design, const ReachResult& result,
                        const AreaPoints& as_given) {
  const ReachWords words = words_of(result.reach);
  if (!result.end) {
    return fmt::format("At no {} does this cable meet the demands; at the design's own: {}.",
                       words.noun, shortcoming(design, as_given));
  }
  const std::string from =
      begins_later(result.reach, *result.end)
          ? fmt::format(", from {} {} on", least(result.end->from, words), words.unit)
          : "";
  return fmt::format("Greatest {}: {} {}{}; beyond it {}.", words.noun,
                     greatest(result.end->value, words), words.unit, from,
                     beyond_end(design, *result.end));
}

/// What ends a reach; null where nothing does.
ordered_json limit_json(const std::optional<ReachEnd>& end) {
  return end && end->bounded ? ordered_json(limit_name(end->limit)) : ordered_json(nullptr);
}

double end_value(const std::optional<ReachEnd>& end) { return end ? end->value : nan; }

ordered_json end_json(const std::optional<ReachEnd>& end, double si_factor) {
  if (!end) return nullptr;
  return {{"value", end->value / si_factor},
          {"limited_by", limit_json(end)},
          {"limiting_condition", condition_name(end->condition)}};
}

}  // namespace

std::vector<Warning> envelope_warnings(const DesignFile& file, const EnvelopeStudy& study) {
  std::vector<Warning> warnings = all_warnings(file, {}, {}, study.side);
  if (study.ground) {
    const ReachWords reach = words_of(study.ground->reach);
    const std::string end = greatest(study.ground->value, reach);
    warnings.push_back(
        ground_warning(study.ground->contact,
                       fmt::format("at the greatest {}, {} {}, ", reach.noun, end, reach.unit)));
  }
  return warnings;
}

std::string envelope_text(const DesignFile& file, const EnvelopeStudy& study,
                          const TextStyle& style) {
  std::string out = style.bold(file.name) + "\n\n";
  out += fmt::format("{} mm² of {}, {} V\n",
                     significant(*file.design.tether.cross_section / unit::square_millimetre, 4),
                     conductor_words(file.conductor), significant(file.design.supply.voltage, 3));
  for (const ReachResult& result : study.greatest) {
    out += wrapped(sentence_of(file.design, result, study.as_given));
  }
  for (const EnvelopeCurve& curve : study.curves) {
    if (curve.points.empty()) continue;
    const ReachWords of = words_of(curve.of);
    const ReachWords against = words_of(curve.against);
    out += "\n" + style.bold(fmt::format("Greatest {} against {}", of.noun, against.noun)) + "\n";
    TextTable table({fmt::format("{} {}", against.noun, against.unit),
                     fmt::format("{} {}", of.noun, of.unit), word_column("beyond it")});
    for (const EnvelopePoint& point : curve.points) {
      table.add({fixed(point.against / against.si_factor, against.decimals),
                 greatest(end_value(point.end), of),
                 point.end ? beyond_end(file.design, *point.end)
                           : std::string("the demands are not met")});
    }
    out += table.text(style);
  }
  for (const Warning& warning : envelope_warnings(file, study)) {
    out += "\n" + style.subdued(wrapped("Note: " + warning.sentence));
  }
  return out;
}

ordered_json envelope_json(const DesignFile& file, const EnvelopeStudy& study) {
  ordered_json greatest = ordered_json::object();
  for (const ReachResult& result : study.greatest) {
    const ReachWords words = words_of(result.reach);
    ordered_json end = end_json(result.end, words.si_factor);
    if (result.end) {
      if (begins_later(result.reach, *result.end)) end["from"] = result.end->from / words.si_factor;
      end["sentence"] = sentence_of(file.design, result, study.as_given);
    }
    greatest[words.key] = std::move(end);
  }
  const ordered_json curves = json_list(study.curves, [](const EnvelopeCurve& curve) {
    const ReachWords of = words_of(curve.of);
    const ReachWords against = words_of(curve.against);
    const ordered_json points = json_list(curve.points, [&](const EnvelopePoint& point) {
      return ordered_json{{against.key, point.against / against.si_factor},
                          {of.key, number_or_null(end_value(point.end) / of.si_factor)},
                          {"limited_by", limit_json(point.end)}};
    });
    return ordered_json{{"of", of.key}, {"against", against.key}, {"points", points}};
  });
  ordered_json out{
      {"name", file.name},
      {"cross_section_mm2", *file.design.tether.cross_section / unit::square_millimetre},
      {"as_given", verdict_json(file.design, study.as_given)},
      {"greatest", greatest},
      {"curves", curves}};
  add_estimates(out, file.design);
  add_warnings(out, envelope_warnings(file, study));
  return out;
}

std::string envelope_csv(const EnvelopeStudy& study) {
  std::string out = "against,against_value,of,of_value,limited_by\n";
  for (const EnvelopeCurve& curve : study.curves) {
    const ReachWords of = words_of(curve.of);
    const ReachWords against = words_of(curve.against);
    for (const EnvelopePoint& point : curve.points) {
      out += csv_line({against.key, point.against / against.si_factor, of.key,
                       end_value(point.end) / of.si_factor, limit_json(point.end)});
    }
  }
  return out;
}

}  // namespace tethercalc
