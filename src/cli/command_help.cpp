#include "cli/command_help.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "report/characters.hpp"
#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/io/library.hpp"
#include "tethercalc/io/rule_books.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/report/explanation.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc::cli {
namespace {

constexpr std::string_view exit_codes =
    "Exit codes: 0 done; 1 the honest answer is no; 2 bad input; 3 internal error.";

/// One entry of a list in two columns.
std::string entry(const std::string& left, const std::string& right, std::size_t columns) {
  constexpr std::size_t second = 26;
  const std::string indent(second, ' ');
  std::string out = wrapped(right, columns, indent);
  const std::size_t used = 2 + std::size_t(columns_of(left));
  if (used + 2 > second) return "  " + left + "\n" + out;
  return out.replace(0, used, "  " + left);
}

std::string names_of(const OptionHelp& option) {
  // Long names stand below each other whether there is a short one or not.
  const bool has_short = option.names.front().size() == 2;
  std::string out = fmt::format("{}{}", has_short ? "" : "    ", fmt::join(option.names, ", "));
  if (!option.value.empty()) out += " " + option.value;
  return out;
}

std::string usage(const CommandHelp& command) {
  std::string out = "tethercalc " + command.name;
  for (const OptionHelp& argument : command.arguments) out += " " + argument.names.front();
  return out + (command.options.empty() ? "" : " [OPTIONS]");
}

/// The groups of a command's options, in the order of their first options.
std::vector<std::string> groups_of(const CommandHelp& command) {
  std::vector<std::string> groups;
  for (const OptionHelp& option : command.options) {
    if (std::ranges::count(groups, option.group) == 0) groups.push_back(option.group);
  }
  return groups;
}

/// Words that may follow an option or stand as an argument of that name; none where it is a file or
/// anything else. Words that end in "=" are begun only.
std::vector<std::string> words_for(const OptionHelp& option,
                                   std::span<const CommandHelp> commands) {
  const std::string& value = option.value.empty() ? option.names.front() : option.value;
  std::vector<std::string> words = option.words;
  if (value.starts_with("PATH=") || value == "PATH") {
    for (const SpecField& field : spec_fields()) {
      words.push_back(dot_path(field.pointer) + (value == "PATH" ? "" : "="));
    }
  } else if (value.starts_with("MOTOR")) {
    words.insert(words.end(), {"all", "alike"});
    for (const MotorEntry& motor : library_motors()) words.push_back(motor.id);
  } else if (value.starts_with("EFFECT")) {
    for (const Effect& effect : effect_catalogue()) words.push_back(effect.id);
  } else if (value == "BOOK") {
    words = rule_book_ids();
  } else if (value == "[COMMAND]") {
    for (const CommandHelp& command : commands) words.push_back(command.name);
  } else if (value == "[CODE]") {
    for (const Explanation& page : explanations()) words.push_back(page.code);
  } else if (value.find('|') != std::string::npos) {
    for (std::size_t begin = 0; begin <= value.size();) {
      const std::size_t end = std::min(value.find('|', begin), value.size());
      words.push_back(value.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  return words;
}

/// Fields whose value is a name of the library, with those names.
std::vector<std::pair<std::string, std::vector<std::string>>> named_values() {
  const auto ids = [](const auto& entries) {
    std::vector<std::string> names;
    for (const auto& entry : entries) names.push_back(entry.id);
    return names;
  };
  std::vector<std::pair<std::string, std::vector<std::string>>> out;
  for (const SpecField& field : spec_fields()) {
    std::vector<std::string> names;
    if (field.kind == FieldKind::motor) {
      names = ids(library_motors());
    } else if (field.kind == FieldKind::conductor) {
      names = ids(library_conductors());
    } else if (field.kind == FieldKind::insulation_material) {
      names = ids(library_insulation());
    } else {
      const auto words = field_words(field.kind);
      names = {words.begin(), words.end()};
    }
    if (!names.empty()) out.emplace_back(dot_path(field.pointer), std::move(names));
  }
  return out;
}

std::string bash_completion(std::span<const CommandHelp> commands) {
  std::string values;   // after an option
  std::string options;  // after a dash
  std::string first;    // elsewhere
  std::vector<std::string> names;
  for (const CommandHelp& command : commands) {
    names.push_back(command.name);
    std::vector<std::string> all;
    for (const OptionHelp& option : command.options) {
      all.insert(all.end(), option.names.begin(), option.names.end());
      const auto words = words_for(option, commands);
      if (words.empty()) continue;
      for (const std::string& name : option.names) {
        values +=
            fmt::format("    '{} {}') words='{}' ;;\n", command.name, name, fmt::join(words, " "));
      }
    }
    options += fmt::format("      {}) words='{}' ;;\n", command.name, fmt::join(all, " "));
    if (command.arguments.empty()) continue;
    if (const auto words = words_for(command.arguments.front(), commands); !words.empty()) {
      first += fmt::format("      {}) words='{}' ;;\n", command.name, fmt::join(words, " "));
    }
  }
  std::string after_equals;
  for (const auto& [path, words] : named_values()) {
    after_equals += fmt::format("      {}) words='{}' ;;\n", path, fmt::join(words, " "));
  }
  return fmt::format(
      R"(# Completion of tethercalc for bash: source it, or put it into
# ~/.local/share/bash-completion/completions/tethercalc
_tethercalc() {{
  local cur=${{COMP_WORDS[COMP_CWORD]}} command=${{COMP_WORDS[1]}} words='' path=''
  local previous=${{COMP_WORDS[COMP_CWORD-1]}}
  COMPREPLY=()
  # The shell takes "path=value" for three words.
  if [[ $cur == '=' ]]; then path=$previous cur=''
  elif [[ $previous == '=' ]]; then path=${{COMP_WORDS[COMP_CWORD-2]}}
  fi
  if [[ -n $path ]]; then
    case $path in
{after_equals}    esac
    COMPREPLY=($(compgen -W "$words" -- "$cur"))
    return
  fi
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W '{commands} --help --version' -- "$cur"))
    return
  fi
  case "$command $previous" in
{values}  esac
  if [[ -n $words ]]; then
    [[ $words == *=* ]] && compopt -o nospace
  elif [[ $cur == -* ]]; then
    case $command in
{options}    esac
    words+=' --help'
  elif ((COMP_CWORD == 2)); then
    case $command in
{first}    esac
  fi
  [[ -n $words ]] && COMPREPLY=($(compgen -W "$words" -- "$cur"))
}}
complete -o bashdefault -o default -F _tethercalc tethercalc
)",
      fmt::arg("after_equals", after_equals), fmt::arg("commands", fmt::join(names, " ")),
      fmt::arg("values", values), fmt::arg("options", options), fmt::arg("first", first));
}

/// Between single quotes of fish and zsh.
std::string quoted(std::string_view text, std::string_view quote) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string(quote) : std::string(1, c);
  return out + "'";
}

