// A design as numbers, to compare two of them exactly.
#pragma once

#include <span>
#include <vector>

#include "tethercalc/io/spec_fields.hpp"

namespace tethercalc::test {

/// Every number of a design that a spec can hold, as it holds it.
inline std::vector<double> numbers_of(const Design& design) {
  std::vector<double> numbers;
  const auto add_fields = [&](std::span<const SpecField> fields) {
    for (const SpecField& field : fields) {
      numbers.push_back(field_value_si(design, field).value_or(-1e9));
      if (!field_words(field.kind).empty()) {
        numbers.push_back(static_cast<double>(field_word(design, field)));
      }
    }
  };
  add_fields(spec_fields());
  add_fields(object_fields(FieldKind::conductor));
  add_fields(object_fields(FieldKind::insulation_material));
  for (const MotorPoint& point : design.drone.motor.vertices()) {
    numbers.insert(numbers.end(), {point.thrust, point.power});
  }
  numbers.push_back(design.drone.motor.measured_in().value_or(-1e9));
  for (const EfficiencyPoint& point : design.supply.converter.efficiency) {
    numbers.insert(numbers.end(), {point.output_power, point.efficiency});
  }
  for (const ConverterMassPoint& point : design.supply.converter.masses) {
    numbers.insert(numbers.end(), {point.rated_output_power, point.mass});
  }
  return numbers;
}

}  // namespace tethercalc::test
