// Designs: read, looked into, changed and written.
#include <pybind11/stl.h>

#include <fmt/format.h>

#include <unordered_map>
#include <vector>

#include "bindings/design_object.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/library.hpp"
#include "tethercalc/io/spec_writer.hpp"
#include "tethercalc/report/design_report.hpp"

namespace tethercalc::python {
namespace {

using Json = nlohmann::ordered_json;

struct TextHash {
  using is_transparent = void;
  std::size_t operator()(std::string_view text) const {
    return std::hash<std::string_view>()(text);
  }
};

/// `find_field` remembered, so that loops do not search. Guarded by Python's lock.
const SpecField& field_at(std::string_view path) {
  static std::unordered_map<std::string, const SpecField*, TextHash, std::equal_to<>> known;
  if (const auto found = known.find(path); found != known.end()) return *found->second;
  const SpecField* field = find_field(path);
  if (field == nullptr) throw InputError(std::string(path), no_such_field(path));
  return *known.emplace(path, field).first->second;
}

/// Relative to the current folder: what a dictionary's own files are.
constexpr const char* dictionary_name = "spec";

DesignFile read_dictionary(Json document) {
  return read_design_document(std::move(document), dictionary_name, files_in(""));
}

bool is_plain_number(py::handle value) {
  return PyFloat_Check(value.ptr()) != 0 ||
         (PyLong_Check(value.ptr()) != 0 && PyBool_Check(value.ptr()) == 0);
}

std::string path_of(py::handle path) {
  return py::str(py::module_::import("os").attr("fspath")(path)).cast<std::string>();
}

std::vector<std::string> assignments(const py::dict& changes) {
  std::vector<std::string> texts;
  for (const auto& [path, value] : changes) {
    texts.push_back(path.cast<std::string>() + "=" + value_text(value));
  }
  return texts;
}

std::shared_ptr<DesignObject> load(const py::object& path, const py::dict& changes) {
  return std::make_shared<DesignObject>(read_design(path_of(path), assignments(changes)));
}

Json field_json(const SpecField& field) {
  Json json = {{"path", dot_path(field.pointer)},
               {"unit", field.unit},
               {"allowed", describe_range(field)},
               {"required", field.required()},
               {"help", field.help}};
  if (!field.required()) json["default"] = Json::parse(field.default_json);
  return json;
}

py::list all_fields() {
  py::list out;
  for (const SpecField& field : spec_fields()) out.append(to_python(field_json(field)));
  return out;
}

}  // namespace

std::string value_text(py::handle value) {
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  return to_json(value).dump();
}

DesignObject::DesignObject(DesignFile file)
    : read_(std::make_shared<const DesignFile>(std::move(file))), design_(read_->design) {}

py::object DesignObject::get(std::string_view path) const {
  const SpecField& field = field_at(path);
  if (field.kind == FieldKind::integer) return py::int_(std::lround(*field_value(design_, field)));
  if (const auto value = field_value(design_, field)) return py::float_(*value);
  const auto words = field_words(field.kind);
  if (field.kind == FieldKind::boolean) return py::bool_(field_word(design_, field) != 0);
  if (!words.empty()) return py::str(words[field_word(design_, field)]);
  const Json now = document();
  const Json::json_pointer pointer{std::string(field.pointer)};
  return now.contains(pointer) ? to_python(now.at(pointer)) : py::none();
}

void DesignObject::set(std::string_view path, py::handle value) {
  const SpecField& field = field_at(path);
  if (is_plain_number(value) && is_numeric(field)) {
    try {
      set_field(design_, field, value.cast<double>());
    } catch (const std::invalid_argument& error) {
      throw InputError(std::string(path), error.what());
    }
    changed_ = true;
    return;
  }
  const std::vector<std::string> change{std::string(path) + "=" + to_json(value).dump()};
  read_ = std::make_shared<const DesignFile>(
      parse_design(document().dump(), read_->file, read_->load, change));
  design_ = read_->design;
  changed_ = false;
}

const Design& DesignObject::design() const {
  // The reader tells of a conflict as of any other problem of a spec.
  if (changed_ && !find_conflicts(design_).empty()) static_cast<void>(file());
  return design_;
}

Json DesignObject::document() const {
  return changed_ ? spec_with(*read_, design_) : read_->document;
}

std::shared_ptr<const DesignFile> DesignObject::file() const {
  if (!changed_) return read_;
  return std::make_shared<const DesignFile>(
      read_design_document(document(), read_->file, read_->load));
}

std::shared_ptr<DesignObject> design_of(py::handle spec) {
  if (py::isinstance<DesignObject>(spec)) return spec.cast<std::shared_ptr<DesignObject>>();
  if (py::isinstance<py::dict>(spec)) {
    return std::make_shared<DesignObject>(read_dictionary(to_json(spec)));
  }
  return load(py::reinterpret_borrow<py::object>(spec), {});
}

void bind_designs(py::module_& module) {
  py::class_<DesignObject, std::shared_ptr<DesignObject>>(
      module, "Design",
      "A design: a spec that was read and checked. Fields are read and set by their dot paths, as "
      "docs/spec.md lists them: design[\"supply.voltage_V\"] = 60.")
      .def(py::init([](const py::object& spec) {
             return std::make_shared<DesignObject>(*design_of(spec));
           }),
           py::arg("spec"),
           "A spec as a dictionary or a file's path, or a copy of another design. Raises "
           "InputError with every problem.")
      .def(
          "__getitem__",
          [](const DesignObject& design, std::string_view path) { return design.get(path); },
          py::arg("path"),
          "The value in the field's own unit; None where an optional one is unset.")
      .def(
          "__setitem__",
          [](DesignObject& design, std::string_view path, const py::object& value) {
            design.set(path, value);
          },
          py::arg("path"), py::arg("value"),
          "Sets a field. Raises InputError where it does not exist or the value is not allowed; "
          "whether fields go together is looked at when something is computed.")
      .def_property_readonly(
          "name", [](const DesignObject& design) { return design.name(); },
          "What the spec calls itself.")
      .def(
          "to_dict", [](const DesignObject& design) { return to_python(design.document()); },
          "The spec as it stands.")
      .def(
          "copy", [](const DesignObject& design) { return std::make_shared<DesignObject>(design); },
          "A design of its own.")
      .def("__copy__",
           [](const DesignObject& design) { return std::make_shared<DesignObject>(design); })
      .def("__repr__", [](const DesignObject& design) {
        return fmt::format("<tethercalc.Design {}>",
                           py::repr(py::str(design.name())).cast<std::string>());
      });
  module.def("load", load, py::arg("path"), py::arg("set") = py::dict(),
             "Reads a spec from a file. `set` changes fields by their dot paths, as --set does.");
  module.def("fields", all_fields,
             "Every field of a spec: its path, unit, allowed values, default and meaning.");
}

}  // namespace tethercalc::python
