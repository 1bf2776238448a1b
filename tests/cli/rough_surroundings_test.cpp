// Files, pipes and streams that are not as one expects: what the program was asked for is done or
// refused with a reason, and nothing else is touched.
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/published.hpp"
#include "support/dataflash_writer.hpp"
#include "support/run_program.hpp"

using namespace tethercalc::test;
using Catch::Contains;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

const std::string command = shell_quoted(TETHERCALC_COMMAND);
const std::string flight_log = project_file("examples/simulated-flight.csv");

std::string motor_file() {
  return json{{"points",
               {{{"thrust_g", 300}, {"power_W", 30}},
                {{"thrust_g", 600}, {"power_W", 80}},
                {{"thrust_g", 1200}, {"power_W", 230}}}}}
      .dump();
}

}  // namespace

TEST_CASE("standard error that is closed or full changes neither the answer nor the exit code") {
  const std::string drag = command + " drag " + shell_quoted(flight_log) + " --mass-g 1500";
  const Ran told = run_shell(drag);
  REQUIRE(told.exit_code == 0);
  REQUIRE_FALSE(told.err.empty());
  for (const char* to : {" 2>&-", " 2>/dev/full"}) {
    const Ran untold = run_shell(drag + to);
    CHECK(untold.exit_code == 0);
    CHECK(untold.out == told.out);
    CHECK(run_shell(command + " optimize nowhere.json" + to).exit_code == 2);
  }
  // The file that is written does not take the place of the closed stream.
  const TemporaryFolder folder;
  const auto file = (folder.path() / "drag.txt").string();
  CHECK(run_shell(drag + " --output " + shell_quoted(file) + " 2>&-").exit_code == 0);
  CHECK(file_text(file) == told.out);
}

TEST_CASE("a closed standard output is an error with a reason") {
  const Ran closed = run_shell(command + " optimize " + shell_quoted(published) + " >&-");
  CHECK(closed.exit_code == 2);
  CHECK_THAT(closed.err, Contains("standard output: cannot be written"));
}

TEST_CASE("figures are drawn where no temporary folder can be written") {
  const TemporaryFolder folder;
  const auto file = (folder.path() / "figure.svg").string();
  // Nobody, not even root, writes into /proc.
  const Ran drawn = run_shell("TMPDIR=/proc " + command + " plot optimum " +
                              shell_quoted(published) + " --output " + shell_quoted(file));
  CHECK(drawn.exit_code == 0);
  CHECK_THAT(file_text(file), Contains("<svg "));
}

TEST_CASE("a limit on the size of files is told, and no half-written file is left") {
  const TemporaryFolder folder;
  const Ran limited = run_shell("cd " + shell_quoted(folder.path().string()) +
                                " && ulimit -f 1 && " + command + " schema --output schema.json");
  CHECK(limited.exit_code == 2);
  CHECK_THAT(limited.err, Contains("File too large"));
  CHECK(fs::is_empty(folder.path()));
}

TEST_CASE("with --output /dev/stdout, what others have written before stays") {
  const TemporaryFolder folder;
  const auto file = shell_quoted((folder.path() / "all").string());
  const std::string text = "( echo first; " + command + " init --output /dev/stdout; echo last )";
  CHECK(run_shell(text + " >" + file).exit_code == 0);
  const std::string all = file_text(folder.path() / "all");
  CHECK(all == "first\n" + run_tethercalc({"init"}).out + "last\n");

  const std::string rows = command + " sweep " + shell_quoted(published) +
                           " --vary supply.voltage_V=60:80:10 --output /dev/stdout";
  CHECK(run_shell("( echo first; " + rows + "; echo last ) >" + file).exit_code == 0);
  const std::string swept = file_text(folder.path() / "all");
  CHECK(swept.starts_with("first\nsupply.voltage_V,"));
  CHECK(swept.ends_with("last\n"));
  CHECK(std::count(swept.begin(), swept.end(), '\n') == 6);
}

TEST_CASE("what replaces a file keeps who may read it, and no right to run as its owner") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "spec.json";
  write_file(file, "{}");
  constexpr auto readable = fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read;
  fs::permissions(file, readable | fs::perms::set_uid | fs::perms::set_gid);
  CHECK(run_tethercalc({"init", "--force", "--output", file.string()}).exit_code == 0);
  CHECK(file_text(file) == run_tethercalc({"init"}).out);
  CHECK(fs::status(file).permissions() == readable);
}