/// The words of `option` with what may follow a field's "=".
std::vector<std::string> whole_words(const OptionHelp& option,
                                     std::span<const CommandHelp> commands) {
  std::vector<std::string> words = words_for(option, commands);
  if (!option.value.starts_with("PATH=")) return words;
  for (const auto& [path, values] : named_values()) {
    for (const std::string& value : values) words.push_back(path + "=" + value);
  }
  return words;
}

std::string fish_completion(std::span<const CommandHelp> commands) {
  std::string out =
      "# Completion of tethercalc for fish: put it into "
      "~/.config/fish/completions/tethercalc.fish\n";
  const auto escaped = [](std::string_view text) { return quoted(text, "\\'"); };
  for (const CommandHelp& command : commands) {
    out += fmt::format("complete -c tethercalc -n __fish_use_subcommand -f -a {} -d {}\n",
                       command.name, escaped(command.summary));
  }
  for (const CommandHelp& command : commands) {
    const std::string begin =
        fmt::format("complete -c tethercalc -n '__fish_seen_subcommand_from {}'", command.name);
    for (const OptionHelp& option : command.options) {
      out += begin;
      for (const std::string& name : option.names) {
        out += name.size() == 2 ? " -s " + name.substr(1) : " -l " + name.substr(2);
      }
      if (!option.value.empty()) {
        const auto words = whole_words(option, commands);
        out += words.empty() ? " -r" : fmt::format(" -x -a '{}'", fmt::join(words, " "));
      }
      out += " -d " + escaped(option.help) + "\n";
    }
    if (command.arguments.empty()) continue;
    if (const auto words = words_for(command.arguments.front(), commands); !words.empty()) {
      out += fmt::format("{} -f -a '{}'\n", begin, fmt::join(words, " "));
    }
  }
  return out;
}

/// What completes the value of `option`: after the "=" of a field no space is wanted.
std::string zsh_words(const OptionHelp& option, const std::vector<std::string>& words) {
  const std::string all = fmt::format("{}", fmt::join(words, " "));
  if (!option.value.starts_with("PATH=")) return ":word:(" + all + ")";
  std::string literal;  // _arguments takes this one for a command of the shell
  for (const char c : all) literal += c == '$' ? "\\$" : std::string(1, c);
  return ":word:compadd -S \"\" - " + literal;
}

