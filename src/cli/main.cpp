#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "cli/commands.hpp"
#include "files/output_files.hpp"

namespace tethercalc::cli {

TextStyle style_for(const Output& output) {
  const char* no_color = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  const bool wanted = no_color == nullptr || *no_color == '\0';
  const bool able = terminal != nullptr && std::string_view(terminal) != "dumb";
  return {output.file.empty() && wanted && able && ::isatty(STDOUT_FILENO) == 1};
}

std::string base_name(const std::string& file) {
  return file == "-" ? "standard input" : std::filesystem::path(file).filename().string();
}

void emit(const Output& output, const std::string& text) {
  if (!output.file.empty()) return write_whole_file(output.file, text);
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw InputError("standard output",
                     "cannot be written: " + std::generic_category().message(errno));
  }
}

std::string json_text(const nlohmann::ordered_json& json) { return json.dump(2) + "\n"; }

void emit(const Output& output, const std::function<std::string()>& text,
          const std::function<nlohmann::ordered_json()>& json,
          const std::function<std::string()>& csv) {
  emit(output, output.format == Format::table  ? text()
               : output.format == Format::json ? json_text(json())
                                               : csv());
}

}  // namespace tethercalc::cli

int main(int argc, char** argv) {
  using namespace tethercalc;
  // A reader that closes the pipe is an error to report, not a signal to die of.
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return cli::run(argc, argv);
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return cli::bad_input;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tethercalc: internal error: %s\n", error.what());
    return cli::internal_error;
  }
}
