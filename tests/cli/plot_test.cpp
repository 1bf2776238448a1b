// Figures through the real program.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "cli/published.hpp"
#include "support/figures.hpp"
#include "support/random.hpp"
#include "support/reference_data.hpp"
#include "support/run_program.hpp"

using namespace tethercalc::test;
using Catch::Contains;
using Catch::StartsWith;

namespace {

const std::string flight = project_file("examples/simulated-flight.csv");

/// A folder with a sweep's rows, and every kind of figure with what it is drawn from.
class Kinds {
 public:
  Kinds() {
    const std::string rows = (folder_.path() / "rows.csv").string();
    REQUIRE(run_tethercalc({"sweep", published, "--vary", "supply.voltage_V=60:100:20", "--vary",
                            "tether.length_m=10:30:10", "--output", rows})
                .exit_code == 0);
    arguments_ = {{"optimum", {published}},
                  {"motors", {published}},
                  {"shape",
                   {published, "--area-mm2", "1.0886", "--slack", "2,10", "--wind", "5,10",
                    "--wind-from", "60"}},
                  {"log", {flight}},
                  {"drag", {flight}},
                  {"diagnosis", {published, "--flight", flight, "--base", "linear_drag,wind"}},
                  {"sweep", {rows}}};
    for (const char* kind : {"log", "drag", "diagnosis"}) {
      arguments_[kind].insert(arguments_[kind].end(), known.begin(), known.end());
    }
  }

  [[nodiscard]] const auto& all() const { return arguments_; }
  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_.path() / name).string();
  }

  [[nodiscard]] std::vector<std::string> command(const std::string& kind,
                                                 const std::string& output = "") const {
    std::vector<std::string> line{"plot", kind};
    const auto& own = arguments_.at(kind);
    line.insert(line.end(), own.begin(), own.end());
    if (!output.empty()) line.insert(line.end(), {"--output", output});
    return line;
  }

 private:
  TemporaryFolder folder_;
  std::map<std::string, std::vector<std::string>> arguments_;
};

bool is_xml(const std::string& file) {
  return run_shell("python3 -c 'import sys, xml.dom.minidom as m; m.parse(sys.argv[1])' " +
                   shell_quoted(file))
             .exit_code == 0;
}

bool is_drawn_by_gnuplot(const std::string& suffix) { return suffix == ".png" || suffix == ".pdf"; }

}  // namespace

TEST_CASE("every kind is drawn in every format") {
  const Kinds kinds;
  for (const auto& [kind, arguments] : kinds.all()) {
    INFO(kind);
    // What draws a kind is the same for all formats, and formats are written alike for all kinds.
    const bool every_format = !tethercalc::test::leave_rates_out() || kind == "optimum";
    for (const std::string suffix : {".svg", ".txt", ".png", ".pdf", ".gp"}) {
      if (!every_format && suffix == ".png") break;
      if (is_drawn_by_gnuplot(suffix) && !gnuplot_is_there()) continue;
      INFO(suffix);
      const Ran run = run_tethercalc(kinds.command(kind, kinds.file(kind + suffix)));
      INFO(run.err);
      CHECK(run.exit_code == 0);
      CHECK(run.out.empty());
      CHECK(run.err.empty());
    }
    CHECK(is_xml(kinds.file(kind + ".svg")));
    CHECK(layout_problems(file_text(kinds.file(kind + ".svg"))) == std::vector<std::string>{});

    const std::string text = file_text(kinds.file(kind + ".txt"));
    CHECK(text.find('\x1b') == std::string::npos);
    CHECK(widest_line(text) <= 100);
    CHECK(run_tethercalc(kinds.command(kind)).out == text);

    if (!every_format || !gnuplot_is_there()) continue;
    const std::string png = file_text(kinds.file(kind + ".png"));
    CHECK_THAT(png, StartsWith("\x89PNG\r\n\x1a\n"));
    CHECK(png.substr(png.size() - 8, 4) == "IEND");
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(png[i]); };
    CHECK(byte(18) * 256 + byte(19) == 1004);  // 85 mm at 300 dots per inch

    const std::string pdf = file_text(kinds.file(kind + ".pdf"));
    CHECK_THAT(pdf, StartsWith("%PDF-"));
    CHECK(pdf.find("%%EOF") != std::string::npos);

    // The script is whole: alone in another folder it draws the same figure.
    const TemporaryFolder elsewhere;
    const Ran drawn = run_shell("cd " + shell_quoted(elsewhere.path().string()) +
                                " && LC_ALL=C.UTF-8 gnuplot -d " +
                                shell_quoted(kinds.file(kind + ".gp")) + " > figure.pdf");
    INFO(drawn.err);
    CHECK(drawn.exit_code == 0);
    CHECK(drawn.err.empty());
    CHECK_THAT(file_text(elsewhere.path() / "figure.pdf"), StartsWith("%PDF-"));
  }
}

