// Runs the real program as a shell would.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "support/printed_codes.hpp"

namespace tethercalc::test {

/// A folder that is removed with everything in it at the end of its scope.
class TemporaryFolder {
 public:
  TemporaryFolder()
      : path_(std::filesystem::temp_directory_path() /
              ("tethercalc-test-" + std::to_string(getpid()) + "-" +
               std::to_string(std::random_device{}()))) {
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct Ran {
  int exit_code = -1;
  std::string out;
  std::string err;
};

inline std::string file_text(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

inline void write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

inline std::string shell_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// The columns that the widest line takes on a terminal: UTF-8 characters, not bytes.
inline std::size_t widest_line(const std::string& text) {
  std::size_t widest = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const auto characters =
        std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; });
    widest = std::max(widest, static_cast<std::size_t>(characters));
  }
  return widest;
}

/// Runs a shell line with standard output and error caught.
inline Ran run_shell(const std::string& line) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "out";
  const auto err = folder.path() / "err";
  const int status = std::system(
      ("( " + line + " ) >" + shell_quoted(out.string()) + " 2>" + shell_quoted(err.string()))
          .c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), file_text(out),
          file_text(err)};
}

/// Runs `tethercalc` with `arguments`, `input` on standard input. Every code of its answer has a
/// page, but for effects of files, which nobody but their authors can explain.
inline Ran run_tethercalc(const std::vector<std::string>& arguments,
                          const std::string& input = {}) {
  const TemporaryFolder folder;
  write_file(folder.path() / "in", input);
  std::string line = shell_quoted(TETHERCALC_COMMAND);
  for (const std::string& argument : arguments) line += " " + shell_quoted(argument);
  Ran run = run_shell(line + " <" + shell_quoted((folder.path() / "in").string()));
  if (std::count(arguments.begin(), arguments.end(), "--effects") == 0) require_pages(run.out);
  return run;
}

/// A file of the project by its path from the root.
inline std::string project_file(const std::string& name) {
  return std::string(TETHERCALC_SOURCE_DIR) + "/" + name;
}

}  // namespace tethercalc::test
