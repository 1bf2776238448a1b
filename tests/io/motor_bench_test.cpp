// Thrust-stand tables as data sheets and benches write them.
#include "tethercalc/io/motor_bench.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "io/bench_header.hpp"
#include "support/reference_data.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/model/units.hpp"

using namespace tethercalc;
using Catch::Contains;

namespace {

MotorBench bench_of(const std::string& text, const MotorBenchOptions& options = {}) {
  const LoadedText table{"bench.csv", text};
  return motor_from_bench({&table, 1}, options);
}

/// Every problem of the table in one text; empty where there is none.
std::string bench_refusal(const std::string& text, const MotorBenchOptions& options = {}) {
  try {
    (void)bench_of(text, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

double power_at(const MotorBench& bench, double grams) {
  return bench.motor.curve.power(grams * unit::gram_force);
}

}  // namespace

TEST_CASE("a quantity is understood however a header spells its unit") {
  struct Spelling {
    const char* header;
    BenchQuantity quantity;
    double factor;
  };
  // 1 N = 1000/9.80665 gf; 1 lb = 453.59237 g; 1 oz = 28.349523125 g.
  for (const Spelling& s : std::initializer_list<Spelling>{
           {"thrust_g", BenchQuantity::thrust, 1},
           {"Thrust (g)", BenchQuantity::thrust, 1},
           {"Thrust(G)", BenchQuantity::thrust, 1},
           {"THRUST [gf]", BenchQuantity::thrust, 1},
           {"Thrust [N]", BenchQuantity::thrust, 101.97162129779283},
           {"thrust, kgf", BenchQuantity::thrust, 1000},
           {"Pull (kg)", BenchQuantity::thrust, 1000},
           {"thrust_lbf", BenchQuantity::thrust, 453.59237},
           {"Thrust (oz)", BenchQuantity::thrust, 28.349523125},
           {"Schub / N", BenchQuantity::thrust, 101.97162129779283},
           {"Power (W)", BenchQuantity::power, 1},
           {"Electrical Power (W)", BenchQuantity::power, 1},
           {"input power [kW]", BenchQuantity::power, 1000},
           {"Watts", BenchQuantity::power, 1},
           {"Efficiency (g/W)", BenchQuantity::efficiency, 1},
           {"efficiency_g_per_W", BenchQuantity::efficiency, 1},
           {"Overall Efficiency (kgf/W)", BenchQuantity::efficiency, 1000},
           {"Voltage (V)", BenchQuantity::voltage, 1},
           {"Volts", BenchQuantity::voltage, 1},
           {"Current (mA)", BenchQuantity::current, 1e-3},
           {"Current_A", BenchQuantity::current, 1},
           {"Throttle (%)", BenchQuantity::throttle, 1},
           {"ESC signal (µs)", BenchQuantity::throttle, 1}}) {
    CAPTURE(s.header);
    const auto meaning = bench_column_meaning(s.header);
    REQUIRE(meaning);
    CHECK(meaning->quantity == s.quantity);
    CHECK(meaning->factor == Approx(s.factor).epsilon(1e-12));
  }
}

TEST_CASE("a unit that is missing or another quantity's, and mechanical power, are not guessed") {
  for (const char* header :
       {"Thrust", "Power", "Thrust (W)", "Mechanical Power (W)", "Motor Efficiency (%)",
        "Propeller Mech. Efficiency (kgf/W)", "Torque (N·m)", "supply_nominal_V", "RPM", "g", ""}) {
    CAPTURE(header);
    CHECK_FALSE(bench_column_meaning(header));
  }
}

TEST_CASE("one table in every dress is one motor") {
  const std::string plain = "thrust_g,power_W\n100,10\n200,25\n400,60.5\n";
  const MotorBench expected = bench_of(plain);
  for (const std::string& dressed : std::initializer_list<std::string>{
           "\xEF\xBB\xBFThrust (g),Power (W)\r\n100,10\r\n200,25\r\n400,60.5\r\n",
           "Thrust (g);Power (W)\n100,0;10,0\n200;25\n400;60,5\n",
           "Thrust (g)\tPower (W)\n100\t10\n200\t25\n400\t60,5\n",
           "Test report of 3 May;;\n\n# on the roof\nPower (W);Thrust (g);Note\n10;100;\n"
           "// tea\n25;200;ok\n;;\n60.5;400;\"a;b\"\n",
           "Thrust (g);Efficiency (g/W)\n100;10\n200;8\n400;6,6115702479338845\n",
           "\"Thrust (g)\",\"Power, W\"\n\"100\",\"10\"\n200,25\n400,\"60,5\"\n",
           "Voltage (V),Current (A),Thrust (kgf)\n10,1,0.1\n10,2.5,0.2\n10,6.05,0.4\n"}) {
    CAPTURE(dressed);
    const MotorBench bench = bench_of(dressed);
    CHECK(bench.rows == 3);
    CHECK(bench.motor.warnings.empty());
    for (const double grams : {50.0, 100.0, 333.0, 400.0}) {
      CHECK(power_at(bench, grams) == Approx(power_at(expected, grams)).epsilon(1e-12));
    }
  }
}

TEST_CASE("a header that is not understood is answered with what it has and how to name it") {
  const std::string text = bench_refusal("F;P\n1;10\n2;30\n");
  CHECK_THAT(text, Contains("bench.csv:1") && Contains("F | P") && Contains("--columns thrust_g="));
  const MotorBench named = bench_of("F;P\n1;10\n2;30\n", {{"thrust_N=F", "power_W=P"}, {}});
  CHECK(named.motor.curve.max_thrust() == Approx(2));
  CHECK(named.motor.curve.max_power() == Approx(30));
  CHECK_THAT(bench_refusal("F;P\n1;10\n", {{"thrust_N=f2", "power_W=P"}, {}}),
             Contains("there is no column \"f2\""));
  CHECK_THAT(bench_refusal("F;P\n1;10\n", {{"force=F"}, {}}), Contains("does not say what"));
}

TEST_CASE("of a file that is no table of numbers nothing is shown") {
  for (const std::string file :
       {"root:x:0:0:root:/root:/bin/bash\ndaemon:x:1:1:daemon:/usr/sbin:/bin/sh\n",
        "secret = swordfish, 12\nuser = admin, x\n", "password swordfish"}) {
    const std::string text = bench_refusal(file);
    CHECK_THAT(text,
               Contains("is no table of a motor") && !Contains("root:x") && !Contains("swordfish"));
  }
}

TEST_CASE("a quote that is not closed is told as such") {
  CHECK_THAT(bench_refusal("Thrust (g),Power (W)\n100,\"10\n200,25\n"),
             Contains("bench.csv:2: a quote is opened and not closed"));
}

TEST_CASE("a name that was given outranks what the header says") {
  const std::string table = "thrust_g,power_W,bench power\n100,10,12\n200,25,30\n";
  CHECK(bench_of(table).motor.curve.max_power() == Approx(25));
  CHECK(bench_of(table, {{"power_W=bench power"}, {}}).motor.curve.max_power() == Approx(30));
}

TEST_CASE("two columns of one quantity and unit are asked about, in two units they are one") {
  CHECK_THAT(bench_refusal("Thrust (g),Pull (g),Power (W)\n1,1,1\n2,2,2\n"),
             Contains("may both be thrust_g"));
  CHECK(bench_of("Thrust (g),Thrust (oz),Power (W)\n100,3.5,10\n200,7,25\n").rows == 2);
}

TEST_CASE("numbers whose commas may be decimals or thousands are refused, others are read") {
  CHECK_THAT(bench_refusal("Thrust (g);Power (W)\n1,234;110\n2,345;260\n"), Contains("thousands"));
  CHECK_THAT(bench_refusal("Thrust (g);Power (W)\n1234;110.5\n2345;260,5\n"),
             Contains("commas as well as points"));
  CHECK(bench_of("Thrust (kgf);Power (W)\n0,234;110\n0,345;260\n").motor.curve.max_thrust() ==
        Approx(0.345 * 9.80665));
  // Decimal commas between commas break a row into too many cells.
  CHECK_THAT(bench_refusal("Thrust (g),Power (W)\n100,10,5\n200,25,5\n"),
             Contains("bench.csv:2: 3 cells") && Contains("need ; or tabs"));
}

TEST_CASE("an up and down sweep is averaged, and its scatter told") {
  // Up at 2 % more power than the mean, down at 2 % less.
  std::ostringstream csv;
  csv << "thrust_g,power_W\n";
  const auto mean = [](double grams) { return 0.003 * std::pow(grams, 1.5); };
  for (int g = 100; g <= 1000; g += 100) csv << g << ',' << 1.02 * mean(g) << '\n';
  for (int g = 1000; g >= 100; g -= 100) csv << g << ',' << 0.98 * mean(g) << '\n';
  const MotorBench bench = bench_of(csv.str());
  CHECK(bench.passes == 2);
  for (int g = 100; g <= 1000; g += 100) CHECK(power_at(bench, g) == Approx(mean(g)).epsilon(1e-5));
  CHECK(bench.scatter == Approx(0.02).epsilon(0.01));
  REQUIRE(bench.motor.warnings.size() == 1);
  CHECK_THAT(bench.motor.warnings[0].sentence,
             Contains("20 rows of repeated runs or sweeps were averaged to 10 points") &&
                 Contains("2.0 %"));
}

TEST_CASE("rows of one throttle are averaged, and files of repeated runs are one motor") {
  const std::vector<LoadedText> runs{
      {"run1.csv", "Throttle (%),thrust_g,power_W\n40,100,10\n60,200,26\n"},
      {"run2.csv", "Throttle (%),thrust_g,power_W\n40,104,12\n60,204,30\n"}};
  const MotorBench bench = motor_from_bench(runs);
  CHECK(bench.rows == 4);
  CHECK(bench.motor.id == "run1");
  CHECK_THAT(bench.motor.source, Contains("run1.csv, run2.csv"));
  CHECK(power_at(bench, 102) == Approx(11));
  CHECK(power_at(bench, 202) == Approx(28));
}

TEST_CASE("power that is not voltage times current is told") {
  const MotorBench bench =
      bench_of("thrust_g,power_W,voltage_V,current_A\n100,20,10,1\n200,50,10,2.5\n300,80,10,4\n");
  REQUIRE(bench.motor.warnings.size() == 1);
  CHECK_THAT(bench.motor.warnings[0].sentence, Contains("2.00 times its voltage times current"));
}

TEST_CASE("a table of several motors asks which, and where chooses") {
  const std::string table =
      "motor;prop;thrust_g;power_W\nA;10;100;10\nA;10;200;25\nB;10;150;10\nB;10;300;30\n";
  CHECK_THAT(bench_refusal(table), Contains("\"A\", \"B\"") && Contains("--where motor=VALUE"));
  const MotorBench b = bench_of(table, {{}, {"motor=B"}});
  CHECK(b.motor.curve.max_thrust() == Approx(0.3 * 9.80665));
  CHECK_THAT(b.motor.source, Contains("bench.csv: motor=B"));
  CHECK_THAT(bench_refusal(table, {{}, {"motor=C"}}), Contains("there are \"A\", \"B\""));
  CHECK_THAT(bench_refusal(table, {{}, {"motr=B"}}), Contains("did you mean \"motor\""));
}

TEST_CASE("a motor file holds what its bench said, and reads back as the same curve") {
  MotorEntry motor =
      bench_of("thrust_g,power_W,voltage_V\n100.5,10.25,16\n200,25,15.9\n400,60,15.8\n").motor;
  motor.propeller_in = 10;
  motor.curve.set_measured_in(1.2);
  const std::string text = motor_document(motor).dump();
  const MotorEntry back = find_motor("x.json", [&](const std::string&) {
    return LoadedText{"x.json", text};
  });
  CHECK(back.id == "bench");
  CHECK(back.propeller_in == 10);
  CHECK(back.voltage_V == Approx(15.9));
  CHECK(back.curve.measured_in() == 1.2);
  REQUIRE(back.curve.vertices().size() == motor.curve.vertices().size());
  for (std::size_t i = 0; i < back.curve.vertices().size(); ++i) {
    CHECK(back.curve.vertices()[i].thrust == Approx(motor.curve.vertices()[i].thrust));
    CHECK(back.curve.vertices()[i].power == Approx(motor.curve.vertices()[i].power));
  }
}

TEST_CASE("a motor without an id is called after its file, an estimate says so") {
  const auto load = [](const std::string& name) {
    return LoadedText{name, name.ends_with(".csv")
                                ? "thrust_g,power_W\n100,10\n200,25\n"
                                : R"({"power_uncertainty_percent": 26, "points": [
        {"thrust_g": 100, "power_W": 10}, {"thrust_g": 200, "power_W": 25}]})"};
  };
  CHECK(find_motor("my/roof bench.csv", load).id == "roof bench");
  const MotorEntry estimate = find_motor("mine.json", load);
  CHECK(estimate.id == "mine");
  REQUIRE(estimate.warnings.size() == 1);
  CHECK_THAT(estimate.warnings[0].sentence, Contains("estimate") && Contains("26 %"));
}

TEST_CASE("of 208 bench runs in one file each becomes a motor or says why not") {
  const auto path = test::reference_file("data/bench/strawson_all.csv");
  if (!path) return;
  const LoadedText table = files_in(path->parent_path())(path->filename().string());
  std::set<std::string> tests;
  std::istringstream lines(table.text);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) tests.insert(line.substr(0, line.find(',')));
  CHECK(tests.size() == 208);
  CHECK_THROWS_WITH(motor_from_bench({&table, 1}), Contains("--where motor=VALUE"));
  std::size_t motors = 0;
  std::size_t reversed = 0;
  for (const std::string& test : tests) {
    CAPTURE(test);
    try {
      const MotorBench bench = motor_from_bench({&table, 1}, {{}, {"test=" + test}});
      ++motors;
      CHECK(bench.motor.curve.vertices().size() >= 3);
    } catch (const InputError& error) {
      ++reversed;
      CHECK_THAT(error.what(), Contains("is a sign reversed?"));
    }
  }
  CHECK(motors == 204);
  CHECK(reversed == 4);
}
