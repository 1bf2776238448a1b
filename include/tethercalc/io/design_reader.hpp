// A design out of a JSON spec.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/library.hpp"
#include "tethercalc/model/design.hpp"

namespace tethercalc {

/// A spec as read.
struct DesignFile {
  Design design;     ///< what the spec describes, in SI units
  std::string name;  ///< the spec's "name", otherwise the file's name without folder and suffix
  std::string file;  ///< as messages call it: the path as given, or "standard input"
  TextLoader load;   ///< reads the files that the spec refers to
  MotorEntry motor;  ///< behind design.drone.motor
  ConductorEntry conductor;         ///< behind design.tether.conductor
  InsulationEntry insulation;       ///< behind design.tether.insulation
  nlohmann::ordered_json document;  ///< the spec itself, overrides included
  std::vector<Warning> warnings;    ///< what the user should know; the design is usable
};

/// Reads a spec; `file` is what messages call it, and `load` reads the files that it refers to.
///
/// Each of `overrides` is "path=value", such as "supply.voltage_V=60" or
/// "drone.motor=tmotor-mn2806-650kv-13in": the value is JSON, or a text where it is no JSON, and
/// takes the place of what the text has there, with the same result as editing it.
///
/// Throws InputError with every problem found: what is no JSON or too deeply nested, unknown keys
/// (with the closest known one), missing fields, wrong types, numbers out of range, unknown library
/// names, problems of motor and material files, and fields in conflict.
[[nodiscard]] DesignFile parse_design(std::string_view text, const std::string& file,
                                      const TextLoader& load = {},
                                      std::span<const std::string> overrides = {});

/// The same for a document in memory, as for one extended by a program.
[[nodiscard]] DesignFile read_design_document(nlohmann::ordered_json document,
                                              const std::string& file, const TextLoader& load = {});

/// A complete spec, valid as it stands, for a beginner to edit.
[[nodiscard]] std::string starting_spec();

}  // namespace tethercalc
