#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "io/closest_name.hpp"
#include "io/design_options.hpp"
#include "io/json_document.hpp"
#include "io/spec_edit.hpp"
#include "page/asks.hpp"
#include "page/page_json.hpp"
#include "report/figure_json.hpp"
#include "report/result_values.hpp"
#include "tethercalc/report/cable_report.hpp"
#include "tethercalc/report/design_report.hpp"
#include "tethercalc/report/report_page.hpp"
#include "tethercalc/report/result_figures.hpp"

namespace tethercalc::page {
namespace {

/// A design and what its optimum is.
struct Optimised {
  DesignFile file;
  OptimumStudy study;
};

Optimised optimised(const Request& request) {
  DesignFile file = request.design();
  OptimumStudy study = study_optimum(file.design, wire_sizes());
  return {std::move(file), std::move(study)};
}

/// All of it but "text", the whole output of the command, which `brief` leaves out.
ordered_json optimum_json(const Request& request, const Optimised& asked) {
  const auto& [file, study] = asked;
  Answer told = answer(file, study);
  const auto sentence = [](const Warning& warning) { return warning.sentence; };
  ordered_json out{{"headline", std::move(told.headline)},
                   {"sentences", std::move(told.sentences)},
                   {"remedies", std::move(told.remedies)},
                   {"warnings", json_list(optimum_warnings(file, study), sentence)},
                   {"result", optimize_json(file, study)},
                   {"command", "tethercalc optimize spec.json"}};
  if (!request.flag("brief")) out["text"] = optimize_text(file, study, {});
  return out;
}

std::vector<MotorOptimum> ranked_motors(const Request& request, const DesignFile& file) {
  std::vector<std::string> names = request.list("motors");
  if (names.empty()) names = {"all"};
  return compare_motors(file.design, chosen_motors(names, file, request.loader()));
}

CableOptions cable_options(const Request& request) {
  CableOptions options;
  options.areas_mm2 = request.list("area_mm2");
  options.height = request.number("height_m");
  options.offset = request.number("offset_m");
  options.winds = request.list("wind_m_s");
  options.wind_from = request.number("wind_from_deg").value_or(0);
  options.slacks_percent = request.list("slack_percent");
  options.length = request.number("length_m");
  options.winch_tension = request.number("winch_tension_N");
  options.axial_stiffness = request.number("axial_stiffness_N");
  options.station_height = request.number("station_height_m");
  if (request.has("profile")) options.profile = request.text("profile");
  options.reference_height = request.number("reference_height_m");
  options.exponent = request.number("exponent");
  options.roughness_length = request.number("roughness_m");
  return options;
}

/// A design with its optimum as its cable where the spec sets none: what a page shows beside it.
DesignFile with_cable(DesignFile file) {
  std::optional<double>& area = file.design.tether.cross_section;
  if (area) return file;
  const DesignOptimum optimum = optimum_of(file.design);
  if (optimum.result.feasible) area = optimum.result.area;
  return file;
}

struct Shapes {
  AskedShapes asked;
  std::vector<ShapeStudy> studies;
};

Shapes studied_shapes(const Request& request, DesignFile file) {
  Shapes out{asked_shapes(cable_options(request), with_cable(std::move(file))), {}};
  for (const ShapeRequest& one : out.asked.requests) {
    out.studies.push_back(study_cable_shape(out.asked.file.design, out.asked.area, one));
  }
  return out;
}

Figure drawn_shapes(const Shapes& shapes) {
  try {
    return shape_figure(shapes.asked.file.name, shapes.asked.requests, shapes.studies);
  } catch (const std::invalid_argument& error) {
    throw InputError("shape", error.what());
  }
}

/// The figures of a design, as `plot` names them.
struct FigureKind {
  std::string_view name;
  Figure (*draw)(const Request& request, const Optimised& of);
};
constexpr std::array figure_kinds{
    FigureKind{"optimum",
               [](const Request&, const Optimised& of) {
                 return optimum_figure(of.file.name, of.study, area_curve(of.study));
               }},
    FigureKind{"motors",
               [](const Request& request, const Optimised& of) {
                 return motors_figure(of.file, ranked_motors(request, of.file));
               }},
    FigureKind{"shape", [](const Request& request, const Optimised& of) {
                 return drawn_shapes(studied_shapes(request, of.file));
               }}};

Figure drawn(const Request& request, const std::string& kind, const Optimised& of) {
  const auto found = std::ranges::find(figure_kinds, kind, &FigureKind::name);
  if (found != figure_kinds.end()) return found->draw(request, of);
  std::vector<std::string> names;
  for (const FigureKind& known : figure_kinds) names.emplace_back(known.name);
  throw InputError("kinds", fmt::format("there is no kind of figure \"{}\"; allowed are {}{}", kind,
                                        fmt::join(names, ", "), did_you_mean(kind, names)));
}

ordered_json figures_json(const Request& request, const Optimised& of) {
  std::vector<std::string> kinds = request.list("kinds");
  if (kinds.empty()) kinds = {"optimum"};
  ordered_json figures = ordered_json::array();
  for (const std::string& kind : kinds) add_figure(figures, kind, drawn(request, kind, of));
  return figures;
}

ordered_json optimize(const Request& request) { return optimum_json(request, optimised(request)); }

ordered_json figures(const Request& request) {
  return {{"figures", figures_json(request, optimised(request))}};
}

ordered_json optimize_and_figures(const Request& request) {
  const Optimised asked = optimised(request);
  ordered_json out = optimum_json(request, asked);
  out["figures"] = figures_json(request, asked);
  return out;
}

ordered_json compare(const Request& request) {
  const DesignFile file = request.design();
  const std::vector<MotorOptimum> ranking = ranked_motors(request, file);
  return {{"result", compare_json(file, ranking)},
          {"table", table_json(motor_table(file.design, ranking))},
          {"refused", refused_motors(ranking)},
          {"text", compare_text(file, ranking, {})},
          {"command", "tethercalc compare spec.json --motors all"}};
}

/// With the cross-section whose envelope is asked for.
DesignFile enveloped(const Request& request) {
  DesignFile file = with_cable(request.design());
  file.design.tether.cross_section = one_area(request.list("area_mm2"), file.design, "an envelope");
  return file;
}

std::string area_option(const Design& design) {
  return fmt::format("--area-mm2 {}", *design.tether.cross_section / unit::square_millimetre);
}

ordered_json envelope(const Request& request) {
  const DesignFile file = enveloped(request);
  const EnvelopeStudy study = study_envelope(file.design);
  return {{"result", envelope_json(file, study)},
          {"text", envelope_text(file, study, {})},
          {"command", "tethercalc envelope spec.json " + area_option(file.design)}};
}

ordered_json shape(const Request& request) {
  const Shapes shapes = studied_shapes(request, request.design());
  const auto& [file, area, requests] = shapes.asked;
  ordered_json results = ordered_json::array();
  std::string text;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    results.push_back(cable_shape_json(file, area, shapes.studies[i]));
    text += cable_shape_text(file, area, requests[i], shapes.studies[i], {});
  }
  ordered_json out{{"result", results.size() == 1 ? results.front() : results},
                   {"text", std::move(text)},
                   {"figures", ordered_json::array()}};
  const bool any = std::ranges::any_of(
      shapes.studies, [](const ShapeStudy& study) { return study.outcome == CableOutcome::hangs; });
  if (any) add_figure(out["figures"], "shape", drawn_shapes(shapes));
  return out;
}

#ifdef TETHERCALC_WITHOUT_DESIGN_SEARCH
ordered_json design(const Request& request) {
  (void)request.design();
  for (const char* name : {"free", "minimize", "subject_to", "standard", "pareto", "seed"}) {
    (void)request.value(name);
  }
  throw InputError("design",
                   "is not part of this page: the search for a whole design needs the program, "
                   "tethercalc design spec.json");
}
#else
ordered_json design(const Request& request) {
  const DesignFile file = request.design();
  DesignRequest asked;
  asked.free = request.list("free");
  asked.minimize = request.text_or("minimize", asked.minimize);
  asked.subject_to = request.list("subject_to");
  asked.standard = request.text_or("standard", asked.standard);
  asked.pareto = request.list("pareto");
  asked.seed = static_cast<std::uint64_t>(std::max(0, request.whole("seed", 1)));
  const DesignStudy study = study_design(read_design_request(file, asked));
  return {{"result", design_json(file, asked, study)},
          {"text", design_text(file, asked, study, {})}};
}
#endif

ordered_json report(const Request& request) {
  const DesignFile file = request.design();
  std::vector<MotorEntry> motors = chosen_motors({"alike"}, file, request.loader());
  const PageContent content{study_overview(file.design, wire_sizes(), std::move(motors)),
                            file,
                            {},
                            {},
                            {},
                            "tethercalc report spec.json"};
  return {{"html", report_page(content)}};
}

ordered_json spec(const Request& request) {
  return {{"spec", json_text(request.design().document)}};
}

ordered_json set(const Request& request) {
  return {{"spec", spec_with_value(request.text("spec"), std::string(spec_file),
                                   request.text("path"), request.value("value"))}};
}

ordered_json csv(const Request& request) {
  const std::vector<std::string> names{"optimize", "compare", "envelope", "shape"};
  const std::string of = request.text_or("of", names.front());
  const auto as_csv = [](std::string text) { return ordered_json{{"csv", std::move(text)}}; };
  if (of == "optimize") return as_csv(optimize_csv(optimised(request).study));
  if (of == "compare") return as_csv(compare_csv(ranked_motors(request, request.design())));
  if (of == "envelope") return as_csv(envelope_csv(study_envelope(enveloped(request).design)));
  if (of == "shape") {
    return as_csv(cable_shape_csv(studied_shapes(request, request.design()).studies.front()));
  }
  throw InputError("of", fmt::format("\"{}\" has no CSV; allowed are {}{}", of,
                                     fmt::join(names, ", "), did_you_mean(of, names)));
}

ordered_json svg(const Request& request) {
  const Optimised of = optimised(request);
  const Figure figure = drawn(request, request.text_or("kind", "optimum"), of);
  FigureSize size;
  size.width_mm = request.number("width_mm").value_or(170);
  check_figure_width(size.width_mm, "width_mm");
  return {{"svg", render(figure, FigureFormat::svg, {}, size)}};
}

}  // namespace

std::span<const Ask> design_asks() {
  static constexpr std::array asks{Ask{"optimize", optimize},
                                   Ask{"figures", figures},
                                   Ask{"optimize_and_figures", optimize_and_figures},
                                   Ask{"compare", compare},
                                   Ask{"envelope", envelope},
                                   Ask{"shape", shape},
                                   Ask{"design", design},
                                   Ask{"report", report},
                                   Ask{"spec", spec},
                                   Ask{"set", set},
                                   Ask{"csv", csv},
                                   Ask{"svg", svg}};
  return asks;
}

}  // namespace tethercalc::page