TEST_CASE("a socket stays what it is when --output names it") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "s").string();
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  REQUIRE(path.size() < sizeof address.sun_path);
  path.copy(address.sun_path, path.size());
  REQUIRE(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  CHECK(run_tethercalc({"init", "--output", path}).exit_code == 2);
  CHECK(fs::is_socket(path));
  ::close(socket);
}

TEST_CASE("a reader that has enough ends the program without a word") {
  const Ran one =
      run_shell("{ ( sleep 0.3; " + command + " init ); echo \"code $?\" >&2; } | true");
  CHECK(one.err == "code 141\n");  // 128 + SIGPIPE, as of every other program
  const Ran sweep =
      run_shell("{ " + command + " sweep " + shell_quoted(published) +
                " --vary supply.voltage_V=35:80:0.01; echo \"code $?\" >&2; } | head -n 3");
  CHECK(sweep.err == "code 141\n");
  CHECK(std::count(sweep.out.begin(), sweep.out.end(), '\n') == 3);
}

TEST_CASE("a sweep of very many designs says how many before it begins") {
  const Ran run = run_shell(command + " sweep " + shell_quoted(published) +
                            " --vary tether.length_m=19:100:0.000001 | head -n 2");
  CHECK_THAT(run.err, Contains("81000001 designs to compute"));
  CHECK(std::count(run.out.begin(), run.out.end(), '\n') == 2);
}

TEST_CASE("what may not be read is refused with a reason, by check too") {
  const TemporaryFolder folder;
  const fs::path locked = folder.path() / "locked";
  fs::create_directory(locked);
  write_file(locked / "a.json", file_text(published));
  write_file(locked / "a.expected.json", "{}");
  // Root may read everything.
  const std::string somebody = ::geteuid() == 0 ? "setpriv --reuid=65534 --clear-groups " : "";
  const auto refused = [&](const fs::path& asked) {
    const Ran ran = run_shell(somebody + command + " check " + shell_quoted(asked.string()));
    INFO(ran.err);
    return ran.exit_code == 2 && ran.err.find("Permission denied") != std::string::npos;
  };
  fs::permissions(locked / "a.expected.json", fs::perms::none);
  CHECK(refused(locked / "a.json"));
  const fs::perms listed = fs::perms::owner_read | fs::perms::group_read | fs::perms::others_read;
  for (const fs::perms allowed : {listed, fs::perms::none}) {
    fs::permissions(locked, allowed);
    CHECK(refused(locked));
    CHECK(refused(locked / "a.json"));
  }
  fs::permissions(locked, fs::perms::owner_all);
}

TEST_CASE("check does not wait for a pipe among the specs") {
  const TemporaryFolder folder;
  const std::string pipe = (folder.path() / "a.json").string();
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  for (const std::string& asked : {pipe, folder.path().string()}) {
    const Ran ran = run_shell("timeout 10 " + command + " check " + shell_quoted(asked));
    CHECK(ran.exit_code == 2);
    CHECK_THAT(ran.err, Contains("a.json: is a pipe"));
  }
}

TEST_CASE("a log that is cut off while it is read ends the program with a reason") {
  // The file is long enough that reading it lasts, and shortened in the midst of that.
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "long.csv").string();
  {
    std::string text = "time_s,roll_deg,pitch_deg,yaw_deg,vn_m_s,ve_m_s,vd_m_s\n";
    for (int i = 0; i < 2'000'000; ++i) {
      text += std::to_string(0.1 * i) + ",0.5,-1.5,2.5,1.25,-0.75,0.125\n";
    }
    write_file(log, text);
  }
  // Cut off once it is mapped: how long a program takes to begin is not known.
  const std::string mapped =
      "for k in $(seq 1000); do grep -q long.csv /proc/$!/maps && break; sleep 0.01; done";
  const Ran ran = run_shell(command + " drag " + shell_quoted(log) + " --mass-g 1500 & " + mapped +
                            "; truncate -s 100 " + shell_quoted(log) + "; wait $!");
  CHECK(ran.exit_code == 2);
  CHECK_THAT(ran.err, Contains("long.csv: was shortened while it was read"));
}

