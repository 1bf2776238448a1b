// Every field of a design spec, described once: the reader, the JSON Schema, `--set`, sweeps and
// the reference in docs/spec.md are all driven by these tables.
#pragma once

#include <cstddef>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tethercalc/model/design.hpp"

namespace tethercalc {

/// What may stand in a field.
enum class FieldKind {
  number,
  optional_number,      ///< a number, or null for none
  integer,              ///< a number without a fraction; 4.0 is one, as in JSON Schema
  boolean,              ///< true or false
  text,                 ///< any text
  condition,            ///< "hover" or "forward"
  strength_material,    ///< "none", "aramid" or "uhmwpe"
  tether_model,         ///< "straight" or "solved"
  wind_profile,         ///< "uniform", "power_law" or "logarithmic"
  motor,                ///< name in the library, path of a .json or .csv file, or an object
  conductor,            ///< name in the library, path of a .json file, or an object
  insulation_material,  ///< likewise
  efficiency,           ///< a number, or a list of objects
  converter_masses,     ///< a list of objects
  motor_points          ///< a list of objects, at least two
};

/// Allowed numbers, in the unit of the field.
struct FieldRange {
  double min = -std::numeric_limits<double>::infinity();  ///< the smallest
  double max = std::numeric_limits<double>::infinity();   ///< the largest
  bool min_excluded = false;  ///< true: more than `min`, not equal to it
  bool max_excluded = false;  ///< true: less than `max`, not equal to it

  [[nodiscard]] bool contains(double value) const;  ///< false for NaN
};

/// Where in a Design the field lives; nothing for texts and for what a library entry fills. An
/// `optional_number` without one is nothing there, or 0 where the design knows no nothing.
using FieldAccess =
    std::variant<std::monostate, double& (*)(Design&), std::optional<double>& (*)(Design&),
                 int& (*)(Design&), bool& (*)(Design&), Condition& (*)(Design&),
                 Converter& (*)(Design&), StrengthMaterial& (*)(Design&), TetherModel& (*)(Design&),
                 WindProfile& (*)(Design&)>;

/// One field: how a spec writes it, what it may hold, and where it goes.
struct SpecField {
  std::string_view pointer;  ///< JSON pointer from the root of its object: "/supply/voltage_V"
  FieldKind kind = FieldKind::number;  ///< what may stand in it
  std::string_view unit;               ///< "" where it has none
  FieldRange range;                    ///< of numbers
  std::string_view default_json;       ///< JSON text of the default; "" where the field is required
  std::string_view help;               ///< one sentence
  double si_factor = 1;                ///< times the practical number gives SI
  FieldAccess access{};                ///< where in a Design it lives

  /// True where a spec without the field is refused.
  [[nodiscard]] bool required() const { return default_json.empty(); }
};

/// Whether the field is of the group `drone.drag`, which a spec may leave out as a whole: its drag
/// is then estimated (`drag_of_mass`). Where the group is there, its required fields have to be.
[[nodiscard]] inline bool may_be_left_out(const SpecField& field) {
  return field.pointer.starts_with("/drone/drag/");
}

/// The fields of a design spec, in the order in which people should read them.
[[nodiscard]] std::span<const SpecField> spec_fields();

/// The fields of the object that may stand in a field of this kind, as of a motor, or of every
/// object in its list, as of an efficiency curve; none for kinds that hold no objects.
[[nodiscard]] std::span<const SpecField> object_fields(FieldKind kind);

/// The field of a spec at `path`, either "supply.voltage_V" or "/supply/voltage_V", or the number
/// of a material in it, such as "tether.conductor.density_g_cm3"; null where there is none. Its
/// pointer is that in the spec.
[[nodiscard]] const SpecField* find_field(std::string_view path);

/// "no field X in a spec; did you mean Y?" for `path`, Y being also told where only its last part
/// was given ("voltage"), and left out where none is near.
[[nodiscard]] std::string no_such_field(std::string_view path);

/// "supply.voltage_V" of "/supply/voltage_V": how options name a field.
[[nodiscard]] std::string dot_path(std::string_view pointer);

/// "at least 1 and at most 1000000 g": the allowed numbers in words, for messages.
[[nodiscard]] std::string describe_range(const SpecField& field);

/// Puts `value`, in the field's practical unit, where the field lives. The fast way for sweeps: it
/// parses nothing. An efficiency becomes constant. Throws std::invalid_argument with a message for
/// people where the field takes no number (see `is_numeric`) or the value is out of its range, NaN
/// included. Conflicts between fields are not looked at: see `find_conflicts`.
void set_field(Design& design, const SpecField& field, double value);

/// What `set_field` put there, in the field's practical unit; nothing where it holds no single
/// number: a field that takes none, an optional one that is not set, an efficiency curve.
[[nodiscard]] std::optional<double> field_value(const Design& design, const SpecField& field);

/// The same in SI, as the design holds it.
[[nodiscard]] std::optional<double> field_value_si(const Design& design, const SpecField& field);

/// True where `set_field` accepts numbers.
[[nodiscard]] bool is_numeric(const SpecField& field);

/// The words that a boolean, condition, strength material, tether model or wind profile is written
/// with, by rising value; empty for every other kind.
[[nodiscard]] std::span<const std::string> field_words(FieldKind kind);

/// The index of the word for what is where the field lives; it must be of a kind that has words.
[[nodiscard]] std::size_t field_word(const Design& design, const SpecField& field);

/// Puts the value of word `index` where the field lives; it must be of a kind that has words.
void set_word(Design& design, const SpecField& field, std::size_t index);

/// Two fields that are each in range and do not go together.
struct FieldConflict {
  std::string_view pointer;  ///< the field to change first
  std::string message;       ///< a sentence with both values
};

/// Why a wind profile has no wind: it is logarithmic, and its roughness length is not less than the
/// least of the heights over ground, both in m, at which the wind is known. Nothing where it has.
[[nodiscard]] std::optional<std::string> roughness_conflict(WindProfile profile,
                                                            double roughness_length,
                                                            double known_at);

/// Conflicts between the fields of a design, such as a converter that cuts off at or above the
/// supply voltage, or a station far aside of a drone whose tether hangs straight down. Whoever puts
/// numbers into designs asks here. Where the ends of ranges, each with each, are free of conflicts,
/// so is all between them.
[[nodiscard]] std::vector<FieldConflict> find_conflicts(const Design& design);

/// Whether `find_conflicts` looks at the field with this dot path.
[[nodiscard]] bool may_conflict(std::string_view path);

/// A JSON Schema (draft 2020-12) of design specs. It allows what the reader allows, except for what
/// a schema cannot see: other files, library names, conflicts between fields, the order of the
/// points of a curve, duplicate keys.
[[nodiscard]] nlohmann::ordered_json spec_schema();

}  // namespace tethercalc
