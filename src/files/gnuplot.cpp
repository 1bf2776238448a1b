#include "tethercalc/files/gnuplot.hpp"

#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <set>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "report/characters.hpp"
#include "tethercalc/io/input_error.hpp"

extern "C" char** environ;

namespace tethercalc {
namespace {

/// A file in memory, gone when closed: it needs no folder that can be written.
using Scratch = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

Scratch scratch_file() {
  const int descriptor = ::memfd_create("gnuplot", MFD_CLOEXEC);
  std::FILE* file = descriptor < 0 ? nullptr : ::fdopen(descriptor, "w+");
  if (file == nullptr) {
    throw std::system_error(errno, std::generic_category(), "cannot make a temporary file");
  }
  return {file, std::fclose};
}

std::string content(std::FILE* file) {
  std::rewind(file);
  std::string out;
  std::array<char, 1 << 14> chunk{};
  for (std::size_t size = 0; (size = std::fread(chunk.data(), 1, chunk.size(), file)) > 0;) {
    out.append(chunk.data(), size);
  }
  return out;
}

/// What a program did.
struct Ended {
  int start_error = 0;  ///< of errno, where it could not be started
  bool well = false;    ///< whether it ended with exit code 0
  std::string out{};
  std::string err{};
};

/// Runs a program found on PATH. Standard input, output and error are files: nobody waits for
/// anybody, whatever the sizes.
Ended run_program(std::vector<std::string> words, const std::string& input) {
  const Scratch in = scratch_file();
  const Scratch out = scratch_file();
  const Scratch err = scratch_file();
  if (std::fwrite(input.data(), 1, input.size(), in.get()) != input.size() ||
      std::fflush(in.get()) != 0) {
    throw InputError(words.front(),
                     "cannot be given its input: " + std::generic_category().message(errno));
  }
  std::rewind(in.get());

  posix_spawn_file_actions_t actions{};
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ::fileno(in.get()), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ::fileno(out.get()), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ::fileno(err.get()), STDERR_FILENO);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int error =
      ::posix_spawnp(&child, arguments.front(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return {.start_error = error};
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) {
      throw std::system_error(errno, std::generic_category(), words.front() + " is lost");
    }
  }
  return {.well = WIFEXITED(status) && WEXITSTATUS(status) == 0,
          .out = content(out.get()),
          .err = content(err.get())};
}

/// Those of `characters` that some font has; fc-list comes with the library that draws gnuplot's
/// letters.
std::set<std::uint32_t> with_a_font(const std::set<std::uint32_t>& characters) {
  std::set<std::uint32_t> found;
  if (characters.empty()) return found;
  // All fonts at once, each as one line of ranges: "20-7e a0-17f 2010".
  const Ended asked = run_program({"fc-list", "--format", "%{charset}\n"}, "");
  if (!asked.well) return found;
  std::istringstream ranges(asked.out);
  for (std::string range; ranges >> range;) {
    const std::size_t dash = range.find('-');
    const auto hex = [](const std::string& text) {
      return static_cast<std::uint32_t>(std::strtoul(text.c_str(), nullptr, 16));
    };
    const std::uint32_t first = hex(range);
    const std::uint32_t last = dash == std::string::npos ? first : hex(range.substr(dash + 1));
    const auto end = characters.upper_bound(last);
    for (auto at = characters.lower_bound(first); at != end; ++at) found.insert(*at);
  }
  return found;
}

/// The script with a box for every character that no font has: gnuplot draws them as boxes of its
/// own, with their number in digits, many times as large as letters.
std::string with_fonts(const std::string& script) {
  constexpr std::uint32_t latin_end = 0x250;  // every font has them
  std::set<std::uint32_t> rare;
  for_each_character(script, [&](std::uint32_t character, std::string_view) {
    if (character >= latin_end) rare.insert(character);
  });
  const std::set<std::uint32_t> drawable = with_a_font(rare);
  std::string out;
  for_each_character(script, [&](std::uint32_t character, std::string_view bytes) {
    out += character < latin_end || drawable.contains(character) ? bytes : "\u25A1";
  });
  return out;
}

}  // namespace

std::string run_gnuplot(const std::string& script) {
  // Without the start-up file of the user.
  const Ended drawn = run_program({"gnuplot", "-d"}, with_fonts(script));
  if (drawn.start_error != 0) {
    throw InputError("gnuplot",
                     "draws figures as .pdf and .png and cannot be started (" +
                         std::generic_category().message(drawn.start_error) +
                         "); install the Debian package gnuplot-nox, or draw the figure as .svg "
                         "or with characters, which need none; FILE.gp is the script for it");
  }
  if (!drawn.well) throw std::runtime_error("gnuplot failed: " + drawn.err);
  return drawn.out;
}

}  // namespace tethercalc
