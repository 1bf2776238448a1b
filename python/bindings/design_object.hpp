// A design in Python's hands: a spec, and the fields that were changed since it was read.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "bindings/binding.hpp"
#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/io/spec_fields.hpp"

namespace tethercalc::python {

/// Numbers change in place, which takes less than a microsecond; all else by reading the spec anew,
/// as `--set` does.
class DesignObject {
 public:
  explicit DesignObject(DesignFile file);

  [[nodiscard]] py::object get(std::string_view path) const;
  void set(std::string_view path, py::handle value);

  /// What the spec calls itself, or its file's name.
  [[nodiscard]] const std::string& name() const { return read_->name; }

  /// The design as it stands. Throws InputError where fields are in conflict.
  [[nodiscard]] const Design& design() const;

  /// The spec as it stands, with all that is read from it. Throws InputError likewise.
  [[nodiscard]] std::shared_ptr<const DesignFile> file() const;

  /// The spec as it stands, also with fields in conflict.
  [[nodiscard]] nlohmann::ordered_json document() const;

 private:
  std::shared_ptr<const DesignFile> read_;  ///< as read last
  Design design_;                           ///< with the numbers changed since
  bool changed_ = false;
};

/// What an argument `spec` means: a Design, a dictionary, or a file's path. The object is the
/// caller's own where it is a Design.
[[nodiscard]] std::shared_ptr<DesignObject> design_of(py::handle spec);

/// The text that a value is written as after "path=", as `--set` and `--vary` take it.
[[nodiscard]] std::string value_text(py::handle value);

}  // namespace tethercalc::python
