#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/published.hpp"
#include "support/random.hpp"
#include "support/run_program.hpp"

using namespace tethercalc::test;
using Catch::Contains;
using nlohmann::json;

namespace {

/// A sweep with feasible and infeasible rows, numbers and names.
std::vector<std::string> mixed_sweep(std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{"sweep",  published,
                                     "--vary", "supply.voltage_V=35:80:0.5",
                                     "--vary", "tether.conductor=aluminium,copper",
                                     "--vary", "tether.length_m=10:60:10"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::string shell_line(const std::vector<std::string>& arguments) {
  std::string line = shell_quoted(TETHERCALC_COMMAND);
  for (const std::string& argument : arguments) line += " " + shell_quoted(argument);
  return line;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Cells of a CSV line without quotes.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells{""};
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

std::vector<json> rows_of(const std::string& json_lines) {
  std::vector<json> rows;
  for (const std::string& line : lines_of(json_lines)) rows.push_back(json::parse(line));
  return rows;
}

}  // namespace

TEST_CASE("a row of a sweep is what optimize says of that design") {
  const auto rows = rows_of(run_tethercalc(mixed_sweep({"--format", "jsonl"})).out);
  REQUIRE(rows.size() == 91 * 2 * 6);
  each_random(8, [&](Random& random) {
    const json& row =
        rows[static_cast<std::size_t>(random.integer(0, static_cast<int>(rows.size()) - 1))];
    std::vector<std::string> arguments{"optimize", published, "--format", "json"};
    for (const char* path : {"supply.voltage_V", "tether.conductor", "tether.length_m"}) {
      arguments.insert(arguments.end(), {"--set", std::string(path) + "=" + row[path].dump()});
    }
    const json answer = json::parse(run_tethercalc(arguments).out);
    INFO(row.dump());
    CHECK(row["status"] == answer["status"]);
    const json& optimum = answer["optimum"];
    CHECK(row["limited_by"] == optimum["limited_by"]);
    CHECK(row["cross_section_mm2"] == optimum["cross_section_mm2"]);
    for (const char* condition : {"hover", "forward"}) {
      if (optimum[condition].is_null()) {
        CHECK(row[std::string(condition) + ".headroom"].is_null());
        CHECK(row["reason"].is_string());
        continue;
      }
      CHECK(row["reason"].is_null());
      for (const auto& [key, value] : optimum[condition].items()) {
        CHECK(row[condition + ("." + key)] == value);
      }
    }
  });
}

TEST_CASE("CSV and JSON Lines hold the same rows") {
  const auto csv = lines_of(run_tethercalc(mixed_sweep()).out);
  const auto rows = rows_of(run_tethercalc(mixed_sweep({"--format", "jsonl"})).out);
  REQUIRE(csv.size() == rows.size() + 1);
  const auto columns = cells_of(csv[0]);
  CHECK(columns[0] == "supply.voltage_V");
  CHECK(columns[3] == "status");
  for (std::size_t i = 0; i < rows.size(); i += 37) {
    const auto cells = cells_of(csv[i + 1]);
    REQUIRE(cells.size() == columns.size());
    REQUIRE(rows[i].size() == columns.size());
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const json& value = rows[i][columns[c]];
      if (value.is_null()) CHECK(cells[c].empty());
      if (value.is_string()) CHECK(cells[c] == value.get<std::string>());
      if (value.is_number()) CHECK(std::stod(cells[c]) == value.get<double>());
    }
  }
}

TEST_CASE("the output is the same for any number of threads and shards") {
  for (const char* format : {"csv", "jsonl"}) {
    for (const bool sampled : {false, true}) {
      if (leave_rates_out() && sampled != (format == std::string("csv"))) continue;
      std::vector<std::string> arguments = mixed_sweep({"--format", format});
      if (sampled) arguments.insert(arguments.end(), {"--sample", "700", "--seed", "5"});
      const auto run = [&](std::vector<std::string> more) {
        more.insert(more.begin(), arguments.begin(), arguments.end());
        const Ran ran = run_tethercalc(more);
        CHECK(ran.exit_code == 0);
        return ran.out;
      };
      const std::string whole = run({"--jobs", "1"});
      CHECK(whole.size() > 100000);
      CHECK(run({"--jobs", "2"}) == whole);
      CHECK(run({"--jobs", "7"}) == whole);
      for (const int parts : {1, 2, 3, 13}) {
        std::string joined;
        for (int part = 1; part <= parts; ++part) {
          joined += run({"--shard", std::to_string(part) + "/" + std::to_string(parts)});
        }
        CHECK(joined == whole);
      }
    }
  }
}

TEST_CASE("every feasible row has every number") {
  // Random designs close to every limit.
  const Ran run = run_tethercalc({"sweep",    published,
                                  "--sample", "20000",
                                  "--seed",   std::to_string(run_seed()),
                                  "--format", "jsonl",
                                  "--vary",   "supply.voltage_V=20..120",
                                  "--vary",   "drone.mass_g=1000..2000",
                                  "--vary",   "tether.length_m=10..80",
                                  "--vary",   "requirements.thrust_headroom=1..3",
                                  "--vary",   "flight.airspeed_m_s=2..16",
                                  "--vary",   "requirements.max_pitch_deg=10..45",
                                  "--vary",   "requirements.buffer_battery=true,false",
                                  "--vary",   "requirements.headroom_at=hover,forward",
                                  "--vary",   "flight.headwind_m_s=-5..5",
                                  "--vary",   "drone.motor=all"});
  REQUIRE(run.exit_code == 0);
  INFO("--seed " << run_seed());
  std::size_t feasible = 0;
  for (const std::string& row : lines_of(run.out)) {
    if (row.find("\"status\":\"optimal\"") == std::string::npos) continue;
    ++feasible;
    const std::string null = "\":null";
    for (std::size_t end = row.find(null); end != std::string::npos;
         end = row.find(null, end + 1)) {
      const std::size_t quote = row.rfind('"', end - 1);
      const std::string column = row.substr(quote + 1, end - quote - 1);
      // Neither of these is estimated.
      const bool may_lack =
          column == "reason" || column.ends_with("_percent") || column.ends_with("_factor");
      if (!may_lack) FAIL_CHECK(column << " missing in " << row);
    }
  }
  CHECK(feasible > 1000);
}

TEST_CASE("a sweep over cross-sections evaluates the given cables") {
  const auto rows = rows_of(run_tethercalc({"sweep", published, "--format", "jsonl", "--vary",
                                            "tether.cross_section_mm2=0.5,1.2"})
                                .out);
  const json table = json::parse(
      run_tethercalc({"evaluate", published, "--format", "json", "--area-mm2", "0.5,1.2"})
          .out)["table"];
  REQUIRE(rows.size() == 2);
  CHECK(rows[0]["status"] == "infeasible");
  CHECK(rows[0]["limited_by"] == "available_power");
  CHECK_THAT(rows[0]["reason"].get<std::string>(), Contains("headroom 1.2"));
  CHECK(rows[1]["status"] == "feasible");
  CHECK(rows[1]["limited_by"].is_null());
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(rows[i]["hover.headroom"] == table[i]["hover"]["headroom"]);
    CHECK(rows[i]["forward.total_power_W"] == table[i]["forward"]["total_power_W"]);
  }
}

TEST_CASE("bad sweeps are told all at once, before anything is written") {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "rows.csv").string();
  const Ran run =
      run_tethercalc({"sweep", published, "--output", file, "--vary", "drone.mass_g=-100:100:50",
                      "--vary", "suply.voltage_V=1,2", "--vary", "tether.conductor=aluminum",
                      "--vary", "tether.length_m=1..2", "--vary", "drone.motor_count=4,4.5",
                      "--vary", "name=a,b", "--vary", "flight.airspeed_m_s=9:1:1"});
  CHECK(run.exit_code == 2);
  CHECK(run.out.empty());
  CHECK_FALSE(std::filesystem::exists(file));
  for (const char* expected :
       {"-100 is not allowed: it must be at least 1", "did you mean \"supply.voltage_V\"?",
        "did you mean \"aluminium\"?", "add --sample N", "4.5 is not allowed",
        "does not change the result", "steps of 1 do not lead from 9 to 1"}) {
    CHECK_THAT(run.err, Contains(expected));
  }
  // Fields that do not go together, deep in the product, and in a draw.
  for (const auto& more : std::vector<std::vector<std::string>>{
           {"--vary", "tether.length_m=10:60:0.001", "--vary", "supply.voltage_V=60:19:-0.5"},
           {"--vary", "supply.voltage_V=100:19:-0.0000001"},
           {"--vary", "supply.voltage_V=75~10", "--sample", "1000000"}}) {
    std::vector<std::string> arguments{
        "sweep", published, "--output", file, "--set", "supply.converter.min_input_voltage_V=50"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ran conflict = run_tethercalc(arguments);
    CHECK(conflict.exit_code == 2);
    CHECK_THAT(conflict.err, Contains("the converter cuts off below 50 V"));
    CHECK_FALSE(std::filesystem::exists(file));
  }
}

TEST_CASE("a field that is set and varied is told to be varied") {
  const Ran run = run_tethercalc(
      {"sweep", published, "--set", "supply.voltage_V=60", "--vary", "supply.voltage_V=75,80"});
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.err, Contains("--set supply.voltage_V=60 is not used: --vary gives"));
  CHECK(run.out == run_tethercalc({"sweep", published, "--vary", "supply.voltage_V=75,80"}).out);
}

