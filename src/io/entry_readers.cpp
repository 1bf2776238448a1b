#include "io/entry_readers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "io/closest_name.hpp"
#include "io/embedded_files.hpp"
#include "io/json_document.hpp"
#include "io/motor_points.hpp"
#include "tethercalc/io/motor_bench.hpp"
#include "tethercalc/model/motor_curve.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

using Json = nlohmann::ordered_json;

/// An object of a file or spec, held against its fields.
class EntryObject {
 public:
  EntryObject(const JsonPlace& object, std::span<const SpecField> fields, Problems& problems)
      : fields_(fields),
        problems_(problems),
        before_(problems.count()),
        places_(field_places(object, fields, problems)) {}

  [[nodiscard]] const JsonPlace& at(std::string_view pointer) const {
    return places_[index_of(pointer)];
  }
  /// In its practical unit.
  std::optional<double> number(std::string_view pointer) {
    return checked_number(at(pointer), fields_[index_of(pointer)], problems_);
  }
  /// All numbers of a material, in a design that has no others.
  Design numbers() {
    Design design;
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (!is_numeric(fields_[i])) continue;
      const auto value = checked_number(places_[i], fields_[i], problems_);
      if (value) set_field(design, fields_[i], *value);
    }
    return design;
  }
  template <typename Entry>
  void set_texts(Entry& entry) {
    entry.id = checked_text(at("/id"), problems_);
    entry.name = checked_text(at("/name"), problems_);
    entry.source = checked_text(at("/source"), problems_);
  }
  [[nodiscard]] bool faulty() const { return problems_.count() > before_; }

 private:
  [[nodiscard]] std::size_t index_of(std::string_view pointer) const {
    std::size_t i = 0;
    while (fields_[i].pointer != pointer) ++i;
    return i;
  }

  std::span<const SpecField> fields_;
  Problems& problems_;
  std::size_t before_;
  std::vector<JsonPlace> places_;
};

std::optional<MotorPoint> read_motor_point(const JsonPlace& place, Problems& problems) {
  EntryObject point(place, object_fields(FieldKind::motor_points), problems);
  point.number("/throttle_percent");
  const std::optional<double> thrust = point.number("/thrust_g");
  const std::optional<double> efficiency = point.number("/efficiency_g_per_W");
  const std::optional<double> power = point.number("/power_W");
  if (point.faulty()) return std::nullopt;
  if (efficiency.has_value() == power.has_value()) {
    return problems.refuse(place.where(),
                           fmt::format("give either efficiency_g_per_W or power_W, found {}",
                                       power ? "both" : "neither"));
  }
  return MotorPoint{*thrust * unit::gram_force, power ? *power : *thrust / *efficiency};
}

std::optional<std::vector<BenchPoint>> read_motor_points(const JsonPlace& place,
                                                         Problems& problems) {
  if (!place.given()) return std::nullopt;
  if (!place.value->is_array()) {
    return problems.refuse(place.where(),
                           "expected a list of points, found " + type_name(*place.value));
  }
  if (place.value->size() < 2) {
    return problems.refuse(
        place.where(),
        fmt::format("a motor curve needs at least 2 points, found {}", place.value->size()));
  }
  std::vector<BenchPoint> points;
  for (std::size_t i = 0; i < place.value->size(); ++i) {
    if (const auto point = read_motor_point(place.element(i), problems)) {
      points.push_back({*point, fmt::format("point {}", i + 1)});
    }
  }
  if (points.size() != place.value->size()) return std::nullopt;
  return points;
}

std::optional<MotorEntry> motor_from_object(const JsonPlace& object, Problems& problems) {
  EntryObject entry_object(object, object_fields(FieldKind::motor), problems);
  MotorEntry entry;
  entry_object.set_texts(entry);
  entry.voltage_V = entry_object.number("/voltage_V");
  entry.propeller_in = entry_object.number("/propeller_in");
  const std::optional<double> density = entry_object.number("/measured_air_density_kg_m3");
  const std::optional<double> uncertainty = entry_object.number("/power_uncertainty_percent");
  const JsonPlace& points_place = entry_object.at("/points");
  const auto points = read_motor_points(points_place, problems);
  if (!points || entry_object.faulty()) return std::nullopt;
  if (!set_curve(entry, *points, points_place.where(), problems)) return std::nullopt;
  entry.curve.set_measured_in(density);
  if (const auto impossible = impossible_merit(entry)) {
    return problems.refuse(object.where(), *impossible);
  }
  if (uncertainty) {
    entry.curve.set_uncertainty(*uncertainty / 100);
    entry.warnings.push_back(
        {WarningKind::motor_estimated,
         fmt::format(
             "{}: the motor is an estimate, not measured: its power may be off by about {:g} % "
             "either way (power_uncertainty_percent)",
             object.where(), *uncertainty)});
  }
  return entry;
}

