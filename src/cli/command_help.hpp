// What the program's commands and options are called and for: one description, from which help,
// manual page and completion are made.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tethercalc::cli {

struct OptionHelp {
  std::vector<std::string> names;    ///< as typed, "-o" before "--output"; of an argument "SPEC"
  std::string value;                 ///< what follows: "FILE"; empty for a flag
  std::string help;                  ///< a sentence, with the default
  std::string group;                 ///< what it serves; help shows options by it
  std::vector<std::string> words{};  ///< that an argument may be, where they are few
};

struct CommandHelp {
  std::string name;
  std::string summary;
  std::vector<OptionHelp> arguments{};
  std::vector<OptionHelp> options{};
  std::vector<std::string> examples{};  ///< shell lines
};

/// The help of one command in lines of at most `columns` characters.
[[nodiscard]] std::string command_help(const CommandHelp& command, std::size_t columns);

/// The help of the program: what commands there are.
[[nodiscard]] std::string program_help(std::span<const CommandHelp> commands, std::size_t columns);

/// All commands as a manual page (man(7)).
[[nodiscard]] std::string manual_page(std::span<const CommandHelp> commands);

/// Shells that `completion_script` knows.
[[nodiscard]] std::span<const std::string_view> completed_shells();

/// The script that has `shell`, one of those, complete commands, options, the fields of specs and
/// names of the library.
[[nodiscard]] std::string completion_script(std::span<const CommandHelp> commands,
                                            std::string_view shell);

}  // namespace tethercalc::cli
