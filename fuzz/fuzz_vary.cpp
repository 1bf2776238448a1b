// Whatever is written after --vary, one axis a line, it becomes values that the spec may hold, or
// problems. A first line "sample" draws instead of enumerating.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/io/sweep_axes.hpp"

namespace {

using namespace tethercalc;

void require(bool holds) {
  if (!holds) std::abort();
}

std::vector<std::string> lines_of(const std::uint8_t* data, std::size_t size) {
  std::vector<std::string> lines(1);
  for (std::size_t i = 0; i < size; ++i) {
    if (data[i] == '\n') {
      lines.emplace_back();
    } else {
      lines.back().push_back(static_cast<char>(data[i]));
    }
  }
  if (lines.back().empty()) lines.pop_back();
  return lines;
}

/// The first rows and the last are designs without a conflict.
void require_sound_rows(const SweepSpace& space, const DesignFile& base) {
  SweepCursor cursor(space, base.design);
  const std::uint64_t few = std::min<std::uint64_t>(space.rows(), 20);
  for (std::uint64_t i = 0; i < 2 * few; ++i) {
    cursor.move_to(i < few ? i : space.rows() - (2 * few - i));
    require(find_conflicts(cursor.design()).empty());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const DesignFile base = [] {
    DesignFile file = parse_design(starting_spec(), "starting spec");
    file.folder = "/nowhere";  // names of files lead to none
    return file;
  }();
  std::vector<std::string> varied = lines_of(data, size);
  const bool sampled = !varied.empty() && varied.front() == "sample";
  if (sampled) varied.erase(varied.begin());
  if (varied.size() > 8) return 0;
  try {
    std::vector<SweepAxis> axes =
        read_axes(varied, base, sampled ? AxisUse::sampled : AxisUse::enumerated);
    for (const SweepAxis& axis : axes) {
      require(std::isfinite(quantile(axis, 0.25)) && std::isfinite(quantile(axis, 0.75)));
    }
    const SweepSpace space =
        sampled ? SweepSpace(std::move(axes), SamplePlan{100}) : SweepSpace(std::move(axes));
    if (space.rows() > 100000) return 0;
    check_sweep_rows(space, base);
    require_sound_rows(space, base);
  } catch (const InputError& error) {
    require(!error.problems().empty());
  } catch (const std::invalid_argument&) {
    // More rows than can be counted, or more axes than there are Sobol dimensions.
  }
  return 0;
}