/// A conductor or an insulation material, whose numbers are those of `member` in a tether.
template <typename Entry, FieldKind kind, auto numbers, auto member>
std::optional<Entry> material_from_object(const JsonPlace& object, Problems& problems) {
  EntryObject entry_object(object, object_fields(kind), problems);
  Entry entry;
  entry_object.set_texts(entry);
  entry.*numbers = entry_object.numbers().tether.*member;
  return entry_object.faulty() ? std::nullopt : std::optional(std::move(entry));
}

/// A kind of entry: its folder in the library and what reads it.
template <typename Entry>
struct EntryKind {
  std::string_view folder;  ///< also what `list` calls it
  std::string_view noun;
  bool may_be_csv = false;
  std::optional<Entry> (*from_object)(const JsonPlace&, Problems&);
};

template <typename Entry>
constexpr EntryKind<Entry> kind_of{};
template <>
constexpr EntryKind<MotorEntry> kind_of<MotorEntry>{"motors", "motor", true, &motor_from_object};
template <>
constexpr EntryKind<ConductorEntry> kind_of<ConductorEntry>{
    "conductors", "conductor", false,
    &material_from_object<ConductorEntry, FieldKind::conductor, &ConductorEntry::conductor,
                          &Tether::conductor>};
template <>
constexpr EntryKind<InsulationEntry> kind_of<InsulationEntry>{
    "insulation", "insulation material", false,
    &material_from_object<InsulationEntry, FieldKind::insulation_material,
                          &InsulationEntry::insulation, &Tether::insulation>};

constexpr std::string_view json_suffix = ".json";

/// The id of a library file of this folder: what stands between the folder and ".json".
std::optional<std::string> id_in_folder(std::string_view file, std::string_view folder) {
  if (!file.starts_with(folder) || !file.ends_with(json_suffix)) return std::nullopt;
  file.remove_prefix(folder.size());
  if (!file.starts_with('/')) return std::nullopt;
  file.remove_prefix(1);
  file.remove_suffix(json_suffix.size());
  return std::string(file);
}

template <typename Entry>
std::optional<Entry> entry_from_text(std::string_view text, const std::string& name,
                                     Problems& problems) {
  const JsonDocument document = parse_json(text, name, Quoting::nothing);
  const std::size_t before = problems.count();
  problems.add(document.problems);
  std::optional<Entry> entry =
      kind_of<Entry>.from_object({&document, &document.root, ""}, problems);
  return problems.count() == before ? std::move(entry) : std::nullopt;
}

template <typename Entry>
std::optional<Entry> entry_from_library(const std::string& id, const std::string& where,
                                        Problems& problems) {
  constexpr EntryKind<Entry> kind = kind_of<Entry>;
  std::vector<std::string> ids;
  for (const EmbeddedFile& file : embedded_files()) {
    const auto found = id_in_folder(file.name, kind.folder);
    if (!found) continue;
    if (*found == id) return entry_from_text<Entry>(file.content, std::string(file.name), problems);
    ids.push_back(*found);
  }
  return problems.refuse(
      where, fmt::format("no {} {} in the library{} (`tethercalc list {}` shows all; the "
                         "path of a file holds a \"/\" or ends in .json{})",
                         kind.noun, shown(id), did_you_mean(id, ids), kind.folder,
                         kind.may_be_csv ? " or .csv" : ""));
}

template <typename Entry>
std::optional<Entry> entry_from_file(const std::string& reference, const TextLoader& load,
                                     const std::string& where, Problems& problems) {
  LoadedText file;
  try {
    if (!load) throw InputError(reference, "is a file, and there are none here");
    file = load(reference);
  } catch (const InputError& error) {
    for (const InputProblem& problem : error.problems()) {
      problems.add(where, fmt::format("{}: {}", problem.where, problem.message));
    }
    return std::nullopt;
  }
  std::optional<Entry> entry;
  if constexpr (std::is_same_v<Entry, MotorEntry>) {
    if (reference.ends_with(".csv")) return motor_from_bench_csv(file.text, file.name, problems);
  }
  problems.succeeds([&] { entry = entry_from_text<Entry>(file.text, file.name, problems); });
  if (entry && entry->id.empty()) entry->id = as_utf8(file_stem(file.name));
  return entry;
}

template <typename Entry>
std::optional<Entry> entry_named(const std::string& reference, const TextLoader& load,
                                 const std::string& where, Problems& problems) {
  return names_a_file(reference) ? entry_from_file<Entry>(reference, load, where, problems)
                                 : entry_from_library<Entry>(reference, where, problems);
}

double awg_area(int gauge) {
  const double diameter = 0.127 * std::pow(92.0, (36.0 - gauge) / 39.0) * unit::millimetre;
  return std::numbers::pi / 4 * diameter * diameter;
}

