// Many designs: a NumPy array of records, and the rows that the command writes.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <fmt/format.h>

#include <memory>
#include <vector>

#include "bindings/binding.hpp"
#include "bindings/design_object.hpp"
#include "files/output_files.hpp"
#include "tethercalc/files/threads.hpp"
#include "tethercalc/io/sweep_axes.hpp"
#include "tethercalc/report/sweep_report.hpp"

namespace tethercalc::python {
namespace {

/// A sweep as asked for.
struct Asked {
  Asked(const DesignObject& object, const std::vector<std::string>& varied,
        const std::optional<SampleRequest>& sample, unsigned jobs)
      : base(object.file()),
        space(read_sweep_space(varied, *base, sample)),
        threads(jobs > 0 ? jobs : all_cores()) {}

  std::shared_ptr<const DesignFile> base;
  SweepSpace space;
  unsigned threads;
};

/// Computes all rows, and hands the text of each chunk to `consume`, which is called with Python's
/// lock. Ctrl-C ends it between two chunks.
void computed(const Asked& asked, const RowWriter& write,
              const std::function<void(const SweepChunk&)>& consume) {
  const SweepJob job{&asked.space,
                     &asked.base->design,
                     write,
                     {0, asked.space.rows()},
                     0,
                     several_threads(asked.threads)};
  bool interrupted = false;
  {
    const py::gil_scoped_release released;
    compute_sweep(job, [&](const SweepChunk& chunk) {
      const py::gil_scoped_acquire held;
      interrupted = PyErr_CheckSignals() != 0;
      if (!interrupted) consume(chunk);
      return !interrupted;
    });
  }
  if (interrupted) throw py::error_already_set();
}

/// How NumPy calls a column's type.
std::string type_code(const RecordColumn& column) {
  return column.characters > 0 ? fmt::format("<U{}", column.characters) : "<f8";
}

py::dtype record_type(const SweepRecords& records) {
  py::list names;
  py::list formats;
  py::list offsets;
  for (const RecordColumn& column : records.columns()) {
    names.append(column.name);
    formats.append(type_code(column));
    offsets.append(column.offset);
  }
  return py::dtype(names, formats, offsets, static_cast<py::ssize_t>(records.size()));
}

class Sweep {
 public:
  explicit Sweep(std::shared_ptr<const Asked> asked) : asked_(std::move(asked)) {
    const SweepRecords records(asked_->space.axes());
    auto bytes = std::make_unique<std::string>();
    bytes->reserve(asked_->space.rows() * records.size());
    const RowWriter write = [&](std::string& text, const SweepRow& row) {
      records.append(text, row);
    };
    const bool sampled = asked_->space.sample().has_value();
    if (sampled) summary_.emplace();
    computed(*asked_, write, [&](const SweepChunk& chunk) {
      bytes->append(chunk.text);
      if (!sampled) return;
      for (const JudgedRow& row : chunk.judged) summary_->add(row);
    });
    char* const first = bytes->data();
    const py::capsule owner(bytes.release(),
                            [](void* kept) { delete static_cast<std::string*>(kept); });
    array_ = py::array(record_type(records), {static_cast<py::ssize_t>(asked_->space.rows())}, {},
                       first, owner);
  }

  [[nodiscard]] const py::array& array() const { return array_; }

  /// Computes the rows once more, and hands their lines to `take`.
  void write_csv(const std::function<void(std::string_view)>& take) const {
    const SweepRows rows(asked_->space.axes(), RowFormat::csv);
    take(rows.header());
    computed(
        *asked_, [&](std::string& text, const SweepRow& row) { rows.append(text, row); },
        [&](const SweepChunk& chunk) { take(chunk.text); });
  }

  [[nodiscard]] py::object summary() const {
    if (!summary_) return py::none();
    if (!analysed_) {
      const auto asked = asked_;
      summary_->sensitivity = interruptible([asked](const StopFlag&) {
        return sweep_sensitivity(asked->space, asked->base->design,
                                 several_threads(asked->threads));
      });
      analysed_ = true;
    }
    return to_python(summary_json(*summary_, asked_->space));
  }

 private:
  std::shared_ptr<const Asked> asked_;
  py::array array_;
  mutable std::optional<SweepSummary> summary_;
  mutable bool analysed_ = false;
};

Sweep sweep(const py::object& spec, const std::vector<std::string>& varied,
            std::optional<std::uint64_t> draws, const std::string& method, std::uint64_t seed,
            unsigned jobs) {
  std::optional<SampleRequest> sample;
  if (draws) sample = {*draws, method, seed};
  return Sweep(std::make_shared<const Asked>(*design_of(spec), varied, sample, jobs));
}

}  // namespace

void bind_sweeps(py::module_& module) {
  py::class_<Sweep>(module, "Sweep", "The designs of a sweep and what each comes to.")
      .def_property_readonly(
          "array", &Sweep::array,
          "A structured array with a record a design, whose fields are the columns of the "
          "command's CSV but for the reason. It shows the memory that the sweep was computed into; "
          "numbers that do not exist are NaN, words empty.")
      .def("__repr__",
           [](const Sweep& sweep) {
             return fmt::format("<tethercalc.Sweep of {} designs>", sweep.array().size());
           })
      .def("__len__", [](const Sweep& sweep) { return sweep.array().size(); })
      .def("__getitem__",
           [](const Sweep& sweep, const py::object& key) {
             return sweep.array().attr("__getitem__")(key);
           })
      .def("__array__", [](const Sweep& sweep,
                           const py::args& how) { return sweep.array().attr("__array__")(*how); })
      .def(
          "to_csv",
          [](const Sweep& sweep, const py::object& path) -> py::object {
            if (path.is_none()) {
              std::string text;
              sweep.write_csv([&](std::string_view lines) { text += lines; });
              return py::str(text);
            }
            WholeFile file(py::module_::import("os").attr("fspath")(path).cast<std::string>());
            sweep.write_csv([&](std::string_view lines) { file.append(lines); });
            file.commit();
            return py::none();
          },
          py::arg("path") = py::none(),
          "The rows as the command writes them, byte by byte, into a file or as a text. They are "
          "computed once more.")
      .def_property_readonly(
          "summary", &Sweep::summary,
          "Of a sample: how its results are spread and which inputs spread them; else None.");
  module.def("_sweep", sweep, py::arg("spec"), py::arg("varied"), py::arg("sample"),
             py::arg("method"), py::arg("seed"), py::arg("jobs"));
}

}  // namespace tethercalc::python