TEST_CASE("options that do not go together are refused") {
  const auto refused = [](std::vector<std::string> more, const char* reason) {
    const Ran run = run_tethercalc(mixed_sweep(std::move(more)));
    CHECK(run.exit_code == 2);
    CHECK(run.out.empty());
    CHECK_THAT(run.err, Contains(reason));
  };
  refused({"--resume"}, "needs --output");
  refused({"--shard", "3/2"}, "i from 1 to n");
  refused({"--shard", "2"}, "i from 1 to n");
  refused({"--format", "xml"}, "csv and jsonl");
  for (const char* count : {"0", "-1", "-300", "99999999999999999999999"}) {
    refused({"--sample", count}, "from 1 to 1000000000000");
  }
  refused({"--method", "lhs"}, "needs --sample");
  refused({"--seed", "3"}, "needs --sample");
  refused({"--jobs", "100000"}, "from 1 to 1024");
  refused({"--sample", "9", "--method", "grid"}, "sobol and lhs");
  refused({"--summary", "s.json"}, "needs --sample");
  refused({"--vary", "tether.length_m=1,2"}, "varied twice");
  CHECK_THAT(run_tethercalc({"sweep", published}).err, Contains("nothing varies"));
}

TEST_CASE("a broken-off sweep is completed without repeating a row") {
  const TemporaryFolder folder;
  const std::string whole = run_tethercalc(mixed_sweep()).out;
  const auto file = folder.path() / "rows.csv";
  const auto resumed = [&] {
    return run_tethercalc(mixed_sweep({"--output", file.string(), "--resume"}));
  };
  CHECK(resumed().exit_code == 0);  // nothing there yet
  CHECK(file_text(file) == whole);
  each_random(12, [&](Random& random) {
    const auto size =
        static_cast<std::size_t>(random.uniform(0, static_cast<double>(whole.size())));
    write_file(file, whole.substr(0, size));
    INFO("cut after " << size << " bytes");
    CHECK(resumed().exit_code == 0);
    CHECK(file_text(file) == whole);
  });
  CHECK(resumed().exit_code == 0);  // complete already
  CHECK(file_text(file) == whole);
}

