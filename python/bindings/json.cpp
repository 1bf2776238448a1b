// JSON as Python's own values and back.
#include <cmath>
#include <mutex>
#include <vector>

#include "bindings/binding.hpp"

namespace tethercalc::python {
namespace {

using Json = nlohmann::ordered_json;

struct LeftRunning {
  std::mutex mutex;
  std::vector<std::thread> threads;
};

LeftRunning& left_running() {
  static LeftRunning left;
  return left;
}

}  // namespace

void leave_running(std::thread thread) {
  LeftRunning& left = left_running();
  const std::lock_guard lock(left.mutex);
  left.threads.push_back(std::move(thread));
}

void join_left_running() {
  const py::gil_scoped_release released;
  LeftRunning& left = left_running();
  const std::lock_guard lock(left.mutex);
  for (std::thread& thread : left.threads) thread.join();
  left.threads.clear();
}

py::object to_python(const Json& json) {
  switch (json.type()) {
    case Json::value_t::object: {
      py::dict out;
      for (const auto& [key, value] : json.items()) out[py::str(key)] = to_python(value);
      return out;
    }
    case Json::value_t::array: {
      py::list out;
      for (const Json& value : json) out.append(to_python(value));
      return out;
    }
    case Json::value_t::string:
      return py::str(json.get_ref<const std::string&>());
    case Json::value_t::boolean:
      return py::bool_(json.get<bool>());
    case Json::value_t::number_integer:
      return py::int_(json.get<std::int64_t>());
    case Json::value_t::number_unsigned:
      return py::int_(json.get<std::uint64_t>());
    case Json::value_t::number_float:
      return py::float_(json.get<double>());
    default:
      return py::none();
  }
}

Json to_json(py::handle value) {
  if (value.is_none()) return nullptr;
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>();
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (py::isinstance<py::dict>(value)) {
    Json out = Json::object();
    for (const auto& [key, member] : py::reinterpret_borrow<py::dict>(value)) {
      if (!py::isinstance<py::str>(key)) throw py::type_error("keys of a spec are texts");
      out[key.cast<std::string>()] = to_json(member);
    }
    return out;
  }
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    Json out = Json::array();
    for (const py::handle member : value) out.push_back(to_json(member));
    return out;
  }
  // NumPy's integers and floats say what they are by the same methods as Python's own.
  if (PyIndex_Check(value.ptr()) != 0) {
    const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
    if (!number) throw py::error_already_set();
    return number.cast<std::int64_t>();
  }
  const double number = PyFloat_AsDouble(value.ptr());
  if (PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    throw py::type_error("a spec holds no " +
                         py::str(py::type::handle_of(value).attr("__name__")).cast<std::string>());
  }
  return number;
}

}  // namespace tethercalc::python