TEST_CASE("drag has a second view, over airspeed and tilt") {
  const Kinds kinds;
  std::vector<std::string> line = kinds.command("drag", kinds.file("surface.svg"));
  line.insert(line.end(), {"--view", "surface"});
  CHECK(run_tethercalc(line).exit_code == 0);
  CHECK_THAT(file_text(kinds.file("surface.svg")), Contains("tilt (deg)"));
  line.back() = "surfaces";
  const Ran wrong = run_tethercalc(line);
  CHECK(wrong.exit_code == 2);
  CHECK_THAT(wrong.err, Contains("--view") && Contains("did you mean \"surface\"?"));
}

TEST_CASE("the figure of a power log's diagnosis is drawn") {
  const auto log = reference_file("data/practice/power-23.csv");
  const auto spec = reference_file("data/practice/x500-tethered.spec.json");
  if (!log || !spec) return;
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "a.svg").string();
  const Ran run = run_tethercalc(
      {"plot", "diagnosis", spec->string(), "--power", log->string(), "--output", file});
  INFO(run.err);
  CHECK(run.exit_code == 0);
  CHECK_THAT(file_text(file), Contains("converter efficiency curve"));
  CHECK(layout_problems(file_text(file)) == std::vector<std::string>{});
}

TEST_CASE("a figure has the width asked for, on paper and on a terminal") {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "a.svg").string();
  CHECK(run_tethercalc({"plot", "optimum", published, "--width-mm", "170", "--output", file})
            .exit_code == 0);
  CHECK_THAT(file_text(file), Contains("width=\"643\""));
  for (const char* width : {"84", "401", "nan", "-85"}) {
    const Ran run =
        run_tethercalc({"plot", "optimum", published, "--width-mm", width, "--output", file});
    CHECK(run.exit_code == 2);
    CHECK_THAT(run.err, Contains("--width-mm"));
  }
  const Ran narrow = run_shell("COLUMNS=60 " + shell_quoted(TETHERCALC_COMMAND) + " plot optimum " +
                               shell_quoted(published));
  CHECK(narrow.exit_code == 0);
  CHECK(widest_line(narrow.out) <= 60);
}

TEST_CASE("an unknown kind, suffix or motor is refused with the nearest known") {
  const TemporaryFolder folder;
  const Ran kind = run_tethercalc({"plot", "optimun", published});
  CHECK(kind.exit_code == 2);
  CHECK(kind.out.empty());
  CHECK_THAT(kind.err, Contains("\"optimun\"") && Contains("did you mean \"optimum\"?"));
  for (const char* name : {"optimum", "motors", "log", "drag", "diagnosis", "sweep"}) {
    CHECK_THAT(kind.err, Contains(name));
  }
  const std::string file = (folder.path() / "a.jpg").string();
  const Ran suffix = run_tethercalc({"plot", "optimum", published, "--output", file});
  CHECK(suffix.exit_code == 2);
  CHECK_THAT(suffix.err, Contains("--output") && Contains(".svg, .png, .pdf"));
  CHECK_FALSE(std::filesystem::exists(file));
  const Ran motor = run_tethercalc({"plot", "motors", published, "--motors", "holybro-air2216"});
  CHECK(motor.exit_code == 2);
  CHECK_THAT(motor.err, Contains("holybro-air2216-920kv-10in"));
  CHECK(run_tethercalc({"plot", "optimum", published, published}).exit_code == 2);
  CHECK(run_tethercalc({"plot", "diagnosis", published}).exit_code == 2);
}

TEST_CASE("a heat map of characters has digits and says what they mean") {
  const std::string csv =
      "supply.voltage_V,tether.length_m,status,forward.total_power_W\n"
      "40,10,optimal,300\n40,20,optimal,400\n50,10,optimal,355\n"
      "50,20,infeasible,\n";
  const Ran run = run_tethercalc({"plot", "sweep", "-"}, csv);
  INFO(run.err);
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.out, Contains("0 begins at 300.0, 9 ends at 400.0"));
  const auto count = [&](char digit) {  // within the frame
    int found = 0;
    std::istringstream lines(run.out);
    for (std::string line; std::getline(lines, line);) {
      const std::size_t left = line.find_first_of("|+");
      if (left > 7 || line.find("---") != std::string::npos) continue;
      found += int(std::count(line.begin() + std::ptrdiff_t(left), line.end(), digit));
    }
    return found;
  };
  // A quarter of the frame each, but for the letter of the least.
  CHECK(count('L') == 1);
  CHECK(count('9') > 300);
  for (const char other : {'0', '5', '.'}) CHECK(std::abs(count(other) - count('9')) <= 60);
  CHECK(count('3') == 0);
}

