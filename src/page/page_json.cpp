#include "page/page_json.hpp"

#include "report/figure_json.hpp"
#include "report/result_values.hpp"

namespace tethercalc::page {

ordered_json table_json(const TitledTable& table) {
  return {{"title", table.title},
          {"columns",
           json_list(
               table.table.columns(),
               [](const TextTable::Column& column) {
                 const bool words = column.align == TextTable::Align::left;
                 return ordered_json{{"title", column.title}, {"align", words ? "left" : "right"}};
               })},
          {"rows", json_list(table.table.rows(), [](const TextTable::Row& row) {
             return ordered_json{{"cells", row.cells}, {"emphasis", row.emphasis}};
           })}};
}

void add_figure(ordered_json& figures, std::string_view kind, const Figure& figure) {
  for (ordered_json& part : figure_json(kind, figure)) figures.push_back(std::move(part));
}

}  // namespace tethercalc::page
