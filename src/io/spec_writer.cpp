// Which fields of a design changed, and how a spec writes them. What fields there are stands in
// spec_fields.cpp.
#include "tethercalc/io/spec_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>

#include "io/entry_readers.hpp"
#include "tethercalc/io/spec_fields.hpp"

namespace tethercalc {
namespace {

using Json = nlohmann::ordered_json;

/// The number with the fewest digits that the reader turns into `si`; the nearest one where
/// rounding leaves none.
double practical_number(double si, double si_factor) {
  const double nearest = si / si_factor;
  for (int digits = 1; digits <= 17; ++digits) {
    const double value = std::strtod(fmt::format("{:.{}g}", nearest, digits).c_str(), nullptr);
    if (value * si_factor == si) return value;
  }
  return nearest;
}

Json number_json(const Design& design, const SpecField& field) {
  const auto si = field_value_si(design, field);
  if (!si) return nullptr;
  if (field.kind == FieldKind::integer) return static_cast<int>(*si);
  return practical_number(*si, field.si_factor);
}

/// How a spec writes a field that is no motor or material.
Json plain_json(const Design& design, const SpecField& field) {
  const Converter& converter = design.supply.converter;
  if (field.kind == FieldKind::boolean) return field_word(design, field) != 0;
  if (const auto words = field_words(field.kind); !words.empty()) {
    return words[field_word(design, field)];
  }
  Json list = Json::array();
  if (field.kind == FieldKind::converter_masses) {
    for (const ConverterMassPoint& point : converter.masses) {
      list.push_back({{"rated_output_W", point.rated_output_power},
                      {"mass_g", practical_number(point.mass, unit::gram)}});
    }
    return list;
  }
  if (field.kind != FieldKind::efficiency || converter.efficiency.size() == 1) {
    return number_json(design, field);
  }
  for (const EfficiencyPoint& point : converter.efficiency) {
    list.push_back({{"output_W", point.output_power}, {"efficiency", point.efficiency}});
  }
  return list;
}

/// How a spec writes the numbers of a motor or material, names left out.
Json entry_numbers(const Design& design, FieldKind kind) {
  Json numbers = Json::object();
  if (kind == FieldKind::motor) {
    Json points = Json::array();
    for (const MotorPoint& point : design.drone.motor.vertices().subspan(1)) {
      points.push_back({{"thrust_g", practical_number(point.thrust, unit::gram_force)},
                        {"power_W", point.power}});
    }
    if (const auto density = design.drone.motor.measured_in()) {
      numbers["measured_air_density_kg_m3"] = *density;
    }
    if (const auto uncertainty = design.drone.motor.uncertainty()) {
      numbers["power_uncertainty_percent"] = practical_number(*uncertainty, 0.01);
    }
    numbers["points"] = std::move(points);
    return numbers;
  }
  for (const SpecField& field : object_fields(kind)) {
    if (!is_numeric(field)) continue;
    if (Json value = number_json(design, field); !value.is_null()) {
      numbers[std::string(field.pointer.substr(1))] = std::move(value);
    }
  }
  return numbers;
}

/// Writes a changed motor or material.
template <class Entry>
Json entry_json(const DesignFile& file, const Entry& old, const Design& design,
                const SpecField& field, const std::string& reference) {
  const Json numbers = entry_numbers(design, field.kind);
  const auto is = [&](const Entry& entry) {
    Design other;
    put_entry(other, entry);
    return entry_numbers(other, field.kind) == numbers;
  };
  const Entry base =
      reference.empty() ? old : find_entry<Entry>(reference, file.load, dot_path(field.pointer));
  if (!reference.empty() && is(base)) return reference;
  for (const Entry& entry : library_entries<Entry>()) {
    if (is(entry)) return entry.id;
  }
  Json changed{{"name", (base.name.empty() ? base.id : base.name) + ", changed"},
               {"source", base.source}};
  const Json::json_pointer pointer{std::string(field.pointer)};
  if (const Json& there = file.document.at(pointer); there.is_object() && reference.empty()) {
    // Its own object stays, but for the numbers.
    changed = there;
    for (const SpecField& part : object_fields(field.kind)) {
      const std::string key(part.pointer.substr(1));
      if (is_numeric(part) && !numbers.contains(key)) changed.erase(key);
    }
  }
  changed.update(numbers);
  return changed;
}

}  // namespace

Json spec_with(const DesignFile& file, const Design& design,
               const std::map<std::string, std::string>& references) {
  Json document = file.document;
  // An estimated drag is in no spec, which is read with that of its mass; what takes its place is
  // written whole.
  const bool was_estimate = file.design.drone.drag.is_estimate;
  Design as_read = design;
  as_read.drone.drag.is_estimate = true;
  renew_drag_estimate(as_read.drone);
  const bool stays_estimate =
      was_estimate && std::ranges::none_of(spec_fields(), [&](const SpecField& field) {
        return may_be_left_out(field) && plain_json(design, field) != plain_json(as_read, field);
      });
  for (const SpecField& field : spec_fields()) {
    const auto write = [&](Json value) {
      document[Json::json_pointer(std::string(field.pointer))] = std::move(value);
    };
    const auto named = references.find(dot_path(field.pointer));
    const std::string reference = named == references.end() ? "" : named->second;
    switch (field.kind) {
      case FieldKind::text:
      case FieldKind::motor_points:
        break;
      case FieldKind::motor:
      case FieldKind::conductor:
      case FieldKind::insulation_material:
        if (entry_numbers(design, field.kind) == entry_numbers(file.design, field.kind)) break;
        write(field.kind == FieldKind::motor
                  ? entry_json(file, file.motor, design, field, reference)
              : field.kind == FieldKind::conductor
                  ? entry_json(file, file.conductor, design, field, reference)
                  : entry_json(file, file.insulation, design, field, reference));
        break;
      default:
        if (may_be_left_out(field) && stays_estimate) break;
        if (Json value = plain_json(design, field);
            (may_be_left_out(field) && was_estimate) || value != plain_json(file.design, field)) {
          write(std::move(value));
        }
    }
  }
  return document;
}

nlohmann::ordered_json spec_with_drag(const DesignFile& file, const DragFit& fit) {
  Design design = file.design;
  const double asymmetry = design.drone.drag.fore_aft_asymmetry;
  design.drone.drag = fit.drag();
  design.drone.drag.fore_aft_asymmetry = asymmetry;
  return read_design_document(spec_with(file, design), file.file, file.load).document;
}

}  // namespace tethercalc
