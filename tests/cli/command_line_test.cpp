// What is typed: help, completion, and how several mistakes are told at once.
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "cli/published.hpp"
#include "support/random.hpp"
#include "support/run_program.hpp"

using namespace tethercalc::test;
using Catch::Contains;
using nlohmann::json;

namespace {

const std::string command = shell_quoted(TETHERCALC_COMMAND);

/// The first words of the lines of the program's help between "Commands" and the next empty line.
std::vector<std::string> commands() {
  std::vector<std::string> names;
  std::istringstream help(run_tethercalc({"--help"}).out);
  std::string line;
  while (std::getline(help, line) && line != "Commands") {
  }
  while (std::getline(help, line) && !line.empty()) {
    if (line[2] != ' ') names.push_back(line.substr(2, line.find(' ', 2) - 2));
  }
  return names;
}

/// What bash proposes after these words, the last of which is being typed.
std::string completed(const std::vector<std::string>& words) {
  std::string typed;
  for (const std::string& word : words) typed += " " + shell_quoted(word);
  const Ran ran = run_shell(
      "bash -c 'compopt() { :; }; source <(\"$0\" completion bash); "
      "COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _tethercalc; "
      "printf \"%s\\n\" \"${COMPREPLY[@]}\"' " +
      command + typed);
  INFO(ran.err);
  CHECK(ran.err.empty());
  return "\n" + ran.out;
}

}  // namespace

TEST_CASE("names of effects and of books of rules are completed") {
  CHECK_THAT(completed({"tethercalc", "diagnose", "x.json", "--base", "linear_"}),
             Contains("\nlinear_drag\n"));
  for (const char* command : {"rules", "report"}) {
    CHECK(completed({"tethercalc", command, "x.json", "--rules", "eu"}) == "\neu-c3\n");
  }
}

TEST_CASE("every command has help, wrapped between 60 and 100 columns") {
  const auto names = commands();
  REQUIRE(names.size() >= 18);
  for (const std::string& name : names) {
    INFO(name);
    const Ran asked = run_tethercalc({"help", name});
    CHECK(asked.exit_code == 0);
    CHECK(asked.out == run_tethercalc({name, "--help"}).out);
    CHECK_THAT(asked.out, Contains("Usage: tethercalc " + name));
    for (const auto& [columns, widest] :
         std::vector<std::pair<int, std::size_t>>{{20, 60}, {72, 72}, {300, 100}}) {
      if (leave_rates_out() && columns != 20) continue;
      const Ran narrow =
          run_shell("COLUMNS=" + std::to_string(columns) + " " + command + " help " + name);
      // Examples are lines to copy, and stay whole.
      CHECK(widest_line(narrow.out.substr(0, narrow.out.find("\nExamples\n"))) <= widest);
    }
  }
  CHECK(run_tethercalc({"help"}).out == run_tethercalc({"--help"}).out);
  CHECK(run_tethercalc({"-V"}).out == run_tethercalc({"--version"}).out);
  const Ran mistyped = run_tethercalc({"help", "optimise"});
  CHECK(mistyped.exit_code == 2);
  CHECK_THAT(mistyped.err, Contains("did you mean \"optimize\"?"));
}

TEST_CASE("the manual page has every command") {
  const Ran page = run_tethercalc({"man"});
  CHECK(page.exit_code == 0);
  for (const std::string& name : commands()) {
    CHECK_THAT(page.out, Contains(".SS tethercalc " + name));
  }
  CHECK_THAT(page.out, Contains("\\-\\-set PATH=VALUE"));
}

TEST_CASE("the list of changes names every command, and README shows each that answers") {
  const std::string changes = file_text(project_file("CHANGELOG.md"));
  const std::string readme = file_text(project_file("README.md"));
  REQUIRE(commands().size() > 20);
  for (const std::string& name : commands()) {
    CHECK_THAT(changes, Contains("`" + name + "`"));
    CHECK_THAT(readme, Contains("tethercalc " + name) || Contains("`" + name));
  }
}

TEST_CASE("bash completes commands, options, fields and names of the library") {
  CHECK_THAT(completed({"tethercalc", "op"}), Contains("\noptimize\n") && !Contains("sweep"));
  CHECK_THAT(completed({"tethercalc", "sweep", "--sa"}), Contains("\n--sample\n"));
  CHECK_THAT(completed({"tethercalc", "optimize", "my.json", "--set", "supply.vol"}),
             Contains("\nsupply.voltage_V=\n"));
  CHECK_THAT(
      completed({"tethercalc", "optimize", "my.json", "--set", "tether.conductor", "=", "al"}),
      Contains("\naluminium\n"));
  CHECK_THAT(completed({"tethercalc", "compare", "my.json", "--motors", "holy"}),
             Contains("\nholybro-air2216-920kv-10in\n"));
  CHECK_THAT(completed({"tethercalc", "optimize", "my.json", "--format", ""}),
             Contains("\ntable\njson\ncsv\n"));
  CHECK_THAT(completed({"tethercalc", "list", "mo"}), Contains("\nmotors\n"));
  const Ran unknown = run_tethercalc({"completion", "bsh"});
  CHECK(unknown.exit_code == 2);
  CHECK_THAT(unknown.err, Contains("did you mean \"bash\"?"));
}

