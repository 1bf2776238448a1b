#include "tethercalc/report/report_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <utility>

#include "io/embedded_files.hpp"
#include "io/json_document.hpp"
#include "report/characters.hpp"
#include "report/figure_svg.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/report/cable_report.hpp"
#include "tethercalc/report/design_report.hpp"
#include "tethercalc/report/diagnosis_report.hpp"
#include "tethercalc/report/drag_report.hpp"
#include "tethercalc/report/explanation.hpp"
#include "tethercalc/report/rules_report.hpp"
#include "tethercalc/study/results.hpp"

namespace tethercalc {
namespace {

using nlohmann::ordered_json;

// Pieces of HTML that is XML as well, so that whatever reads either can read it. Texts are plain
// texts of anybody; they are made fit for markup here and nowhere else.
namespace html {

/// <name attributes>text</name>; `attributes` is markup, beginning with a space.
std::string element(std::string_view name, std::string_view text,
                    std::string_view attributes = "") {
  return fmt::format("<{0}{1}>{2}</{0}>", name, attributes, markup_text(text));
}

/// The name of a row; one of joined words may be broken where a word of three letters follows.
std::string row_name(std::string_view name, std::string_view attributes) {
  std::string out = markup_text(name);
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  for (std::size_t i = out.size(); i-- > 1;) {
    const bool joint = out[i - 1] == '.' || out[i - 1] == '_';
    const std::string next = out.substr(i, 3);
    if (joint && next.size() == 3 && std::ranges::all_of(next, is_letter)) out.insert(i, "<wbr/>");
  }
  return fmt::format("<th{}>{}</th>", attributes, out);
}

/// Titles of columns may take two lines.
std::string title_text(const std::string& title) {
  std::string out = markup_text(title);
  const std::size_t line_end = out.find('\n');
  if (line_end != std::string::npos) out.replace(line_end, 1, "<br/>");
  return out;
}

std::string header_row(const TextTable& table) {
  std::string out = "<tr>";
  for (const TextTable::Column& column : table.columns()) {
    const char* side = column.align == TextTable::Align::right ? " class=\"n\"" : "";
    // A header without a word would be read out as one.
    out += column.title.empty()
               ? "<td></td>"
               : fmt::format("<th scope=\"col\"{}>{}</th>", side, title_text(column.title));
  }
  return out + "</tr>\n";
}

std::string body_row(const TextTable& table, const TextTable::Row& row) {
  constexpr int longest_word = 32;  // columns that stay in one line
  std::string out = row.emphasis ? "<tr class=\"main\">" : "<tr>";
  for (std::size_t c = 0; c < row.cells.size(); ++c) {
    const std::string& cell = row.cells[c];
    const bool number = table.columns()[c].align == TextTable::Align::right;
    const char* kind = number ? "n" : columns_of(cell) <= longest_word ? "word" : "prose";
    out += c == 0 ? row_name(cell, fmt::format(" scope=\"row\" class=\"{}\"", kind))
                  : element("td", cell, fmt::format(" class=\"{}\"", kind));
  }
  return out + "</tr>\n";
}

/// A paragraph a text.
std::string paragraphs(std::span<const std::string> texts) {
  std::string out;
  for (const std::string& text : texts) out += element("p", text) + "\n";
  return out;
}

/// An unordered list.
std::string list(std::span<const std::string> texts) {
  std::string out = "<ul>\n";
  for (const std::string& text : texts) out += element("li", text) + "\n";
  return out + "</ul>\n";
}

/// A table with its title, in a box that scrolls where it is too wide and that the keyboard
/// reaches; `id` is unique in the page. The first column heads its rows.
std::string table(const TitledTable& table, std::string_view id) {
  std::string rows;
  for (const TextTable::Row& row : table.table.rows()) rows += body_row(table.table, row);
  return fmt::format(
      "<figure>\n{}\n<div class=\"scroll\" role=\"region\" aria-labelledby=\"{}\" tabindex=\"0\">\n"
      "<table aria-labelledby=\"{}\">\n<thead>\n{}</thead>\n<tbody>\n{}</tbody>\n</table>\n</div>\n"
      "</figure>\n",
      element("figcaption", table.title, fmt::format(" id=\"{}\"", id)), id, id,
      header_row(table.table), rows);
}

/// Text in lines that stand as they are, in a box as above called `label`.
std::string listing(std::string_view text, std::string_view label) {
  return fmt::format("{}\n", element("pre", text,
                                     fmt::format(" class=\"scroll\" role=\"region\" "
                                                 "aria-label=\"{}\" tabindex=\"0\"",
                                                 markup_text(label))));
}

/// The figure as inline SVG, in the page's colours.
std::string picture(const Figure& figure) {
  return "<figure class=\"picture\">\n" + plot::svg_element(figure) + "</figure>\n";
}

}  // namespace html

/// A part of the page that the contents list.
struct Section {
  std::string id;
  std::string title;
  std::string body;  ///< markup
};

std::string contents(const std::vector<Section>& sections) {
  std::string out = "<nav aria-label=\"Contents\">\n<ul>\n";
  for (const Section& section : sections) {
    out += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", section.id, markup_text(section.title));
  }
  return out + "</ul>\n</nav>\n";
}

std::string section_markup(const Section& section) {
  return fmt::format("<section aria-labelledby=\"{0}\">\n{1}\n{2}</section>\n", section.id,
                     html::element("h2", section.title, fmt::format(" id=\"{}\"", section.id)),
                     section.body);
}

Section answer_section(const PageContent& content) {
  const Answer told = answer(content.file, content.optimum);
  const bool feasible = content.optimum.result.feasible;
  const auto headline = [](const std::string& words, bool good) {
    return html::element("p", words,
                         good ? " class=\"headline good\"" : " class=\"headline bad\"") +
           "\n";
  };
  // What the logs show outranks what the spec says of the same drone.
  const DesignImpact impact =
      content.diagnoses.empty()
          ? DesignImpact{}
          : content.diagnoses.back().diagnosis.design_impact.value_or(DesignImpact{});
  const std::string flown = impact_headline(impact);
  std::string body;
  if (flown.empty()) {
    body = headline(told.headline, feasible);
  } else {
    body = headline(flown, impact.cross_section_mm2.after.has_value());
    body += html::element("p",
                          "By the spec as it stands, of which the figures and tables of designs "
                          "below are:");
    body += "\n" + html::element("p", told.headline) + "\n";
  }
  body += html::paragraphs(told.sentences);
  if (!told.remedies.empty()) body += html::list(told.remedies);
  if (feasible) body += html::table(condition_table(content.optimum.result), "table-conditions");
  for (const Warning& warning : optimum_warnings(content.file, content.optimum)) {
    body += html::element("p", "Note: " + warning.sentence, " class=\"note\"") + "\n";
  }
  return {"answer", "The answer", std::move(body)};
}

Section cross_sections(const PageContent& content) {
  const OptimumStudy& study = content.optimum;
  std::string body = html::picture(optimum_figure(content.file.name, study, content.curve));
  if (!study.sizes.empty()) body += html::table(sizes_table(study), "table-sizes");
  if (!study.table.empty()) body += html::table(power_table(study), "table-power");
  return {"cross-sections", "Thrust and power over the cross-section", std::move(body)};
}

Section cable_section(const PageContent& content) {
  std::vector<ShapeRequest> requests;
  std::vector<ShapeStudy> studies;
  for (const FlownShape& flown : content.optimum.cable) {
    requests.push_back(flown.request);
    studies.push_back(flown.study);
  }
  const bool any_hangs = std::ranges::any_of(
      studies, [](const ShapeStudy& study) { return study.outcome == CableOutcome::hangs; });
  std::string body;
  if (any_hangs) {
    body = html::picture(shape_figure(content.file.name, requests, studies));
    body += html::table(flown_cable_table(content.optimum.cable), "table-cable");
  }
  body += html::paragraphs(flown_cable_sentences(content.optimum.cable));
  return {"cable", "How the cable hangs", std::move(body)};
}

Section other_motors(const PageContent& content) {
  const DesignFile& file = content.file;
  std::string body = html::picture(motors_figure(file, content.motors));
  const TitledTable ranking = motor_table(file.design, content.motors);
  if (!ranking.table.rows().empty()) body += html::table(ranking, "table-motors");
  const std::vector<std::string> refused = refused_motors(content.motors);
  if (!refused.empty()) body += html::element("h3", "Not feasible") + "\n" + html::list(refused);
  return {"motors", "The same drone, motor by motor", std::move(body)};
}

Section drag_section(const DragStudy& drag) {
  const DragFit& fit = drag.identified.fit;
  const DragSentences told = drag_sentences(drag.identified);
  std::string body = html::paragraphs(told.made_of);
  body += html::table(drag_parameter_table(fit), "table-drag");
  body += html::paragraphs(told.quality);
  body += html::picture(drag_figure(drag));
  const TitledTable steady = steady_flight_table(fit);
  if (!steady.table.rows().empty()) body += html::table(steady, "table-steady-drag");
  return {"drag", "Drag learned from " + drag.name, std::move(body)};
}

/// The story with its figure after the opening paragraphs, which say what it shows.
Section diagnosis_section(const LogDiagnosis& log) {
  const std::string kind(to_string(log.diagnosis.kind));
  const std::string id = kind + "-diagnosis";
  std::string picture;
  if (!log.diagnosis.compared.empty()) {  // the log was long enough to judge by
    Figure figure = diagnosis_figure(log.log, log.diagnosis);
    figure.id = kind + "_diagnosis";  // a page may hold two
    picture = html::picture(figure);
  }
  std::string body;
  int tables = 0;
  for (const StoryPart& part : diagnosis_story(log.diagnosis)) {
    if (const auto* text = std::get_if<std::string>(&part)) {
      body += html::element("p", *text) + "\n";
      continue;
    }
    body += std::exchange(picture, "");
    if (const auto* heading = std::get_if<StoryHeading>(&part)) {
      body += html::element("h3", heading->text) + "\n";
    } else if (const auto* lines = std::get_if<StoryLines>(&part)) {
      body += html::element("pre", lines->text) + "\n";
    } else {
      body += html::table(std::get<TitledTable>(part), fmt::format("table-{}-{}", id, ++tables));
    }
  }
  return {id, "What the calculation gets wrong: " + log.log, body + picture};
}

TitledTable library_table(const DesignFile& file) {
  TextTable table(
      {word_column("what"), word_column("id"), word_column("name"), word_column("source")});
  table.add({"motor", file.motor.id, file.motor.name, file.motor.source});
  table.add({"conductor", file.conductor.id, file.conductor.name, file.conductor.source});
  table.add({"insulation", file.insulation.id, file.insulation.name, file.insulation.source});
  return {"Motor and materials", std::move(table)};
}

/// The fields that the spec leaves to their defaults, of those that have one.
TitledTable defaults_table(const DesignFile& file) {
  TextTable table({word_column("field"), word_column("value"), word_column("meaning")});
  for (const SpecField& field : spec_fields()) {
    const bool has_default = !field.required() && field.default_json != "null";
    if (!has_default || field.kind == FieldKind::text) continue;
    if (file.document.contains(ordered_json::json_pointer(std::string(field.pointer)))) continue;
    const char* space = field.unit.empty() ? "" : " ";
    table.add({dot_path(field.pointer),
               fmt::format("{}{}{}", field.default_json, space, field.unit),
               std::string(field.help)});
  }
  return {"Fields that the spec leaves to their defaults", std::move(table)};
}

Section spec_section(const DesignFile& file) {
  std::string spec = json_text(file.document);
  spec.pop_back();  // the end of the last line
  std::string body = html::listing(visible_json(spec), "The spec as JSON");
  body += html::table(library_table(file), "table-library");
  const TitledTable defaults = defaults_table(file);
  if (!defaults.table.rows().empty()) body += html::table(defaults, "table-defaults");
  return {"spec", "The spec as used", std::move(body)};
}

Section method_section(const PageContent& content) {
  const std::string tether =
      content.file.design.tether.model == TetherModel::straight
          ? "All drag of the tether acts on the drone; the tether hangs straight and is as long as "
            "the drone is high."
          : "The tether hangs as its weight and the wind have it, from its station to the drone, "
            "with the length that is paid out; the ground carries its share of weight and drag.";
  const std::vector<std::string> method{
      "Steady flight, in hover and in forward flight. At each cross-section the tilt of the drone "
      "follows from its weight, its drag and the tether's, and with it the thrust that it needs; "
      "motor curve, converter and the resistance of the tether give the power that the supply has "
      "to deliver for that, and the thrust that it could deliver at most.",
      "The optimum is the cross-section that draws the least power among those that keep the "
      "demanded thrust headroom and every other requirement of the spec. Where the headroom is "
      "kept within a range only, the whole range was found.",
      tether + " Above the last point of its curve a motor has no more thrust.",
      "After Beffert and Zell, Cable Optimization and Drag Estimation for Tether-Powered "
      "Multirotor "
      "UAVs (2025)."};
  std::string body = html::paragraphs(method);
  body +=
      html::element("p", "Computed by tethercalc " TETHERCALC_VERSION ". The same again:") + "\n";
  body += html::listing(content.command, "The command");
  return {"method", "How this was computed", std::move(body)};
}

Section rules_section(const RuleStudy& rules) {
  std::string body = html::element("p", rules_headline(rules)) + "\n";
  body += html::table(rules_table(rules), "table-rules");
  body += html::element("h3", "The clauses") + "\n" + html::list(rules_clauses(rules));
  body += html::element("h3", "What this covers") + "\n" + html::paragraphs(rules_scope(rules));
  return {"rules", "What published rules ask: " + rules.book.title, std::move(body)};
}

/// What the codes behind this page's answers mean, and what to do.
Section explained_section(const PageContent& content) {
  std::vector<std::string> codes{std::string(limit_name(content.optimum.result.limited_by))};
  for (const Warning& warning : optimum_warnings(content.file, content.optimum)) {
    codes.emplace_back(warning_code(warning.kind));
  }
  for (const LogDiagnosis& log : content.diagnoses) {
    for (const Finding& finding : log.diagnosis.findings) codes.push_back(finding.effect);
  }
  std::string body;
  std::vector<std::string> told;
  for (const std::string& code : codes) {
    const Explanation* page = find_explanation(code);  // none of an effect of the user's own
    if (page == nullptr || std::ranges::count(told, code) > 0) continue;
    told.push_back(code);
    body += html::element("h3", fmt::format("{} ({})", page->title, code)) + "\n";
    for (const char* heading : {"What it means", "What to do"}) {
      const ExplanationPart* part = page->part(heading);
      for (std::string text : part->texts) {
        std::erase(text, '`');
        body += html::element("p", text) + "\n";
      }
    }
  }
  body += html::element("p", "tethercalc explain CODE says why, with the formula and its source.",
                        " class=\"note\"");
  return {"explained", "What this means, and what to do", body + "\n"};
}

std::string head(const std::string& title) {
  return fmt::format(
      "<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'; img-src data:\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<meta name=\"color-scheme\" content=\"light dark\"/>\n"
      "<meta name=\"generator\" content=\"tethercalc " TETHERCALC_VERSION
      "\"/>\n{}\n<style>\n{}</style>\n</head>\n",
      html::element("title", title), embedded_file("report/page.css"));
}

}  // namespace

std::string report_page(const PageContent& content) {
  std::vector<Section> sections{answer_section(content), cross_sections(content)};
  if (!content.optimum.cable.empty()) sections.push_back(cable_section(content));
  if (!content.motors.empty()) sections.push_back(other_motors(content));
  if (content.drag) sections.push_back(drag_section(*content.drag));
  for (const LogDiagnosis& log : content.diagnoses) sections.push_back(diagnosis_section(log));
  if (content.rules) sections.push_back(rules_section(*content.rules));
  sections.push_back(explained_section(content));
  sections.push_back(spec_section(content.file));
  sections.push_back(method_section(content));

  const std::string name = printable(content.file.name);
  constexpr std::size_t longest_title = 100;
  std::string out = "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n";
  out += head(printable(name, longest_title));
  out += "<body>\n<header>\n<p class=\"kind\">Tether of a drone</p>\n" + html::element("h1", name);
  out += "\n" + contents(sections) + "</header>\n<main>\n";
  for (const Section& section : sections) out += section_markup(section);
  return out + "</main>\n</body>\n</html>\n";
}

}  // namespace tethercalc