TEST_CASE("rows that share solved cables are continued, sharded and threaded to the same bytes") {
  const TemporaryFolder folder;
  const auto sweep = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{"sweep",  published,
                                       "--set",  "tether.model=solved",
                                       "--vary", "tether.slack_percent=2:3:0.002"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tethercalc(arguments);
  };
  const std::string whole = sweep({"--jobs", "2"}).out;
  CHECK(std::count(whole.begin(), whole.end(), '\n') == 502);
  CHECK(sweep({"--shard", "1/3"}).out + sweep({"--shard", "2/3"}).out +
            sweep({"--shard", "3/3"}).out ==
        whole);
  const auto file = folder.path() / "rows.csv";
  write_file(file, whole.substr(0, whole.size() * 2 / 3));
  const Ran run = sweep({"--output", file.string(), "--resume"});
  INFO(run.err);
  CHECK(run.exit_code == 0);
  CHECK(file_text(file) == whole);
}

TEST_CASE("what another sweep wrote is not continued") {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "rows.csv").string();
  const std::string whole = run_tethercalc(mixed_sweep()).out;
  const auto refused = [&](const std::string& content, std::vector<std::string> more) {
    write_file(file, content);
    more.insert(more.end(), {"--output", file, "--resume"});
    const Ran run = run_tethercalc(mixed_sweep(std::move(more)));
    CHECK(run.exit_code == 2);
    CHECK(file_text(file) == content);
    return run.err;
  };
  const std::string part = whole.substr(0, whole.find('\n', whole.size() / 2) + 1);
  CHECK_THAT(refused(part, {"--set", "drone.mass_g=1711"}), Contains("does not belong"));
  CHECK_THAT(refused(part, {"--vary", "flight.airspeed_m_s=1,2"}), Contains("does not belong"));
  CHECK_THAT(refused(part, {"--format", "jsonl"}), Contains("does not belong"));
  CHECK_THAT(refused(whole + whole, {}), Contains("more than"));
  CHECK_THAT(refused("precious notes\n", {}), Contains("precious notes"));
  CHECK_THAT(refused("precious notes", {}), Contains("precious notes"));
  CHECK_THAT(refused(part + "precious notes", {}), Contains("precious notes"));
}

