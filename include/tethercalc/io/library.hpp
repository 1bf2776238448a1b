// Motors, conductors, insulation materials and wire sizes that come with the program, and the files
// in which users bring their own.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tethercalc/model/design.hpp"
#include "tethercalc/study/optimum.hpp"

namespace tethercalc {

/// A text that a spec or an option refers to.
struct LoadedText {
  std::string name;  ///< as messages call it
  std::string text;  ///< all of it
};

/// What reads the files that a spec refers to: the text behind a reference as it stands there.
/// Throws InputError with the reason where there is none. An empty one means that there are none.
using TextLoader = std::function<LoadedText(const std::string& reference)>;

/// A conductor material. Texts are empty where the file gives none.
struct ConductorEntry {
  std::string id;       ///< what specs and options call it
  std::string name;     ///< what people call it
  std::string source;   ///< where its numbers come from
  Conductor conductor;  ///< its physics
};

/// An insulation material. Texts are empty where the file gives none.
struct InsulationEntry {
  std::string id;         ///< what specs and options call it
  std::string name;       ///< what people call it
  std::string source;     ///< where its numbers come from
  Insulation insulation;  ///< its physics; the wall is the spec's
};

/// Puts an entry into a design; the wall and the safety factor of its insulation stay.
void put_entry(Design& design, const MotorEntry& entry);
/// Likewise.
void put_entry(Design& design, const ConductorEntry& entry);
/// Likewise.
void put_entry(Design& design, const InsulationEntry& entry);

/// All motors of the library, by id. They are part of the program, which needs no files for them.
[[nodiscard]] std::vector<MotorEntry> library_motors();

/// All conductor materials of the library, by id.
[[nodiscard]] std::vector<ConductorEntry> library_conductors();

/// All insulation materials of the library, by id.
[[nodiscard]] std::vector<InsulationEntry> library_insulation();

/// The motor that `reference` names: an id in the library or, where it holds a "/" or ends in
/// ".json" or ".csv", a file that `load` reads. Such a file is either an object with a
/// motor's fields or a test-bench CSV, see `motor_from_bench`; one without an id is called after
/// its file. Points that do not rise are pooled (`isotonic_motor_points`), and idle rows of a CSV,
/// without thrust or power, are left out; `warnings` says so. Throws InputError with all problems
/// of the file, or with the closest id where there is no such name. `where` is what its message
/// calls the place of the reference, such as the name of an option.
[[nodiscard]] MotorEntry find_motor(const std::string& reference, const TextLoader& load = {},
                                    const std::string& where = "motor");

/// The conductor material that `reference` names, found as `find_motor` does; a file is a JSON
/// object with its fields.
[[nodiscard]] ConductorEntry find_conductor(const std::string& reference,
                                            const TextLoader& load = {},
                                            const std::string& where = "conductor");

/// The insulation material that `reference` names, found as `find_motor` does; a file is a JSON
/// object with its fields.
[[nodiscard]] InsulationEntry find_insulation(const std::string& reference,
                                              const TextLoader& load = {},
                                              const std::string& where = "insulation");

/// All sizes, by rising area. AWG n has the diameter 0.127 mm · 92^((36 − n)/39) (ASTM B258); IEC
/// 60228 lists aluminium from 10 mm² only, so smaller ones are sizes of copper.
[[nodiscard]] std::vector<WireSize> wire_sizes();

}  // namespace tethercalc
