#include "tethercalc/files/gnuplot.hpp"

#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <system_error>

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

}  // namespace

// Standard input, output and error are files: nobody waits for anybody, whatever the sizes.
std::string run_gnuplot(const std::string& script) {
  const Scratch in = scratch_file();
  const Scratch out = scratch_file();
  const Scratch err = scratch_file();
  if (std::fwrite(script.data(), 1, script.size(), in.get()) != script.size() ||
      std::fflush(in.get()) != 0) {
    throw InputError("gnuplot",
                     "cannot be given what to draw: " + std::generic_category().message(errno));
  }
  std::rewind(in.get());

  posix_spawn_file_actions_t actions{};
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ::fileno(in.get()), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ::fileno(out.get()), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ::fileno(err.get()), STDERR_FILENO);
  std::array<char, 8> program{"gnuplot"};
  std::array<char, 3> defaults{"-d"};  // no start-up file of the user
  const std::array<char*, 3> arguments{program.data(), defaults.data(), nullptr};
  pid_t child = 0;
  const int error =
      ::posix_spawnp(&child, program.data(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw InputError("gnuplot",
                     "draws figures as .pdf and .png and cannot be started (" +
                         std::generic_category().message(error) +
                         "); install the Debian package gnuplot-nox, or draw the figure as .svg "
                         "or with characters, which need none; FILE.gp is the script for it");
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "gnuplot is lost");
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw std::runtime_error("gnuplot failed: " + content(err.get()));
  }
  return content(out.get());
}

}  // namespace tethercalc