TEST_CASE("a full disk ends a sweep with an error") {
  const Ran full = run_shell(shell_line(mixed_sweep()) + " >/dev/full");
  CHECK(full.exit_code == 2);
  CHECK_THAT(full.err, Contains("standard output") && Contains("No space left on device"));

  const Ran named = run_tethercalc(mixed_sweep({"--output", "/dev/full"}));
  CHECK(named.exit_code == 2);
  CHECK_THAT(named.err, Contains("/dev/full") && Contains("No space left on device"));
}

TEST_CASE("a disk that fills up keeps whole rows, and the sweep goes on later") {
  // The largest file the shell allows stands for the disk's end.
  const TemporaryFolder folder;
  const auto file = folder.path() / "rows.csv";
  const std::string whole = run_tethercalc(mixed_sweep()).out;
  const std::string line = shell_line(mixed_sweep({"--output", file.string(), "--resume"}));
  const Ran full = run_shell("trap '' XFSZ; ulimit -f 200; " + line);
  CHECK(full.exit_code == 2);
  CHECK_THAT(full.err, Contains("ends with a whole row") && Contains("--resume"));
  const std::string kept = file_text(file);
  CHECK(kept.size() > 50000);
  CHECK(kept.back() == '\n');
  CHECK(whole.starts_with(kept));
  CHECK(run_shell(line).exit_code == 0);
  CHECK(file_text(file) == whole);
}

TEST_CASE("a folder that cannot be written is told before the run") {
  const TemporaryFolder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms(0555));
  const std::string file = (folder.path() / "rows.csv").string();
  std::string line = shell_line(mixed_sweep({"--output", file}));
  // Permissions do not stop the superuser: become nobody.
  if (geteuid() == 0) line = "setpriv --reuid=65534 --clear-groups " + line;
  const Ran run = run_shell(line);
  std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
  CHECK(run.exit_code == 2);
  CHECK_THAT(run.err, Contains(file) && Contains("Permission denied"));
}