TEST_CASE("a quantity that is 0 everywhere has an axis of plain numbers") {
  const Ran run = run_tethercalc({"plot", "sweep", "-", "--value", "hover.pitch_deg"},
                                 "supply.voltage_V,status,hover.pitch_deg,reason\n"
                                 "60,optimal,0,\n70,optimal,0,\n80,optimal,0,\n");
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.out, Contains("0.02 +") && !Contains("e-"));
}

TEST_CASE("options of other figures are refused, all at once") {
  const Ran run = run_tethercalc({"plot", "optimum", published, "--x", "supply.voltage_V",
                                  "--mass-g", "1", "--view", "speed"});
  CHECK(run.exit_code == 2);
  for (const char* words : {"--x: is an option of the figures sweep, not of optimum",
                            "--mass-g: is an option of", "--view: is an option of"}) {
    CHECK_THAT(run.err, Contains(words));
  }
}

TEST_CASE("a heading can be given") {
  const Ran run =
      run_tethercalc({"plot", "optimum", published, "--title", "Ours", "--output", "/dev/stdout"});
  CHECK(run.exit_code == 2);  // no suffix, no format
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "a.gp").string();
  CHECK(run_tethercalc({"plot", "optimum", published, "--title", "It's ours", "--output", file})
            .exit_code == 0);
  CHECK_THAT(file_text(file), Contains("'It'.\"'\".'s ours'"));
  CHECK(file_text(file).find("Holybro X500") == std::string::npos);
}

TEST_CASE("a log that is too short to judge has no diagnosis to draw, and says so") {
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "short.csv").string();
  const std::string whole = file_text(flight);
  std::size_t end = 0;
  for (int line = 0; line < 900; ++line) end = whole.find('\n', end) + 1;
  write_file(log, whole.substr(0, end));
  const Ran run =
      run_tethercalc({"plot", "diagnosis", published, "--flight", log, "--mass-g", "1550"});
  CHECK(run.exit_code == 2);
  CHECK(run.out.empty());
  CHECK_THAT(run.err, Contains("short.csv") && Contains("short"));
}

TEST_CASE("what is wrong with a sweep's file is told with its lines") {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "rows.csv").string();
  write_file(file, "supply.voltage_V,status,forward.total_power_W\n40,optimal,1\nx,optimal,2\n");
  const Ran run = run_tethercalc({"plot", "sweep", file});
  CHECK(run.exit_code == 2);
  CHECK_THAT(run.err, Contains("rows.csv:3") && Contains("\"x\" is no number"));
}

TEST_CASE("without gnuplot all but PDF and PNG are drawn, and the message for those says so") {
  const Kinds kinds;
  for (const auto& [kind, arguments] : kinds.all()) {
    // All kinds go the same way, and the code that draws each has been through a sanitizer above.
    if (tethercalc::test::stride() > 1 && kind != "optimum") continue;
    INFO(kind);
    for (const char* suffix : {".svg", ".txt", ".gp", ".pdf", ".png"}) {
      const bool by_gnuplot = is_drawn_by_gnuplot(suffix);
      const std::string file = kinds.file(kind + "-alone" + suffix);
      std::string command = "PATH=/nonexistent " + shell_quoted(TETHERCALC_COMMAND);
      for (const std::string& word : kinds.command(kind, file)) command += " " + shell_quoted(word);
      const Ran run = run_shell(command);
      INFO(suffix << run.err);
      CHECK(run.exit_code == (by_gnuplot ? 2 : 0));
      CHECK(run.out.empty());
      CHECK(std::filesystem::exists(file) == !by_gnuplot);
      if (!by_gnuplot) continue;
      CHECK_THAT(run.err, Contains("gnuplot-nox") && Contains(".svg"));
    }
  }
  CHECK_THAT(file_text(kinds.file("optimum-alone.gp")), Contains("$panel1_3 << EOD"));
}

TEST_CASE("the optimum stands out among the characters") {
  const Ran run = run_tethercalc({"plot", "optimum", published});
  CHECK(run.exit_code == 0);
  std::istringstream lines(run.out);
  int in_frames = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t edge = line.find_first_of("|+");
    if (edge != std::string::npos && edge < 8) {
      in_frames += int(std::count(line.begin() + std::ptrdiff_t(edge), line.end(), 'O'));
    }
  }
  CHECK(in_frames == 2);  // in thrust and in power
  CHECK_THAT(run.out, Contains("O   optimum, 1.09 mm²") && Contains("L   least power, 0.980 mm²"));
  CHECK_THAT(run.out, Contains("| 1.09 mm²"));
}

