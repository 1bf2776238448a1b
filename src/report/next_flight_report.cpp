#include "tethercalc/report/next_flight_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "report/result_values.hpp"
#include "tethercalc/diagnose/catalogue.hpp"

namespace tethercalc {
namespace {

std::string name_of(const std::string& effect, std::size_t flight) {
  return flight > 0 ? fmt::format("{} (flight {})", in_words(effect), flight) : in_words(effect);
}

/// A manoeuvre, and how often it is flown.
using Repeated = std::pair<const Manoeuvre*, int>;

std::vector<Repeated> counted(const NextFlight& flight) {
  std::vector<Repeated> rows;
  for (const Manoeuvre& manoeuvre : flight.manoeuvres) {
    const auto same = std::find_if(rows.begin(), rows.end(), [&](const Repeated& row) {
      return row.first->words == manoeuvre.words;
    });
    ++(same != rows.end() ? *same : rows.emplace_back(&manoeuvre, 0)).second;
  }
  return rows;
}

std::string decided(const Decision& d) {
  std::string text = name_of(d.effect, d.flight);
  if (d.told_from.empty()) return text + ", so far only suspected";
  return text + fmt::format(", so far not to be told from {}",
                            in_words(fmt::format("{}", fmt::join(d.told_from, " or "))));
}

}  // namespace

FlightArea area_of(const NextFlight& flight) {
  FlightArea area;
  area.lowest = area.highest = flight.limits.height;
  for (const Manoeuvre& manoeuvre : flight.manoeuvres) {
    for (const Waypoint& w : manoeuvre.waypoints) {
      area.south = std::min(area.south, w.north);
      area.north = std::max(area.north, w.north);
      area.west = std::min(area.west, w.east);
      area.east = std::max(area.east, w.east);
      area.lowest = std::min(area.lowest, w.height);
      area.highest = std::max(area.highest, w.height);
    }
  }
  return area;
}

ordered_json next_flight_json(const NextFlight& flight, const std::string& file) {
  ordered_json out;
  out["file"] = file.empty() ? ordered_json(nullptr) : ordered_json(file);
  out["minutes"] = flight.duration / 60;
  out["shortest"] = flight.shortest;
  const FlightArea area = area_of(flight);
  out["area"] = nullptr;
  if (!flight.manoeuvres.empty()) {
    out["area"] = {{"north_m", {area.south, area.north}},
                   {"east_m", {area.west, area.east}},
                   {"height_m", {area.lowest, area.highest}}};
  }
  out["manoeuvres"] = json_list(counted(flight), [](const Repeated& row) {
    return ordered_json{{"manoeuvre", row.first->words},
                        {"times", row.second},
                        {"duration_s", row.first->duration * row.second}};
  });
  out["decides"] = json_list(flight.decides, [](const Decision& d) {
    ordered_json told{{"effect", d.effect},
                      {"own_in_each_flight", d.own_in_each_flight},
                      {"told_from", d.told_from}};
    if (d.flight > 0) told["flight"] = d.flight;
    return told;
  });
  out["undecided"] = json_list(flight.undecided, [](const Undecided& u) {
    ordered_json told{{"effect", u.effect}, {"because", u.because}};
    if (u.flight > 0) told["flight"] = u.flight;
    return told;
  });
  out["base_instead"] = json_list(flight.finer_base, [](const FinerBase& f) {
    return ordered_json{{"of", f.coarse}, {"take", f.fine}};
  });
  return out;
}

std::string next_flight_text(const NextFlight& flight, const std::string& file,
                             const TextStyle& style) {
  std::string out = "\n" + style.bold("The next flight") + "\n";
  if (flight.decides.empty() && flight.undecided.empty()) {
    return out + wrapped(
                     "Nothing is suspected or indistinguishable, so that no flight is needed "
                     "and no mission is written.");
  }
  if (flight.manoeuvres.empty()) {
    out += wrapped("No flight settles what is open, so that no mission is written.");
  } else {
    std::vector<std::string> effects;
    for (const Decision& d : flight.decides) effects.push_back(decided(d));
    out += wrapped(fmt::format(
        "{:.1f} minutes of manoeuvres are {}to settle: {}. The mission is written to {}.",
        flight.duration / 60,
        flight.shortest ? "the fewest that are expected " : "expected (fewer may do) ",
        fmt::join(effects, "; "), file));
    TextTable table({word_column("manoeuvre"), "times", "s"});
    for (const auto& [manoeuvre, times] : counted(flight)) {
      table.add({manoeuvre->words, std::to_string(times), fixed(manoeuvre->duration * times, 0)});
    }
    out += table.text(style);
    const FlightArea area = area_of(flight);
    std::string words = fmt::format(
        "It takes an area that is free from {} m south to {} m north of home and from {} m west to "
        "{} m east, {} to {} m above it, and up to {} m/s.",
        fixed(-area.south, 0), fixed(area.north, 0), fixed(-area.west, 0), fixed(area.east, 0),
        fixed(area.lowest, 0), fixed(area.highest, 0), fixed(flight.limits.speed, 1));
    words += " Then diagnose all flights together, each with its --flight";
    for (const FinerBase& f : flight.finer_base) {
      words += fmt::format(", and with {} instead of {} in --base, since this one turns", f.fine,
                           f.coarse);
    }
    out += wrapped(words + ".");
    const bool own = std::any_of(flight.decides.begin(), flight.decides.end(),
                                 [](const Decision& d) { return d.own_in_each_flight; });
    if (own) {
      std::vector<std::string> names;
      for (const Decision& d : flight.decides) {
        if (d.own_in_each_flight) names.push_back(in_words(d.effect));
      }
      out += wrapped(fmt::format(
          "{} may differ from flight to flight: of the next one it will be told, what the logged "
          "one had stays with that.",
          fmt::join(names, ", ")));
    }
  }
  for (const Undecided& u : flight.undecided) {
    out += wrapped(
        fmt::format("It leaves {} open: {}", name_of(u.effect, u.flight), with_stop(u.because)));
  }
  return out;
}

}  // namespace tethercalc
