#include "report/figure_json.hpp"

#include <array>
#include <nlohmann/json.hpp>

#include "report/figure_style.hpp"
#include "report/result_values.hpp"

namespace tethercalc {
namespace plot {
namespace {

ordered_json numbers_json(const std::vector<double>& values) {
  return json_list(values, [](double value) { return number_or_null(value); });
}

ordered_json axis_json(const Axis& axis) {
  return {{"label", axis.label},
          {"log", axis.logarithmic},
          {"lo", number_or_null(axis.range.lo)},
          {"hi", number_or_null(axis.range.hi)},
          {"numbers", axis.numbers},
          {"ticks", json_list(axis.ticks, [](const Tick& tick) {
             return ordered_json{{"at", number_or_null(tick.at)}, {"words", tick.words}};
           })}};
}

ordered_json style_json(Colour colour) {
  return {{"colour", colour_name(colour)}, {"code", colour_code(colour)}};
}

std::string_view mark_name(Mark mark) {
  constexpr std::array<std::string_view, 8> names{"speck",   "cross",  "dot",      "circle",
                                                  "diamond", "square", "triangle", "plus"};
  return names.at(static_cast<std::size_t>(mark));
}

/// Puts each layer among the series or the marks of a panel.
struct LayerWriter {
  ordered_json& series;
  ordered_json& marks;

  void operator()(const Curve& curve) const {
    ordered_json style = style_json(curve.colour);
    style["dash"] = dash_lengths(curve.dash);
    style["width"] = curve.width;
    series.push_back({{"name", curve.words},
                      {"role", "curve"},
                      {"x", numbers_json(curve.x)},
                      {"y", numbers_json(curve.y)},
                      {"style", std::move(style)},
                      {"label", curve.label},
                      {"cells", curve.cells}});
  }
  void operator()(const Points& points) const {
    ordered_json style = style_json(points.colour);
    style["mark"] = mark_name(points.mark);
    series.push_back({{"name", points.words},
                      {"role", "points"},
                      {"x", numbers_json(points.x)},
                      {"y", numbers_json(points.y)},
                      {"style", std::move(style)},
                      {"sizes", numbers_json(points.sizes)},
                      {"values", numbers_json(points.values)}});
  }
  void operator()(const Band& band) const {
    series.push_back({{"name", band.words},
                      {"role", "band"},
                      {"x", numbers_json(band.x)},
                      {"lower", numbers_json(band.lower)},
                      {"upper", numbers_json(band.upper)},
                      {"style", style_json(band.colour)}});
  }
  void operator()(const Span& span) const {
    marks.push_back({{"role", "span"},
                     {"lo", number_or_null(span.range.lo)},
                     {"hi", number_or_null(span.range.hi)},
                     {"words", span.words},
                     {"style", style_json(span.colour)}});
  }
  void operator()(const Reference& line) const {
    ordered_json style = style_json(line.colour);
    style["dash"] = dash_lengths(line.dash);
    marks.push_back({{"role", "reference"},
                     {"at", number_or_null(line.at)},
                     {"vertical", line.vertical},
                     {"words", line.words},
                     {"style", std::move(style)}});
  }
  void operator()(const Note& note) const {
    marks.push_back({{"role", "note"},
                     {"x", number_or_null(note.x)},
                     {"y", number_or_null(note.y)},
                     {"words", note.words}});
  }
  void operator()(const Cells& cells) const {
    marks.push_back({{"role", "cells"},
                     {"cells", json_list(cells.cells,
                                         [](const Cell& cell) {
                                           return ordered_json{cell.x.lo, cell.x.hi, cell.y.lo,
                                                               cell.y.hi,
                                                               number_or_null(cell.value)};
                                         })},
                     {"words_of_grey", cells.words_of_grey}});
  }
};

/// Puts what is special of a part into its object.
struct PartWriter {
  ordered_json& out;

  void operator()(const Panel& panel) const {
    out["type"] = "panel";
    out["title"] = panel.title;
    out["x"] = axis_json(panel.x);
    out["y"] = axis_json(panel.y);
    if (panel.top) out["top"] = axis_json(*panel.top);
    out["beside"] = panel.beside;
    out["remark"] = panel.remark;
    out["legend_heads"] = panel.legend_heads;
    out["key"] = panel.key;
    out["scale"] = nullptr;
    if (panel.scale) {
      out["scale"] = {{"label", panel.scale->label},
                      {"lo", panel.scale->range.lo},
                      {"hi", panel.scale->range.hi}};
    }
    ordered_json series = ordered_json::array();
    ordered_json marks = ordered_json::array();
    for (const Layer& layer : panel.layers) std::visit(LayerWriter{series, marks}, layer);
    out["series"] = std::move(series);
    out["marks"] = std::move(marks);
  }
  void operator()(const Bars& bars) const {
    out["type"] = "bars";
    out["title"] = bars.title;
    out["bars"] = json_list(bars.bars, [](const Bar& bar) {
      return ordered_json{{"words", bar.words},
                          {"share", number_or_null(bar.share)},
                          {"number", bar.number},
                          {"code", colour_code(bar.colour)}};
    });
  }
  void operator()(const Lines& lines) const {
    out["type"] = "lines";
    out["title"] = lines.title;
    out["texts"] = lines.texts;
  }
};

}  // namespace
}  // namespace plot

ordered_json figure_json(std::string_view kind, const Figure& figure) {
  ordered_json out = ordered_json::array();
  for (const auto& part : figure.parts) {
    ordered_json entry{{"kind", kind}, {"part", out.size()}};
    std::visit(plot::PartWriter{entry}, part);
    entry["to_scale"] = figure.to_scale;
    if (out.empty()) {
      if (entry["title"] == "") entry["title"] = figure.title;
      entry["heading"] = figure.heading.empty() ? figure.title : figure.heading;
      entry["description"] = figure.description;
    }
    out.push_back(std::move(entry));
  }
  return out;
}

}  // namespace tethercalc