void add_metric_sizes(std::vector<WireSize>& sizes, const char* standard,
                      const nlohmann::ordered_json& areas_mm2) {
  for (const double area : areas_mm2) {
    sizes.push_back({standard, fmt::format("{} mm²", area), area * unit::square_millimetre});
  }
}

}  // namespace

bool names_a_file(std::string_view reference) {
  // No entry's id ends like a file.
  return reference.find('/') != std::string_view::npos || reference.ends_with(json_suffix) ||
         reference.ends_with(".csv");
}

template <typename Entry>
Entry find_entry(const std::string& reference, const TextLoader& load, const std::string& where) {
  Problems problems;
  std::optional<Entry> entry = entry_named<Entry>(reference, load, where, problems);
  problems.throw_if_any();
  return std::move(*entry);
}

template <typename Entry>
std::optional<Entry> entry_at(const JsonPlace& place, const TextLoader& load, Problems& problems) {
  if (!place.given()) return std::nullopt;
  if (place.value->is_object()) return kind_of<Entry>.from_object(place, problems);
  if (place.value->is_string()) {
    return entry_named<Entry>(place.value->get<std::string>(), load, place.where(), problems);
  }
  return problems.refuse(
      place.where(),
      fmt::format("expected the name of a {}, the path of a file or an object, found {}",
                  kind_of<Entry>.noun, type_name(*place.value)));
}

template <typename Entry>
std::vector<Entry> library_entries() {
  std::vector<Entry> entries;
  for (const EmbeddedFile& file : embedded_files()) {
    if (const auto id = id_in_folder(file.name, kind_of<Entry>.folder)) {
      entries.push_back(find_entry<Entry>(*id, {}, std::string(kind_of<Entry>.noun)));
    }
  }
  return entries;
}

template std::vector<MotorEntry> library_entries();
template std::vector<ConductorEntry> library_entries();
template std::vector<InsulationEntry> library_entries();
template MotorEntry find_entry(const std::string&, const TextLoader&, const std::string&);
template ConductorEntry find_entry(const std::string&, const TextLoader&, const std::string&);
template InsulationEntry find_entry(const std::string&, const TextLoader&, const std::string&);
template std::optional<MotorEntry> entry_at(const JsonPlace&, const TextLoader&, Problems&);
template std::optional<ConductorEntry> entry_at(const JsonPlace&, const TextLoader&, Problems&);
template std::optional<InsulationEntry> entry_at(const JsonPlace&, const TextLoader&, Problems&);

std::optional<MotorEntry> motor_from_bench_csv(const std::string& text, const std::string& name,
                                               Problems& problems) {
  std::optional<MotorEntry> motor;
  const LoadedText table{name, text};
  problems.succeeds([&] { motor = motor_from_bench({&table, 1}).motor; });
  return motor;
}

void put_entry(Design& design, const MotorEntry& entry) { design.drone.motor = entry.curve; }

void put_entry(Design& design, const ConductorEntry& entry) {
  design.tether.conductor = entry.conductor;
}

void put_entry(Design& design, const InsulationEntry& entry) {
  Insulation sheath = entry.insulation;
  sheath.thickness = design.tether.insulation.thickness;
  sheath.dielectric_safety_factor = design.tether.insulation.dielectric_safety_factor;
  design.tether.insulation = sheath;
}

std::vector<MotorEntry> library_motors() { return library_entries<MotorEntry>(); }
std::vector<ConductorEntry> library_conductors() { return library_entries<ConductorEntry>(); }
std::vector<InsulationEntry> library_insulation() { return library_entries<InsulationEntry>(); }

MotorEntry find_motor(const std::string& reference, const TextLoader& load,
                      const std::string& where) {
  return find_entry<MotorEntry>(reference, load, where);
}

ConductorEntry find_conductor(const std::string& reference, const TextLoader& load,
                              const std::string& where) {
  return find_entry<ConductorEntry>(reference, load, where);
}

InsulationEntry find_insulation(const std::string& reference, const TextLoader& load,
                                const std::string& where) {
  return find_entry<InsulationEntry>(reference, load, where);
}

std::vector<WireSize> wire_sizes() {
  const nlohmann::ordered_json tables = json_of(embedded_file("wire_sizes.json"));
  std::vector<WireSize> sizes;
  const nlohmann::ordered_json& awg = tables.at("awg");
  for (int gauge = awg.at("from"); gauge <= awg.at("to").get<int>(); ++gauge) {
    sizes.push_back({"AWG", fmt::format("AWG {}", gauge), awg_area(gauge)});
  }
  add_metric_sizes(sizes, "IEC 60228", tables.at("iec60228").at("areas_mm2"));
  add_metric_sizes(sizes, "VDE 0295", tables.at("fine_strand").at("areas_mm2"));
  std::ranges::stable_sort(sizes, {}, &WireSize::area);
  return sizes;
}

}  // namespace tethercalc