TEST_CASE("fish completes commands, options, fields and names of the library") {
  const TemporaryFolder folder;
  const auto proposed = [&](const std::string& line) {
    const Ran ran = run_shell("HOME=" + shell_quoted(folder.path().string()) + " fish -c " +
                              shell_quoted("'" + command + "' completion fish | source; " +
                                           "complete -C " + shell_quoted("tethercalc " + line)));
    INFO(ran.err);
    CHECK(ran.err.empty());
    return "\n" + ran.out;
  };
  CHECK_THAT(proposed("optimi"), Contains("\noptimize\t"));
  CHECK_THAT(proposed("optimize my.json --form"), Contains("\n--format\t"));
  CHECK_THAT(proposed("optimize my.json --set supply.vol"), Contains("\nsupply.voltage_V=\t"));
  CHECK_THAT(proposed("compare my.json --motors holy"), Contains("\nholybro-air2216-920kv-10in\t"));
  CHECK_THAT(proposed("explain propw"), Contains("\npropwash"));
}

TEST_CASE("zsh completes at the first key, and leaves no space behind a field") {
  const TemporaryFolder folder;
  write_file(folder.path() / "_tethercalc", run_tethercalc({"completion", "zsh"}).out);
  // A shell in a terminal whose editor is up (it asks for marked pastes, 2004h); what is typed
  // behind the key shows that the key was answered.
  const auto shows = [&](const std::string& typed, const std::string& shown) {
    const std::string script =
        "zmodload zsh/zpty; zpty z zsh -f -i\n"
        "zpty -w z 'fpath=(" +
        folder.path().string() +
        " $fpath); autoload -Uz compinit; compinit -u -D; print rea\\dy'\n"
        "zpty -r z out '*ready*2004h*'\n"
        "zpty -w -n z 'tethercalc " +
        typed +
        "'$'\\t''END'\n"
        "zpty -r z out '*END*'\n"
        "[[ $out == *" +
        shown + "END* ]]\n";
    return run_shell("TERM=xterm timeout 60 zsh -f -c " + shell_quoted(script)).exit_code == 0;
  };
  CHECK(shows("optimi", "optimize*"));
  CHECK(shows("compare my.json --motors holy", "holybro-air2216-920kv-10in*"));
  CHECK(shows("optimize my.json --set supply.vol", "supply.voltage_V="));
  CHECK_FALSE(shows("optimi", "nothing"));
}

TEST_CASE("all that is wrong with what was typed is told at once, and with the spec, too") {
  const Ran ran = run_tethercalc(
      {"optimize", published, "--format", "yaml", "--outptu", "x", "--set", "drone.mass_g=-3"});
  CHECK(ran.exit_code == 2);
  CHECK_THAT(ran.err, Contains("--format: \"yaml\"") && Contains("did you mean \"--output\"?") &&
                          Contains("--set drone.mass_g=-3: -3"));
  const Ran sweep =
      run_tethercalc({"sweep", published, "--vary", "supply.voltage_V=60..80", "--sample", "-1",
                      "--seed", "-1", "--jobs", "1.5", "--method", "sobol"});
  CHECK(sweep.exit_code == 2);
  CHECK_THAT(sweep.err, Contains("--sample: \"-1\" is not a whole number from 1") &&
                            Contains("--seed: \"-1\"") && Contains("--jobs: \"1.5\""));
  const Ran areas = run_tethercalc({"evaluate", published, "--area-mm2", "1,,2"});
  CHECK(areas.exit_code == 2);
  CHECK_THAT(areas.err, Contains("--area-mm2: \"1,,2\" has nothing between two commas"));
}

TEST_CASE("where nothing can be written is told before anything is computed") {
  const Ran ran = run_tethercalc({"sweep", published, "--vary", "supply.voltage_V=60..80",
                                  "--sample", "4", "--summary", "/nowhere/summary.json"});
  CHECK(ran.exit_code == 2);
  CHECK(ran.out.empty());
  CHECK_THAT(ran.err, Contains("/nowhere/summary.json: cannot be written"));
}

