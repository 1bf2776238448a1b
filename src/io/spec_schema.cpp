// The JSON Schema of design specs, made from the tables of fields.
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "io/checked_values.hpp"
#include "tethercalc/io/spec_fields.hpp"

namespace tethercalc {
namespace {

using Json = nlohmann::ordered_json;

Json reference_to(const char* definition) {
  return {{"$ref", std::string("#/$defs/") + definition}};
}

void add_range(Json& schema, const FieldRange& range) {
  if (std::isfinite(range.min)) {
    schema[range.min_excluded ? "exclusiveMinimum" : "minimum"] = range.min;
  }
  if (std::isfinite(range.max)) {
    schema[range.max_excluded ? "exclusiveMaximum" : "maximum"] = range.max;
  }
}

Json name_or_object(const char* definition, const char* what_a_text_is) {
  return {{"anyOf",
           {Json{{"type", "string"}, {"description", what_a_text_is}}, reference_to(definition)}}};
}

Json list_of(const char* definition, int at_least) {
  return {{"type", "array"}, {"minItems", at_least}, {"items", reference_to(definition)}};
}

/// What values of a kind look like, ranges not included.
Json schema_of_kind(FieldKind kind) {
  switch (kind) {
    case FieldKind::number:
      return {{"type", "number"}};
    case FieldKind::optional_number:
      return {{"type", {"number", "null"}}};
    case FieldKind::integer:
      return {{"type", "integer"}};
    case FieldKind::boolean:
      return {{"type", "boolean"}};
    case FieldKind::text:
      return {{"type", "string"}};
    case FieldKind::condition:
    case FieldKind::strength_material:
    case FieldKind::tether_model:
    case FieldKind::wind_profile: {
      const auto words = field_words(kind);
      return {{"enum", std::vector<std::string>(words.begin(), words.end())}};
    }
    case FieldKind::motor:
      return name_or_object("motor", "name in the library, or path of a .json or .csv file");
    case FieldKind::conductor:
      return name_or_object("conductor", "name in the library, or path of a .json file");
    case FieldKind::insulation_material:
      return name_or_object("insulation", "name in the library, or path of a .json file");
    case FieldKind::efficiency:
      return {{"type", {"number", "array"}},
              {"minItems", 1},
              {"items", reference_to("efficiency_point")}};
    case FieldKind::converter_masses:
      return {{"type", "array"}, {"items", reference_to("converter_mass")}};
    case FieldKind::motor_points:
      return list_of("motor_point", 2);
  }
  return {};
}

Json schema_of_field(const SpecField& field) {
  Json schema = schema_of_kind(field.kind);
  add_range(schema, field.range);
  std::string description(field.help);
  if (!field.unit.empty()) description += " Unit: " + std::string(field.unit) + ".";
  schema["description"] = description;
  if (!field.required()) schema["default"] = json_of(field.default_json);
  return schema;
}

Json empty_object() {
  return {{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}};
}

void require(Json& object, std::string_view key) {
  Json& required = object["required"];
  for (const Json& known : required) {
    if (known == key) return;
  }
  required.push_back(key);
}

/// An object with these fields; "/" in their pointers makes objects within the object.
Json schema_of_object(std::span<const SpecField> fields) {
  Json schema = empty_object();
  for (const SpecField& field : fields) {
    Json* object = &schema;
    std::vector<std::string_view> groups = split(field.pointer.substr(1), '/');
    const std::string_view key = groups.back();
    groups.pop_back();
    for (const std::string_view group : groups) {
      if (field.required() && !may_be_left_out(field)) require(*object, group);
      Json& properties = (*object)["properties"];
      if (!properties.contains(group)) properties[std::string(group)] = empty_object();
      object = &properties[std::string(group)];
    }
    if (field.required()) require(*object, key);
    (*object)["properties"][std::string(key)] = schema_of_field(field);
  }
  return schema;
}

Json motor_point_schema() {
  Json schema = schema_of_object(object_fields(FieldKind::motor_points));
  const auto with = [](const char* key) {
    return Json{{"properties", {{key, {{"type", "number"}}}}}, {"required", Json::array({key})}};
  };
  schema["oneOf"] = Json::array({with("efficiency_g_per_W"), with("power_W")});
  return schema;
}

}  // namespace

Json spec_schema() {
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", "Design spec of a tethered drone"}};
  schema.update(schema_of_object(spec_fields()));
  schema["$defs"] = {
      {"motor", schema_of_object(object_fields(FieldKind::motor))},
      {"motor_point", motor_point_schema()},
      {"conductor", schema_of_object(object_fields(FieldKind::conductor))},
      {"insulation", schema_of_object(object_fields(FieldKind::insulation_material))},
      {"efficiency_point", schema_of_object(object_fields(FieldKind::efficiency))},
      {"converter_mass", schema_of_object(object_fields(FieldKind::converter_masses))}};
  return schema;
}

}  // namespace tethercalc