TEST_CASE("a figure is written whole or not at all") {
  if (!gnuplot_is_there()) return;
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "a.pdf").string();
  write_file(file, "what was here");
  // A gnuplot that breaks down halfway.
  write_file(folder.path() / "gnuplot", "#!/bin/sh\necho '%PDF-'\necho 'no memory' >&2\nexit 1\n");
  std::filesystem::permissions(folder.path() / "gnuplot", std::filesystem::perms::all);
  const Ran broken = run_shell("PATH=" + shell_quoted(folder.path().string()) + ":$PATH " +
                               shell_quoted(TETHERCALC_COMMAND) + " plot optimum " +
                               shell_quoted(published) + " --output " + shell_quoted(file));
  CHECK(broken.exit_code == 3);
  CHECK_THAT(broken.err, Contains("gnuplot failed: no memory"));
  CHECK(file_text(file) == "what was here");
  CHECK(run_tethercalc({"plot", "optimum", published, "--output", file}).exit_code == 0);
  CHECK_THAT(file_text(file), StartsWith("%PDF-"));
  const auto files = std::distance(std::filesystem::directory_iterator(folder.path()), {});
  CHECK(files == 2);

  const Ran nowhere = run_tethercalc(
      {"plot", "optimum", published, "--output", (folder.path() / "no" / "a.svg").string()});
  CHECK(nowhere.exit_code == 2);
  CHECK_THAT(nowhere.err, Contains("a.svg") && Contains("cannot be written"));
}

TEST_CASE("a figure of a design that cannot fly says so and ends with exit code 1") {
  const std::vector<std::string> weak{"plot", "optimum", published, "--set", "supply.voltage_V=21"};
  const Ran drawn = run_tethercalc(weak);
  CHECK(drawn.exit_code == 1);
  CHECK_THAT(drawn.out, Contains("Cannot fly as required: Holybro"));
  const Ran good = run_tethercalc({"plot", "optimum", published});
  CHECK(good.exit_code == 0);
  CHECK_THAT(good.out, !Contains("Cannot fly"));
}

TEST_CASE("hostile names do no harm in picture, script or file name") {
  if (!gnuplot_is_there()) return;
  const TemporaryFolder folder;
  const std::string breach = (folder.path() / "breach").string();
  const std::vector<std::string> names{
      "<script>alert(1)</script>", "\"'; system('touch " + breach + "'); '\"",
      "`touch " + breach + "`",    "@x %d {/Symbol a}_b^c~d&e\\n",
      "two\nlines\n\tand a tab",   std::string(300, 'x'),
  };
  for (std::size_t i = 0; i < names.size(); ++i) {
    INFO(names[i]);
    auto spec = nlohmann::json::parse(file_text(published));
    spec["name"] = names[i];
    const std::string spec_file = (folder.path() / (std::to_string(i) + ".json")).string();
    write_file(spec_file, spec.dump());
    const std::string stem = (folder.path() / std::to_string(i)).string();
    for (const char* suffix : {".svg", ".gp"}) {
      const Ran run = run_tethercalc({"plot", "optimum", spec_file, "--output", stem + suffix});
      INFO(run.err);
      CHECK(run.exit_code == 0);
    }
    CHECK(is_xml(stem + ".svg"));
    CHECK(file_text(stem + ".svg").find("<script") == std::string::npos);
    CHECK(layout_problems(file_text(stem + ".svg")).empty());
    const Ran drawn = run_shell("gnuplot -d " + shell_quoted(stem + ".gp"));
    CHECK(drawn.exit_code == 0);
    CHECK_THAT(drawn.out, StartsWith("%PDF-"));
    CHECK_FALSE(std::filesystem::exists(breach));
  }
  for (const std::string name :
       {"it's \"here\" `touch x` $(touch x) <script>.svg", "%d @x ü.svg"}) {
    const std::string file = (folder.path() / name).string();
    CHECK(run_tethercalc({"plot", "optimum", published, "--output", file}).exit_code == 0);
    CHECK(is_xml(file));
  }
  const Ran long_name =
      run_tethercalc({"plot", "optimum", published, "--output",
                      (folder.path() / (std::string(300, 'n') + ".svg")).string()});
  CHECK(long_name.exit_code == 2);
  CHECK_THAT(long_name.err, Contains("cannot be written"));

  // A log is told by its file's name.
  const std::string log = (folder.path() / "<b>'; system('touch y'); `touch z` %s.csv").string();
  std::filesystem::copy_file(flight, log);
  const std::string svg = (folder.path() / "log.svg").string();
  CHECK(run_tethercalc({"plot", "log", log, "--output", svg}).exit_code == 0);
  CHECK(is_xml(svg));
  CHECK_THAT(file_text(svg), Contains("&lt;b&gt;"));
}
