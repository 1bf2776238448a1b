#include "cli/commands.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <utility>

#include "files/output_files.hpp"
#include "io/checked_values.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/files/threads.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/sweep_axes.hpp"
#include "tethercalc/report/design_report.hpp"
#include "tethercalc/report/sweep_report.hpp"

namespace tethercalc::cli {
namespace {

volatile std::sig_atomic_t interrupting_signal = 0;

/// While it lives, the first SIGINT or SIGTERM is noted instead of obeyed; a second one ends the
/// program as usual.
class InterruptGuard {
 public:
  InterruptGuard() {
    struct sigaction noting {};
    noting.sa_handler = [](int signal) { interrupting_signal = signal; };
    noting.sa_flags = static_cast<int>(SA_RESETHAND);
    for (auto& [signal, old] : noted_) {
      ::sigaction(signal, &noting, &old);
      // Who started this program deaf to a signal, as shells do in the background, meant it.
      if (old.sa_handler == SIG_IGN) ::sigaction(signal, &old, nullptr);
    }
  }
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  ~InterruptGuard() {
    for (const auto& [signal, old] : noted_) ::sigaction(signal, &old, nullptr);
  }

 private:
  std::pair<int, struct sigaction> noted_[2] = {{SIGINT, {}}, {SIGTERM, {}}};
};

std::string duration_words(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

/// A line on the terminal, where standard error is one and rows do not go there too.
class Progress {
 public:
  Progress(RowRange range, bool rows_on_terminal) : range_(range) {
    const char* terminal = std::getenv("TERM");
    shown_ = !rows_on_terminal && shows_progress() && terminal != nullptr &&
             std::string_view(terminal) != "dumb";
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() {
    if (drawn_) std::fputs("\r\x1b[K", stderr);
  }

  void reached(std::uint64_t row) {
    const Clock::time_point now = Clock::now();
    if (!shown_ || now < next_) return;
    next_ = now + std::chrono::milliseconds(200);
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const auto done = static_cast<double>(row - range_.begin);
    const auto all = static_cast<double>(range_.end - range_.begin);
    const double rate = done / seconds;
    std::fputs(fmt::format("\r\x1b[K{} of {} designs ({:.0f} %), {:.3g} a second, {} left", done,
                           all, 100 * done / all, rate, duration_words((all - done) / rate))
                   .c_str(),
               stderr);
    drawn_ = true;
  }

 private:
  using Clock = std::chrono::steady_clock;
  RowRange range_;
  bool shown_ = false;
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_ = start_ + std::chrono::milliseconds(200);
};

/// So many designs, over a minute of a thread at the best rate, are worth a word before they begin:
/// a step with a zero too many looks like work.
constexpr std::uint64_t large_sweep = 10'000'000;

void tell_large(const RowRange& range) {
  const std::uint64_t designs = range.end - range.begin;
  if (designs < large_sweep) return;
  remark(fmt::format(
      "sweep: {} designs to compute; coarser steps or --sample make fewer, --shard splits them\n",
      designs));
}

RowFormat row_format(const std::string& format) {
  if (format == "csv") return RowFormat::csv;
  if (format == "jsonl" || format == "json") return RowFormat::json_lines;
  throw InputError(
      "--format", fmt::format("\"{}\" is no format of a sweep; allowed are csv and jsonl", format));
}

/// The part of the sweep to compute, counted from 1, and the number of parts.
struct Shard {
  std::uint64_t part = 0;
  std::uint64_t parts = 0;
};

Shard parsed_shard(const std::string& text) {
  if (text.empty()) return {1, 1};
  Shard shard;  // what is no number leaves 0
  const char* const end = text.data() + text.size();
  const char* const slash = std::from_chars(text.data(), end, shard.part).ptr;
  const bool whole =
      slash != end && *slash == '/' && std::from_chars(slash + 1, end, shard.parts).ptr == end;
  if (!whole || shard.part < 1 || shard.part > shard.parts) {
    throw InputError("--shard",
                     fmt::format("\"{}\" is not i/n with i from 1 to n, such as 2/8", text));
  }
  return shard;
}

bool to_standard_output(const SweepOptions& options) {
  return options.file.empty() || options.file == "-";
}

/// What does not go together, or needs what is missing.
void check_options(const SweepOptions& options, Problems& problems) {
  if (options.varied.empty()) {
    problems.add(
        "tethercalc sweep",
        "nothing varies: give --vary path=values, such as --vary supply.voltage_V=40:100:5");
  }
  if (options.resume && to_standard_output(options)) {
    problems.add("--resume", "needs --output FILE: only a file can be continued");
  }
  if (!options.method.empty() && !options.sample) {
    problems.add("--method", "needs --sample N: only a sample is drawn");
  }
  if (options.seed && !options.sample) {
    problems.add("--seed", "needs --sample N: only a sample is drawn");
  }
  if (!options.summary_file.empty() && !options.sample) {
    problems.add("--summary", "needs --sample N: only a sample has a summary");
  }
  if (!options.summary_file.empty() && !options.shard.empty()) {
    problems.add("--summary", "needs every draw, so it does not go with --shard");
  }
}

/// One run's rows: which they are, and how they read.
struct Sweep {
  const SweepSpace& space;
  const Design& base;
  SweepRows rows;
  RowRange range;
  bool header = false;  ///< the rows follow a line of column names

  [[nodiscard]] RowWriter writer() const {
    return [this](std::string& text, const SweepRow& row) { rows.append(text, row); };
  }

  [[nodiscard]] std::string line(std::uint64_t row) const {
    std::string text;
    compute_sweep({&space, &base, writer(), {row, row + 1}, row, {}},
                  [&text](const SweepChunk& chunk) {
                    text = chunk.text;
                    return true;
                  });
    text.pop_back();
    return text;
  }

  /// Line `n` of the file, counted from 0; empty beyond its end.
  [[nodiscard]] std::string file_line(std::uint64_t n) const {
    if (header && n == 0) return rows.header().substr(0, rows.header().size() - 1);
    const std::uint64_t row = range.begin + n - (header ? 1 : 0);
    return row < range.end ? line(row) : "";
  }
};

/// Number of rows of the sweep that `file` already holds. Its first, last and broken line are
/// compared with what this run would have written there.
std::uint64_t rows_done(const Sweep& sweep, const RowFile& file) {
  const std::uint64_t lines = file.lines_found();
  const std::uint64_t headers = sweep.header ? 1 : 0;
  if (lines > headers + sweep.range.end - sweep.range.begin) {
    throw InputError(file.name(),
                     fmt::format("holds {} rows, more than the {} of this sweep", lines - headers,
                                 sweep.range.end - sweep.range.begin));
  }
  const auto expect = [&](std::uint64_t line, const std::string& found, bool broken) {
    const std::string expected = sweep.file_line(line);
    if (broken ? expected.starts_with(found) : found == expected) return;
    throw InputError(
        fmt::format("{}:{}", file.name(), line + 1),
        fmt::format("does not belong to this sweep, so it cannot be continued: the spec, the "
                    "options or the program differ\n  found    {}\n  expected {}",
                    found.substr(0, 200), expected.substr(0, 200)));
  };
  if (lines > 0) expect(0, file.first_line(), false);
  if (lines > 0) expect(lines - 1, file.last_line(), false);
  if (!file.broken_line().empty()) expect(lines, file.broken_line(), true);
  return lines > headers ? lines - headers : 0;
}

std::string how_to_continue(const RowFile& file) {
  return file.is_regular() && file.name() != "standard output"
             ? fmt::format("{} ends with a whole row; the same command with --resume continues it",
                           file.name())
             : std::string("with --output FILE, --resume could continue");
}

/// Writes all rows from `first` on. Returns false where it was interrupted.
bool write_rows(const Sweep& sweep, RowFile& file, std::uint64_t first, const ChunkRunner& runner,
                SweepSummary* summary) {
  SweepJob job{&sweep.space, &sweep.base, sweep.writer(), {first, sweep.range.end}, first, runner};
  if (summary != nullptr) job.range.begin = sweep.range.begin;  // it needs the earlier rows as well
  std::uint64_t written = first;
  try {
    Progress progress(job.range, file.name() == "standard output" && ::isatty(STDOUT_FILENO) == 1);
    const bool fresh = first == sweep.range.begin && file.lines_found() == 0;
    if (fresh && sweep.header) file.append(sweep.rows.header());
    compute_sweep(job, [&](const SweepChunk& chunk) {
      if (interrupting_signal != 0) return false;
      file.append(chunk.text);
      written = std::max(first, chunk.range.end);
      if (summary != nullptr) {
        for (const JudgedRow& row : chunk.judged) summary->add(row);
      }
      progress.reached(chunk.range.end);
      return true;
    });
    file.close();
  } catch (const std::system_error& error) {
    if (error.code().value() == EPIPE) die_of_closed_pipe();
    throw InputError(file.name(), fmt::format("cannot be written: {}; {}", error.code().message(),
                                              how_to_continue(file)));
  }
  if (interrupting_signal == 0) return true;
  remark(fmt::format("tethercalc: interrupted after {} of {} designs; {}\n",
                     written - sweep.range.begin, sweep.range.end - sweep.range.begin,
                     how_to_continue(file)));
  return false;
}

}  // namespace

int run_sweep(const SweepOptions& options) {
  Problems problems;
  check_options(options, problems);
  RowFormat format = RowFormat::csv;
  Shard shard;
  DesignFile base;
  problems.succeeds([&] { format = row_format(options.format); });
  problems.succeeds([&] { shard = parsed_shard(options.shard); });
  problems.succeeds([&] { [[maybe_unused]] const auto known = sample_method(options.method); });
  problems.succeeds([&] { base = read_spec(options.spec); });
  problems.throw_if_any();
  std::optional<SampleRequest> sample;
  if (options.sample) sample = {*options.sample, options.method, options.seed.value_or(0)};
  const SweepSpace space = read_sweep_space(options.varied, base, sample);
  remark_unused(options.spec, space.axes(), "sweep", "--vary");
  remark_warnings("sweep", sweep_warnings(base, space, ground_contact(space, base.design)));
  const ChunkRunner runner = several_threads(options.jobs > 0 ? options.jobs : all_cores());

  const Sweep sweep{space, base.design, SweepRows(space.axes(), format),
                    shard_rows(space.rows(), shard.part, shard.parts),
                    format == RowFormat::csv && shard.part == 1};
  tell_large(sweep.range);
  for (const auto& [option, written] :
       {std::pair{"--output", options.file}, std::pair{"--summary", options.summary_file}}) {
    check_not_read(option, written);
  }
  RowFile file = to_standard_output(options) ? RowFile::standard_output()
                 : options.resume            ? RowFile::resume(options.file)
                                             : RowFile::create(options.file);
  const std::uint64_t first = sweep.range.begin + rows_done(sweep, file);

  SweepSummary summary;
  const bool summarised = space.sample() && options.shard.empty();
  interrupting_signal = 0;
  bool completed = false;
  {
    const InterruptGuard guard;
    completed = write_rows(sweep, file, first, runner, summarised ? &summary : nullptr);
  }
  if (!completed) {
    // Die of the signal after all, so that a shell's loop around this command ends as well.
    std::raise(interrupting_signal);
    return 128 + interrupting_signal;
  }
  if (summarised) {
    summary.sensitivity = sweep_sensitivity(space, base.design, runner);
    if (!options.summary_file.empty()) {
      write_asked("--summary", options.summary_file, json_text(summary_json(summary, space)));
    }
    remark(summary_text(summary, space, {}));
  }
  return done;
}

}  // namespace tethercalc::cli
