#include "io/spec_paths.hpp"

#include <algorithm>
#include <span>

#include "io/json_document.hpp"
#include "tethercalc/io/spec_fields.hpp"

namespace tethercalc {
namespace {

bool is_list(FieldKind kind) {
  return kind == FieldKind::motor_points || kind == FieldKind::efficiency ||
         kind == FieldKind::converter_masses;
}

std::string_view without_index(std::string_view rest) {
  const std::size_t end = std::min(rest.find('/', 1), rest.size());
  const bool is_index = rest.substr(1, end - 1).find_first_not_of("0123456789") == rest.npos;
  return is_index ? rest.substr(end) : rest;
}

/// True where some spec may have a value at `pointer`.
bool may_exist(std::string_view pointer, std::span<const SpecField> fields) {
  return std::ranges::any_of(fields, [&](const SpecField& field) {
    if (is_at_or_below(field.pointer, pointer)) return true;
    if (!is_at_or_below(pointer, field.pointer)) return false;
    std::string_view rest = pointer.substr(field.pointer.size());
    if (is_list(field.kind)) rest = without_index(rest);
    return rest.empty() || may_exist(rest, object_fields(field.kind));
  });
}

}  // namespace

bool is_at_or_below(std::string_view pointer, std::string_view top) {
  return pointer == top || is_below(pointer, top);
}

std::string pointer_of(std::string_view dotted) {
  if (dotted.starts_with('/')) return std::string(dotted);
  std::string pointer = "/" + std::string(dotted);
  std::ranges::replace(pointer, '.', '/');
  return pointer;
}

bool may_be_in_spec(std::string_view pointer) { return may_exist(pointer, spec_fields()); }

}  // namespace tethercalc
