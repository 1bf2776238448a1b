#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "cli/commands.hpp"
#include "files/input_files.hpp"
#include "files/output_files.hpp"
#include "io/json_document.hpp"
#include "report/characters.hpp"

namespace tethercalc::cli {

TextStyle style_for(const Output& output) {
  const char* no_color = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  if (output.colour != Colour::automatic) return {output.colour == Colour::always};
  const bool wanted = no_color == nullptr || *no_color == '\0';
  const bool able = terminal != nullptr && std::string_view(terminal) != "dumb";
  return {output.file.empty() && wanted && able && ::isatty(STDOUT_FILENO) == 1};
}

std::string base_name(const std::string& file) {
  return file == "-" ? "standard input" : std::filesystem::path(file).filename().string();
}

namespace {

bool quiet = false;

void print_on_error(std::string_view lines) {
  // Where nobody can be told, that is no reason to fail.
  const std::string text = printable_lines(lines);
  [[maybe_unused]] const std::size_t ignored = std::fwrite(text.data(), 1, text.size(), stderr);
}

}  // namespace

void remark(std::string_view lines) {
  if (!quiet) print_on_error(lines);
}

void remark_warnings(std::string_view command, std::span<const Warning> warnings) {
  for (const Warning& warning : warnings) {
    remark(fmt::format("{}: {}\n", command, warning.sentence));
  }
}

void be_quiet() { quiet = true; }

bool shows_progress() { return !quiet && ::isatty(STDERR_FILENO) == 1; }

int terminal_columns() {
  if (const char* given = std::getenv("COLUMNS")) {
    if (const int columns = std::atoi(given); columns > 0) return columns;
  }
  winsize window{};
  const bool known = ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0;
  return known ? window.ws_col : 100;
}

void die_of_closed_pipe() {
  std::signal(SIGPIPE, SIG_DFL);
  std::raise(SIGPIPE);
  std::_Exit(128 + SIGPIPE);  // where the signal is blocked
}

std::string is_read_words(const std::string& file) {
  return fmt::format("\"{}\" is read; give another file to write", file);
}

void check_not_read(const std::string& option, const std::string& file) {
  if (has_been_read(file)) throw InputError(option, is_read_words(file));
}

void write_asked(const std::string& option, const std::string& file, std::string_view content) {
  check_not_read(option, file);
  write_whole_file(file, content);
}

void emit(const Output& output, const std::string& text) {
  if (!output.file.empty()) return write_asked("--output", output.file, text);
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    if (errno == EPIPE) die_of_closed_pipe();
    throw InputError("standard output",
                     "cannot be written: " + std::generic_category().message(errno));
  }
}

void emit_lines(const Output& output, const std::function<void(const LineTaker&)>& lines) {
  constexpr std::size_t part = std::size_t{1} << 20;
  std::optional<WholeFile> file;
  if (!output.file.empty()) {
    check_not_read("--output", output.file);
    file.emplace(output.file);
  }
  std::string kept;
  const auto pass_on = [&] {
    if (file) {
      file->append(kept);
    } else {
      emit(output, kept);
    }
    kept.clear();
  };
  lines([&](std::string_view line) {
    kept += line;
    if (kept.size() >= part) pass_on();
  });
  pass_on();
  if (file) file->commit();
}

void emit(const Output& output, const std::function<std::string()>& text,
          const std::function<nlohmann::ordered_json()>& json,
          const std::function<std::string()>& csv) {
  emit(output, output.format == Format::table  ? text()
               : output.format == Format::json ? json_text(json())
                                               : csv());
}

}  // namespace tethercalc::cli

namespace {

/// Where standard input, output or error are closed, the next file opened would take its number,
/// and be written what was meant for them. What stands there instead cannot be used either.
void occupy_closed_descriptors() {
  constexpr std::array wrong_way{O_WRONLY, O_RDONLY, O_RDONLY};  // input, output, error
  for (int number = STDIN_FILENO; number <= STDERR_FILENO; ++number) {
    if (::fcntl(number, F_GETFD) >= 0) continue;
    [[maybe_unused]] const int lowest_free =
        ::open("/dev/null", wrong_way[static_cast<std::size_t>(number)]);
  }
}

void say(const char* words) {
  [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, words, std::strlen(words));
}

/// Reading a mapped file beyond where its end has come to be meanwhile ends here. Nothing but the
/// simplest system calls may be made.
void end_of_shortened_file(int, siginfo_t* fault, void*) {
  tethercalc::remove_unfinished_file();
  const char* const name = tethercalc::mapped_file_at(fault->si_addr);
  say(name != nullptr ? name : "tethercalc");
  say(name != nullptr ? ": was shortened while it was read; nothing was made of it\n"
                      : ": a file was shortened while it was read; nothing was made of it\n");
  ::_exit(tethercalc::cli::bad_input);
}

/// Who interrupts the program shall find no part of a file.
void end_of_interrupted(int signal) {
  tethercalc::remove_unfinished_file();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void tidy_up_on_signals() {
  // Files in the midst of being written are to be tidied up where a reader closes the pipe or a
  // file grows beyond what is allowed (ulimit -f); the calls that write tell of both.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  struct sigaction shortened {};
  shortened.sa_sigaction = end_of_shortened_file;
  shortened.sa_flags = SA_SIGINFO;
  ::sigaction(SIGBUS, &shortened, nullptr);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    // Who started this program deaf to a signal, as shells do in the background, meant it.
    if (std::signal(signal, end_of_interrupted) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

}  // namespace

int main(int argc, char** argv) {
  using namespace tethercalc;
  occupy_closed_descriptors();
  tidy_up_on_signals();
  try {
    return cli::run(argc, argv);
  } catch (const InputError& error) {
    cli::print_on_error(std::string(error.what()) + "\n");
    return cli::bad_input;
  } catch (const std::exception& error) {
    cli::print_on_error(std::string("tethercalc: internal error: ") + error.what() + "\n");
    return cli::internal_error;
  }
}