std::string zsh_completion(std::span<const CommandHelp> commands) {
  std::string cases;
  std::string list;
  const auto escaped = [](std::string_view text) {
    std::string out;
    for (const char c : quoted(text, "'\\''")) {
      if (c == '[' || c == ']' || c == ':') out += '\\';
      out += c;
    }
    return out;
  };
  for (const CommandHelp& command : commands) {
    list += fmt::format("    {}\n", quoted(command.name + ":" + command.summary, "'\\''"));
    cases += fmt::format("    {})\n      _arguments", command.name);
    for (const OptionHelp& option : command.options) {
      for (const std::string& name : option.names) {
        const std::string help = escaped(option.help);
        cases += fmt::format(" \\\n        '*{}[{}]", name, help.substr(1, help.size() - 2));
        if (!option.value.empty()) {
          const auto words = whole_words(option, commands);
          cases += words.empty() ? ":file:_files" : zsh_words(option, words);
        }
        cases += "'";
      }
    }
    const auto words = command.arguments.empty() ? std::vector<std::string>{}
                                                 : words_for(command.arguments.front(), commands);
    cases += words.empty() ? " \\\n        '*:file:_files'\n      ;;\n"
                           : fmt::format(" \\\n        '1:word:({})' '*:file:_files'\n      ;;\n",
                                         fmt::join(words, " "));
  }
  return fmt::format(
      R"(#compdef tethercalc
# Completion of tethercalc for zsh: put it as _tethercalc into a folder of $fpath
_tethercalc() {{
  local -a commands=(
{}  )
  if ((CURRENT == 2)); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  ((CURRENT--))
  case $command in
{}  esac
}}
# Loaded by the first key that asks for it, the file is the function; else it is sourced.
if [ "$funcstack[1]" = _tethercalc ]; then _tethercalc "$@"; else compdef _tethercalc tethercalc; fi
)",
      list, cases);
}

/// `text` as man(7) shows it.
std::string roff(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
  return out.starts_with('.') || out.starts_with('\'') ? "\\&" + out : out;
}

std::string roff_entry(const std::string& names, const std::string& help) {
  return fmt::format(".TP\n.B {}\n{}\n", roff(names), roff(help));
}

}  // namespace

std::string command_help(const CommandHelp& command, std::size_t columns) {
  std::string out = wrapped(command.summary + ".", columns);
  out += "\n" + wrapped("Usage: " + usage(command), columns);
  if (!command.arguments.empty()) out += "\nArguments\n";
  for (const OptionHelp& argument : command.arguments) {
    out += entry(argument.names.front(), argument.help, columns);
  }
  for (const std::string& group : groups_of(command)) {
    out += "\n" + group + "\n";
    for (const OptionHelp& option : command.options) {
      if (option.group == group) out += entry(names_of(option), option.help, columns);
    }
  }
  if (!command.examples.empty()) out += "\nExamples\n";
  for (const std::string& example : command.examples) out += "  " + example + "\n";
  return out;
}

std::string program_help(std::span<const CommandHelp> commands, std::size_t columns) {
  std::string out = wrapped("Design calculator for drones powered through a tether.", columns);
  out += "\nUsage: tethercalc COMMAND [ARGUMENTS] [OPTIONS]\n\nCommands\n";
  for (const CommandHelp& command : commands) {
    out += entry(command.name, command.summary, columns);
  }
  out += "\nOptions\n" + entry("-h, --help", "This help, or that of a command", columns) +
         entry("-V, --version", "The program's version", columns);
  out +=
      "\nExamples\n  tethercalc init --output my.json\n  tethercalc optimize my.json\n"
      "  tethercalc help optimize\n\n";
  return out + wrapped(std::string(exit_codes), columns);
}

std::string manual_page(std::span<const CommandHelp> commands) {
  std::string out =
      ".TH TETHERCALC 1\n.SH NAME\ntethercalc \\- design calculator for drones powered through a "
      "tether\n.SH SYNOPSIS\n.B tethercalc\nCOMMAND [ARGUMENTS] [OPTIONS]\n.SH COMMANDS\n";
  for (const CommandHelp& command : commands) {
    out += fmt::format(".SS {}\n{}.\n", roff(usage(command)), roff(command.summary));
    for (const OptionHelp& argument : command.arguments) {
      out += roff_entry(argument.names.front(), argument.help);
    }
    for (const std::string& group : groups_of(command)) {
      out += fmt::format(".P\n{}\n", roff(group));
      for (const OptionHelp& option : command.options) {
        if (option.group != group) continue;
        out += roff_entry(fmt::format("{}{}{}", fmt::join(option.names, ", "),
                                      option.value.empty() ? "" : " ", option.value),
                          option.help);
      }
    }
    if (!command.examples.empty()) out += ".P\nExamples\n.P\n.EX\n";
    for (const std::string& example : command.examples) out += roff(example) + "\n";
    if (!command.examples.empty()) out += ".EE\n";
  }
  return out + ".SH EXIT STATUS\n" + roff(exit_codes) + "\n";
}

std::span<const std::string_view> completed_shells() {
  static constexpr std::array<std::string_view, 3> shells{"bash", "zsh", "fish"};
  return shells;
}

std::string completion_script(std::span<const CommandHelp> commands, std::string_view shell) {
  return shell == "bash"  ? bash_completion(commands)
         : shell == "zsh" ? zsh_completion(commands)
                          : fish_completion(commands);
}

}  // namespace tethercalc::cli