TEST_CASE("an export whose log is cut off, or that is interrupted, leaves no part of a file") {
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "long.bin").string();
  {
    tethercalc::test::DataFlashWriter writer;
    writer.define(20, "TEST", "Qf", "TimeUS,Value");
    for (std::uint64_t i = 0; i < 3'000'000; ++i) writer.add(20, {1000 * i, 0.1});
    const auto& bytes = writer.bytes();
    write_file(log, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  }
  const std::string csv = (folder.path() / "test.csv").string();
  const std::string line = command + " log " + shell_quoted(log) + " --csv TEST --output " +
                           shell_quoted(csv) + " & for k in $(seq 500); do ls " +
                           shell_quoted(csv) + ".* && break; sleep 0.01; done >/dev/null 2>&1; ";
  const auto files = [&] {
    return std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator());
  };
  const Ran killed = run_shell(line + "kill -TERM $!; wait $!");
  CHECK(killed.exit_code == 128 + 15);
  CHECK(files() == 1);
  const Ran cut = run_shell(line + "truncate -s 100 " + shell_quoted(log) + "; wait $!");
  CHECK(cut.exit_code == 2);
  CHECK_THAT(cut.err, Contains("long.bin: was shortened while it was read"));
  CHECK(files() == 1);
}

TEST_CASE("an extended spec in another folder finds its motor") {
  const TemporaryFolder folder;
  const fs::path here = folder.path() / "here";
  const fs::path there = folder.path() / "there";
  fs::create_directories(here);
  fs::create_directories(there);
  write_file(here / "mine.json", motor_file());
  json spec = json::parse(file_text(published));
  spec["drone"]["motor"] = "./mine.json";
  write_file(here / "spec.json", spec.dump());
  const auto valid = [&](const fs::path& file) {
    const Ran ran = run_tethercalc({"validate", file.string()});
    INFO(ran.err);
    return ran.exit_code == 0;
  };

  const std::string from = (here / "spec.json").string();
  CHECK(run_tethercalc({"drag", flight_log, "--mass-g", "1500", "--spec", from, "--into",
                        (there / "drag.json").string()})
            .exit_code == 0);
  CHECK(valid(there / "drag.json"));
  CHECK(run_tethercalc({"diagnose", from, "--flight", flight_log, "--into",
                        (there / "diagnosed.json").string()})
            .exit_code == 0);
  CHECK(valid(there / "diagnosed.json"));
  // Beside the spec nothing has to change, and down a pipe it is read from the folder one is in.
  CHECK(run_tethercalc({"drag", flight_log, "--mass-g", "1500", "--spec", from, "--into",
                        (here / "drag.json").string()})
            .exit_code == 0);
  CHECK(json::parse(file_text(here / "drag.json"))["drone"]["motor"] == "./mine.json");
  const Ran piped =
      run_shell("cd " + shell_quoted(there.string()) + " && " + command + " drag " +
                shell_quoted(flight_log) + " --mass-g 1500 --spec ../here/spec.json --into | " +
                command + " validate -");
  CHECK(piped.exit_code == 0);
}

TEST_CASE("names of files command no terminal") {
  const TemporaryFolder folder;
  const std::string name = (folder.path() / "e\x1b[31m.json").string();
  write_file(name, file_text(published));
  const Ran valid = run_tethercalc({"validate", name});
  CHECK(valid.exit_code == 0);
  CHECK_THAT(valid.out, Contains("[31m.json: valid") && !Contains("\x1b"));
  const Ran checked = run_tethercalc({"check", name});
  CHECK(checked.exit_code == 1);
  CHECK_THAT(checked.out, Contains("[31m.json") && !Contains("\x1b"));
  const Ran missing = run_tethercalc({"validate", name + "x"});
  CHECK(missing.exit_code == 2);
  CHECK_THAT(missing.err, Contains("no such file") && !Contains("\x1b"));
}

TEST_CASE("a message about a motor's file gives nothing of another file away") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "shadow";
  write_file(file, "secret:of:somebody\n");
  const Ran ran = run_tethercalc({"optimize", published, "--set", "drone.motor=" + file.string()});
  CHECK(ran.exit_code == 2);
  CHECK_THAT(ran.err, Contains("shadow:1: column 1: this is not JSON") && !Contains("secret"));
}

TEST_CASE("any title leaves an SVG well-formed") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "figure.svg";
  CHECK(run_tethercalc(
            {"plot", "optimum", published, "--title", "a]]>b<c&d", "--output", file.string()})
            .exit_code == 0);
  const std::string svg = file_text(file);
  // XML 1.0, 2.4: these three may stand in no text.
  CHECK_THAT(svg, !Contains("]]>") && Contains("]]&gt;"));
}
