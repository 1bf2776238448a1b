// A user's own motor from a test-bench CSV.
#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "support/reference_data.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/model/units.hpp"

using namespace tethercalc;
namespace fs = std::filesystem;

namespace {

struct Run {
  std::vector<double> thrust_g;
  std::vector<double> power_W;
};

/// A folder that goes away with its content.
class TemporaryFolder {
 public:
  TemporaryFolder()
      : path_(fs::temp_directory_path() /
              ("tethercalc-motor-" + std::to_string(std::random_device{}()))) {
    fs::create_directories(path_);
  }
  ~TemporaryFolder() { fs::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

MotorEntry motor_of(const std::string& csv) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "bench.csv") << csv;
  return find_motor("bench.csv", files_in(folder.path()));
}

/// The bench runs by the name of the test. Columns: test first, thrust_gf sixth, power_W tenth.
std::map<std::string, Run> bench_runs(const fs::path& path) {
  std::map<std::string, Run> runs;
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  REQUIRE(
      line.starts_with("test,motor,prop,supply_nominal_V,esc_us,thrust_gf,voltage_V,current_A,"
                       "rpm_elec,power_W"));
  while (std::getline(file, line)) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    runs[cells.at(0)].thrust_g.push_back(std::stod(cells.at(5)));
    runs[cells.at(0)].power_W.push_back(std::stod(cells.at(9)));
  }
  return runs;
}

std::string csv_of(const Run& run) {
  std::ostringstream csv;
  csv.precision(17);
  csv << "throttle_percent,thrust_g,remark,power_W\n";
  for (std::size_t i = 0; i < run.thrust_g.size(); ++i) {
    csv << i << ',' << run.thrust_g[i] << ",bench 3," << run.power_W[i] << '\n';
  }
  return csv.str();
}

}  // namespace

TEST_CASE("a clean bench run becomes its motor curve, other columns ignored") {
  const MotorEntry motor = motor_of(
      "time,power_W,note,thrust_g\r\n"
      "0,10,first,100\r\n"
      "1,25,,200\r\n"
      "2,60,last,400\r\n");
  CHECK(motor.warnings.empty());
  CHECK(motor.name == "bench");
  CHECK(motor.curve.power(200 * unit::gram_force) == Approx(25).epsilon(1e-14));
  CHECK(motor.curve.max_thrust() == Approx(0.4 * 9.80665).epsilon(1e-14));
}

TEST_CASE("pooled and idle rows are named by their lines") {
  const MotorEntry motor = motor_of(
      "thrust_g,power_W\n"
      "-0.4,1.2\n"
      "100,10\n"
      "200,30\n"
      "300,20\n"
      "400,60\n");
  REQUIRE(motor.warnings.size() == 2);
  CHECK_THAT(motor.warnings[0].sentence, Catch::Contains("bench.csv:2: left out"));
  CHECK_THAT(motor.warnings[0].sentence, Catch::Contains("-0.4 g at 1.20 W"));
  CHECK_THAT(motor.warnings[1].sentence,
             Catch::Contains("pooled to 250.0 g at 25.00 W: 200.0 g at 30.00 W (line 4), "
                             "300.0 g at 20.00 W (line 5)"));
  CHECK(motor.curve.power(250 * unit::gram_force) == Approx(25).epsilon(1e-14));
}

TEST_CASE("warnings of a motor reach the one who reads the design") {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "mine.csv")
      << "thrust_g,power_W\n100,10\n500,70\n800,60\n900,150\n";
  const DesignFile file = parse_design(starting_spec(), "spec.json", files_in(folder.path()),
                                       std::vector<std::string>{"drone.motor=mine.csv"});
  REQUIRE(file.warnings.size() == 1);
  CHECK_THAT(file.warnings[0].sentence, Catch::Contains("500.0 g at 70.00 W (line 3)"));
}

TEST_CASE("real bench runs all become motor curves, and the noisy ones say what was pooled") {
  const auto path = test::reference_file("data/bench/strawson_all.csv");
  if (!path) return;
  const std::map<std::string, Run> runs = bench_runs(*path);
  CHECK(runs.size() == 208);
  int noisy_runs = 0;
  int reversed_runs = 0;
  for (const auto& [name, run] : runs) {
    INFO(name);
    // What a person sees in the rows: which have no thrust or power, and whether the rest rises.
    std::vector<std::pair<double, double>> rows;
    for (std::size_t i = 0; i < run.thrust_g.size(); ++i) {
      if (run.thrust_g[i] > 0 && run.power_W[i] > 0) {
        rows.emplace_back(run.thrust_g[i], run.power_W[i]);
      }
    }
    if (rows.size() < 2) {  // pulled at the load cell instead of pushing
      ++reversed_runs;
      CHECK_THROWS_WITH(motor_of(csv_of(run)), Catch::Contains("is a sign reversed?"));
      continue;
    }
    const MotorEntry motor = motor_of(csv_of(run));
    std::sort(rows.begin(), rows.end());
    bool rises = true;
    for (std::size_t i = 1; i < rows.size(); ++i) {
      rises = rises && rows[i].first > rows[i - 1].first && rows[i].second > rows[i - 1].second;
    }
    const std::size_t idle = run.thrust_g.size() - rows.size();
    CHECK((motor.warnings.size() > idle) == !rises);
    if (!rises) ++noisy_runs;
    // Pooling averages, so the curve stays within what was measured.
    CHECK(motor.curve.max_thrust() <= rows.back().first * unit::gram_force * (1 + 1e-12));
    double largest_power = 0;
    for (const auto& row : rows) largest_power = std::max(largest_power, row.second);
    CHECK(motor.curve.max_power() <= largest_power * (1 + 1e-12));
    // A run that rises is reproduced row by row.
    for (std::size_t i = 0; rises && i + 1 < rows.size(); ++i) {
      CHECK(motor.curve.power(rows[i].first * unit::gram_force) ==
            Approx(rows[i].second).epsilon(1e-9));
    }
  }
  CHECK(noisy_runs > 0);
  CHECK(reversed_runs == 4);  // m7 and m8, each at two voltages
}