TEST_CASE("an interrupted sweep leaves whole rows and says how to go on") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "rows.csv";
  const std::vector<std::string> arguments{"sweep",    published,
                                           "--vary",   "supply.voltage_V=40:100:0.001",
                                           "--vary",   "tether.length_m=10:60:0.1",
                                           "--output", file.string()};
  // Thirty million rows: it is interrupted long before the end, once there are some.
  const std::string name = shell_quoted(file.string());
  const Ran run = run_shell(
      shell_line(arguments) + " & process=$!; while [ ! -s " + name +
      " ] && kill -0 $process; do sleep 0.05; done; kill -s TERM $process; wait $process");
  CHECK(run.exit_code == 128 + SIGTERM);
  CHECK_THAT(run.err, Contains("interrupted after") && Contains("--resume"));
  const std::string rows = file_text(file);
  REQUIRE_FALSE(rows.empty());
  CHECK(rows.back() == '\n');
}

TEST_CASE(
    "a cable that overheats without end is limited by its heat, in the row as in the reason") {
  const Ran run =
      run_tethercalc({"sweep", published, "--vary", "tether.cross_section_mm2=3", "--set",
                      "tether.ambient_temperature_C=40", "--set", "supply.voltage_V=60", "--set",
                      "requirements.thrust_headroom=1", "--set", "tether.drum.layers=3", "--set",
                      "tether.spooled_length_m=50", "--format", "jsonl"});
  const json row = json::parse(run.out);
  CHECK(row["status"] == "infeasible");
  CHECK(row["limited_by"] == "conductor_temperature");
  CHECK(row["reason"] == "overheats without end in forward flight");
}

TEST_CASE("a summary's quantiles are those of a plain run, its indices those of a simple model") {
  const TemporaryFolder folder;
  const std::string summary_file = (folder.path() / "summary.json").string();
  const std::vector<std::string> base{"sweep",  published,
                                      "--vary", "supply.voltage_V=100~2",
                                      "--vary", "tether.length_m=20..40",
                                      "--vary", "drone.mass_g=1710~20"};
  std::vector<std::string> arguments = base;
  arguments.insert(arguments.end(), {"--sample", "4096", "--method", "lhs", "--seed",
                                     std::to_string(run_seed()), "--summary", summary_file});
  const Ran run = run_tethercalc(arguments);
  REQUIRE(run.exit_code == 0);
  CHECK_THAT(run.err,
             Contains("4096 draws") && Contains("Share in the variance of the total power"));
  CHECK(widest_line(run.err) <= 100);

  std::vector<double> powers;
  const auto lines = lines_of(run.out);
  const auto columns = cells_of(lines[0]);
  const auto column = static_cast<std::size_t>(
      std::find(columns.begin(), columns.end(), "forward.total_power_W") - columns.begin());
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::string cell = cells_of(lines[i])[column];
    if (!cell.empty()) powers.push_back(std::stod(cell));
  }
  std::sort(powers.begin(), powers.end());
  const json summary = json::parse(file_text(summary_file));
  CHECK(summary["draws"] == 4096);
  CHECK(summary["infeasible"] == 4096 - powers.size());
  for (const auto& [share, value] : summary["total_power_W"]["quantiles"].items()) {
    const double p = std::stod(share);
    const auto rank =
        static_cast<std::size_t>(std::ceil(p * static_cast<double>(powers.size()))) - 1;
    CHECK(value.get<double>() == Approx(powers[rank]).epsilon(1.1e-5));
  }
  CHECK(summary["total_power_W"]["min"] == powers.front());
  CHECK(summary["total_power_W"]["max"] == powers.back());

  // Power is close to linear here, and length spreads it most by far.
  double sum = 0;
  for (const json& index : summary["sensitivity"]["total_power_W"]) {
    const double total = index["total"]["value"].get<double>();
    CHECK(index["first_order"]["value"].get<double>() == Approx(total).margin(0.1));
    sum += index["first_order"]["value"].get<double>();
    CHECK((total > 0.5) == (index["field"] == "tether.length_m"));
  }
  CHECK(sum == Approx(1).margin(0.1));
}