TEST_CASE("no command writes over what a spec or a folder has it read") {
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder.path() / name).string(); };
  const std::string table = "thrust_g,power_W\n0,0\n500,60\n1200,200\n2000,420\n";
  write_file(path("m.csv"), table);
  write_file(path("s.json"), file_text(published));
  std::filesystem::create_directory(path("ck"));
  write_file(path("ck/a.json"), file_text(published));
  REQUIRE(run_tethercalc({"check", path("ck"), "--update"}).exit_code == 0);
  const std::string record = file_text(path("ck/a.expected.json"));
  const std::string motor = "drone.motor=" + path("m.csv");
  const std::string motors = motor + ",holybro-air2216-920kv-10in";
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"optimize", path("s.json"), "--set", motor, "--output", path("m.csv")},
           {"validate", path("s.json"), "--output", path("s.json")},
           {"sweep", path("s.json"), "--vary", motors, "--output", path("m.csv")},
           {"sweep", path("s.json"), "--vary", motors, "--sample", "40", "--output",
            path("rows.csv"), "--summary", path("m.csv")},
           {"design", path("s.json"), "--free", motors, "--output", path("m.csv")},
           {"check", path("ck"), "--output", path("ck/a.json")},
           {"check", path("ck"), "--junit", path("ck/a.json")},
           {"check", path("ck"), "--update", "--junit", path("ck/a.expected.json")}}) {
    INFO(arguments[0] << " " << arguments.back());
    const Ran ran = run_tethercalc(arguments);
    CHECK(ran.exit_code == 2);
    CHECK_THAT(ran.err, Contains("is read; give another file to write"));
    CHECK(file_text(path("m.csv")) == table);
    CHECK(file_text(path("s.json")) == file_text(published));
    CHECK(file_text(path("ck/a.json")) == file_text(published));
    CHECK(file_text(path("ck/a.expected.json")) == record);
  }
  CHECK_FALSE(std::filesystem::exists(path("rows.csv")));
  CHECK_THAT(run_tethercalc({"check", path("ck"), "--junit", "-"}).err,
             Contains("--junit: \"-\" is no file"));
}

TEST_CASE("no command writes over a file that it reads, nor two answers into one file") {
  const TemporaryFolder folder;
  const std::string spec = (folder.path() / "spec.json").string();
  const std::string text = file_text(published);
  write_file(spec, text);
  const std::string link = (folder.path() / "link.json").string();
  std::filesystem::create_symlink(spec, link);
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"optimize", spec, "--output", spec},
           {"optimize", spec, "-o", link},
           {"sweep", spec, "--vary", "supply.voltage_V=60:80:10", "--output", spec},
           {"drag", project_file("examples/simulated-flight.csv"), "--mass-g", "1500", "--spec",
            spec, "--into", spec}}) {
    const Ran ran = run_tethercalc(arguments);
    CHECK(ran.exit_code == 2);
    CHECK_THAT(ran.err, Contains("is read; give another file"));
    CHECK(file_text(spec) == text);
  }
  const std::string both = (folder.path() / "both").string();
  const Ran two = run_tethercalc({"sweep", spec, "--vary", "supply.voltage_V=60..80", "--sample",
                                  "4", "--summary", both, "--output", both});
  CHECK(two.exit_code == 2);
  CHECK_FALSE(std::filesystem::exists(both));
}

TEST_CASE("init writes over an edited spec only where it is told to") {
  const TemporaryFolder folder;
  const std::string spec = (folder.path() / "my.json").string();
  CHECK(run_tethercalc({"init", "--output", spec}).exit_code == 0);
  CHECK(run_tethercalc({"init", "--output", spec}).exit_code == 0);  // nothing is lost
  write_file(spec, file_text(spec) + "\n");
  const std::string edited = file_text(spec);
  const Ran refused = run_tethercalc({"init", "--output", spec});
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.err, Contains("--force"));
  CHECK(file_text(spec) == edited);
  CHECK(run_tethercalc({"init", "--output", spec, "--force"}).exit_code == 0);
  CHECK(file_text(spec) != edited);
}

TEST_CASE("standard output is what --output - names") {
  CHECK(run_tethercalc({"optimize", published, "--output", "-"}).out ==
        run_tethercalc({"optimize", published}).out);
}

TEST_CASE("a cross-section may be typed as a standard size") {
  // ASTM B258: AWG 18 has a diameter of 0.127 mm * 92^(18/39), 0.8230 mm2.
  for (const char* name : {"AWG18", "awg 18", "AWG 18"}) {
    const Ran ran = run_tethercalc({"evaluate", published, "--area-mm2", name, "--format", "json"});
    REQUIRE(ran.exit_code == 0);
    const json table = json::parse(ran.out).at("table");
    CHECK(table.at(0).at("hover").at("cross_section_mm2").get<double>() ==
          Approx(0.8230).epsilon(1e-3));
  }
}

TEST_CASE("what --color and --quiet say is done, terminal or not") {
  const Ran plain = run_tethercalc({"optimize", published});
  CHECK_THAT(plain.out, !Contains("\x1b"));
  CHECK_THAT(run_tethercalc({"optimize", published, "--color", "always"}).out, Contains("\x1b["));
  CHECK(run_tethercalc({"optimize", published, "--color", "never"}).out == plain.out);
  const std::vector<std::string> drag{"drag", project_file("examples/simulated-flight.csv"),
                                      "--mass-g", "1500"};
  std::vector<std::string> quietly = drag;
  quietly.emplace_back("--quiet");
  CHECK_FALSE(run_tethercalc(drag).err.empty());
  CHECK(run_tethercalc(quietly).err.empty());
  CHECK(run_tethercalc(quietly).out == run_tethercalc(drag).out);
  CHECK_FALSE(run_tethercalc({"optimize", "nowhere.json", "--quiet"}).err.empty());
}
