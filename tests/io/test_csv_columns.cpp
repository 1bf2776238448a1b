// CSV: what is accepted, and what every refusal says.
#include <fmt/format.h>

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "io/csv.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/log_readers.hpp"
#include "tethercalc/model/units.hpp"

using namespace tethercalc;

namespace {

const std::array<CsvColumn, 3> wanted = {CsvColumn{.name = "time_s", .increasing = true},
                                         CsvColumn{.name = "load_N", .minimum = 0, .maximum = 100},
                                         CsvColumn{.name = "note_V", .required = false}};

std::vector<std::vector<double>> read(const std::string& text,
                                      OtherCsvColumns others = OtherCsvColumns::rejected) {
  return read_csv_columns(text, "run.csv", wanted, others);
}

/// All problems of a text, "where: message" line by line.
std::string problems_of(const std::string& text) {
  try {
    (void)read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

std::string flight_problems(const std::string& text) {
  try {
    (void)parse_flight_log(bytes_of(text), "flight.csv", {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

PowerLog power_of(const std::string& text, bool free_flight = false) {
  return parse_power_log(bytes_of(text), "log.csv", {.free_flight = free_flight}).log;
}

const std::string flight_header = "time_s,roll_deg,pitch_deg,yaw_deg,vn_m_s,ve_m_s,vd_m_s\n";

}  // namespace

TEST_CASE("columns are found by name, in whatever order the file has them") {
  const auto columns = read("load_N,note_V,time_s\n1,2,0\n3,4,0.5\n");
  CHECK(columns[0] == std::vector<double>{0, 0.5});
  CHECK(columns[1] == std::vector<double>{1, 3});
  CHECK(columns[2] == std::vector<double>{2, 4});
}

TEST_CASE("an optional column that is missing is an empty vector") {
  CHECK(read("time_s,load_N\n0,1\n")[2].empty());
}

TEST_CASE(
    "byte order mark, CRLF, blanks, exponents, no last line end and blank last lines are fine") {
  const std::vector<std::vector<double>> expected = {{0, 1}, {25, 30}, {}};
  CHECK(read("\xEF\xBB\xBFtime_s,load_N\r\n0,2.5e1\r\n1,30\r\n") == expected);
  CHECK(read("time_s , load_N\n 0,\t25 \n1,30") == expected);
  CHECK(read("time_s,load_N\n0,25\n1,30\n\n\r\n") == expected);
}

TEST_CASE("columns with other names can be ignored, with whatever they hold") {
  const auto columns = read("name,time_s,load_N\nfoo,0,1\n,1,2\n", OtherCsvColumns::ignored);
  CHECK(columns[1] == std::vector<double>{1, 2});
}

TEST_CASE("every problem is told at once, with its line") {
  CHECK(problems_of("time_s,load_N\n0,abc\n1,\n2,3,4\n3,nan\n4,inf\n5,1e999\n6,101\n7,1\n7,1\n") ==
        "run.csv:2: load_N is \"abc\", expected a number such as -1.25\n"
        "run.csv:3: load_N is empty, expected a number such as -1.25\n"
        "run.csv:4: 3 cells in the row, expected 2 as in the header\n"
        "run.csv:5: load_N is \"nan\", expected a finite number\n"
        "run.csv:6: load_N is \"inf\", expected a finite number\n"
        "run.csv:7: load_N is \"1e999\", expected a finite number\n"
        "run.csv:8: load_N is \"101\", expected 0 to 100\n"
        "run.csv:10: time_s is 7, expected more than the 7 before it");
}

TEST_CASE("a number with anything behind or before it is not a number") {
  for (const std::string cell :
       {"1.5x", "1_5", "0x10", "--1", "1 2", "1;2", "\"1\"", "+", "-", ".", "e5"}) {
    INFO(cell);
    CHECK(problems_of("time_s,load_N\n0," + cell + "\n").find("run.csv:2: load_N is") == 0);
  }
}

TEST_CASE("header problems name the column, and the closest known one") {
  CHECK(problems_of("time,load_N\n0,1\n") ==
        "run.csv:1: unknown column \"time\"; did you mean \"time_s\"?\n"
        "run.csv:1: column \"time_s\" is missing from the header\n"
        "run.csv:1: known columns are time_s,load_N,note_V");
  CHECK(problems_of("time_s,load_N,load_N\n0,1,1\n") ==
        "run.csv:1: column \"load_N\" appears twice");
}

TEST_CASE("other separators than commas are one problem") {
  CHECK(problems_of("time_s;load_N\n0;1\n") ==
        "run.csv:1: semicolons or tabs separate the cells; expected commas, and points in numbers");
  CHECK(problems_of("time_s\tload_N\r\n0\t1\r\n") ==
        "run.csv:1: semicolons or tabs separate the cells; expected commas, and points in numbers");
  CHECK(read("time_s,\tload_N\n0,1\n")[1].size() == 1);
}

TEST_CASE("files without a header or without rows are refused") {
  CHECK(problems_of("") ==
        "run.csv:1: the file is empty, expected the header time_s,load_N,note_V");
  CHECK(problems_of("time_s,load_N\n") == "run.csv:1: there are no rows below the header");
  CHECK(problems_of("time_s,load_N\n\n0,1\n").find("run.csv:2: 0 cells in the row") == 0);
}

TEST_CASE("of very many problems, the first are told and the others counted") {
  std::string text = "time_s,load_N\n";
  for (int i = 0; i < 100; ++i) text += std::to_string(i) + ",x\n";
  try {
    (void)read(text);
    FAIL("accepted");
  } catch (const InputError& error) {
    REQUIRE(error.problems().size() == 21);
    CHECK(error.problems().back().message == "and 80 more problems");
  }
}

TEST_CASE("a flight log in CSV comes out in radians, NED as given") {
  const std::string text = flight_header + "0,10,-20,359,1,2,3\n0.1,-10,20,1,4,5,-6\n";
  const FlightLogReading reading = parse_flight_log(bytes_of(text), "flight.csv", {});
  const FlightLog& log = reading.log;
  CHECK(reading.source == "CSV");
  CHECK(reading.notes.empty());
  CHECK(log.time == std::vector<double>{0, 0.1});
  CHECK(log.roll[0] == 10 * unit::degree);
  CHECK(log.pitch[1] == 20 * unit::degree);
  CHECK(log.yaw[0] == 359 * unit::degree);
  CHECK(log.yaw[1] == Approx(361 * unit::degree).epsilon(1e-15));  // no jump at north
  CHECK(log.north_velocity == std::vector<double>{1, 4});
  CHECK(log.east_velocity == std::vector<double>{2, 5});
  CHECK(log.down_velocity == std::vector<double>{3, -6});
}

TEST_CASE("a measured wind comes from its own columns, or from the airspeed along the heading") {
  const std::string header =
      flight_header.substr(0, flight_header.size() - 1) + ",wind_north_m_s,wind_east_m_s\n";
  const FlightLog winds =
      parse_flight_log(bytes_of(header + "0,0,0,90,1,2,3,-4,5\n0.1,0,0,90,1,2,3,-4,6\n"),
                       "flight.csv", {})
          .log;
  CHECK(winds.north_wind == std::vector<double>{-4, -4});
  CHECK(winds.east_wind == std::vector<double>{5, 6});

  const std::string airspeed =
      flight_header.substr(0, flight_header.size() - 1) + ",airspeed_forward_m_s\n";
  const FlightLog ahead =
      parse_flight_log(bytes_of(airspeed + "0,0,0,90,1,2,3,5\n0.1,0,0,0,1,2,3,5\n"), "flight.csv",
                       {})
          .log;
  // To the east at 2 m/s with 5 m/s of air from ahead: 3 m/s of wind from the east.
  CHECK(ahead.north_wind[0] == Approx(0).margin(1e-12));
  CHECK(ahead.east_wind[0] == Approx(-3));
  CHECK(ahead.north_wind[1] == Approx(-4));
  CHECK(ahead.east_wind[1] == Approx(0).margin(1e-12));

  const std::string half =
      flight_header.substr(0, flight_header.size() - 1) + ",wind_north_m_s\n0,0,0,0,1,2,3,4\n";
  CHECK_THAT(flight_problems(half), Catch::Contains("give both or none"));
  const std::string both =
      header.substr(0, header.size() - 1) + ",airspeed_forward_m_s\n0,0,0,0,1,2,3,4,5,6\n";
  CHECK_THAT(flight_problems(both), Catch::Contains("only one can be what was measured"));
}

TEST_CASE("a flight log in CSV is refused where a value cannot be, or time does not increase") {
  CHECK(flight_problems(flight_header + "0,0,90.1,0,0,0,0\n") ==
        "flight.csv:2: pitch_deg is \"90.1\", expected -90 to 90");
  CHECK(flight_problems(flight_header + "1,0,0,0,0,0,0\n0.5,0,0,0,0,0,0\n") ==
        "flight.csv:3: time_s is 0.5, expected more than the 1 before it");
}

TEST_CASE("a power log has its optional channels only where the file has them") {
  const PowerLog full = power_of(
      "time_s,height_m,airspeed_m_s,ambient_temperature_C,supply_voltage_V,supply_current_A,"
      "drone_voltage_V,bus_voltage_V,bus_current_A\n1,2,3,4,5,6,7,8,9\n");
  CHECK(full.time == std::vector<double>{1});
  CHECK(full.height == std::vector<double>{2});
  CHECK(full.airspeed == std::vector<double>{3});
  CHECK(full.ambient_temperature_C == std::vector<double>{4});
  CHECK(full.supply_voltage == std::vector<double>{5});
  CHECK(full.supply_current == std::vector<double>{6});
  CHECK(full.drone_voltage == std::vector<double>{7});
  CHECK(full.bus_voltage == std::vector<double>{8});
  CHECK(full.bus_current == std::vector<double>{9});
  const PowerLog least =
      power_of("time_s,height_m,airspeed_m_s,supply_voltage_V,supply_current_A\n1,2,3,5,6\n");
  CHECK(least.supply_current == std::vector<double>{6});
  CHECK(least.ambient_temperature_C.empty());
  CHECK(least.drone_voltage.empty());
  CHECK(least.bus_voltage.empty());
  CHECK(least.bus_current.empty());
}

TEST_CASE("a power log needs no supply, and no height where it flew free") {
  const PowerLog bus =
      power_of("time_s,height_m,airspeed_m_s,bus_voltage_V,bus_current_A\n1,2,3,16,20\n");
  CHECK(bus.supply_voltage.empty());
  CHECK(bus_power_of(bus) == std::vector<double>{320});
  const PowerLog free = power_of("time_s,airspeed_m_s,bus_power_W\n1,3,450\n", true);
  CHECK(free.free_flight);
  CHECK(free.height.empty());
  CHECK(bus_power_of(free) == std::vector<double>{450});
  CHECK_THROWS_WITH(power_of("time_s,airspeed_m_s,bus_power_W\n1,3,450\n"),
                    "log.csv:1: column \"height_m\" is missing from the header");
}

TEST_CASE("power at the bus is told in one way") {
  CHECK_THROWS_WITH(power_of("time_s,airspeed_m_s,bus_power_W,bus_current_A\n1,3,450,20\n", true),
                    Catch::Contains("bus_power_W goes without bus_voltage_V and bus_current_A"));
}

TEST_CASE("one CSV serves both halves, each passing over the other's cells") {
  const std::string header =
      "time_s,roll_deg,pitch_deg,yaw_deg,vn_m_s,ve_m_s,vd_m_s,height_m,airspeed_m_s,"
      "bus_voltage_V,bus_current_A\n";
  const std::string no_power = header + "1,2,3,4,5,6,7,,-,,n/a\n2,2,3,4,5,6,7,,,,\n";
  const FlightLogReading flight = parse_flight_log(bytes_of(no_power), "log.csv", {});
  CHECK(flight.log.down_velocity == std::vector<double>{7, 7});
  const PowerLog power = power_of(header + "1,,,4,5,6,,8,9,16,20\n");
  CHECK(power.height == std::vector<double>{8});
  CHECK(power.airspeed == std::vector<double>{9});
}

TEST_CASE("a power log's acceleration is told, or that of its velocity over ground") {
  const PowerLog told = power_of(
      "time_s,height_m,airspeed_m_s,bus_voltage_V,bus_current_A,acceleration_along_m_s2,"
      "acceleration_across_m_s2\n1,2,3,16,20,0.5,-0.25\n");
  CHECK(told.acceleration_along == std::vector<double>{0.5});
  CHECK(told.acceleration_across == std::vector<double>{-0.25});
  // Speeding up by 1.5 m/s² to the north, and then round a circle at 6 m/s with 3 m/s² inward.
  std::string text = "time_s,height_m,airspeed_m_s,vn_m_s,ve_m_s,bus_voltage_V,bus_current_A\n";
  for (int i = 0; i <= 80; ++i) {
    const double t = 0.1 * i;
    const double speed = std::min(6.0, 1.5 * t);
    const double course = std::max(0.0, 0.5 * (t - 4));
    text += std::to_string(t) + ",2," + std::to_string(speed) + "," +
            std::to_string(speed * std::cos(course)) + "," +
            std::to_string(speed * std::sin(course)) + ",16,20\n";
  }
  const PowerLog made = power_of(text);
  REQUIRE(made.acceleration_along.size() == 81);
  CHECK(made.acceleration_along[20] == Approx(1.5).epsilon(1e-4));
  CHECK(made.acceleration_across[20] == Approx(0).margin(1e-4));
  CHECK(made.acceleration_along[60] == Approx(0).margin(1e-4));
  // Of the chord over 0.4 s instead of the arc.
  CHECK(made.acceleration_across[60] == Approx(3 * std::sin(0.1) / 0.1).epsilon(1e-4));
  CHECK(power_of("time_s,height_m,airspeed_m_s,bus_voltage_V,bus_current_A\n1,2,3,16,20\n")
            .acceleration_along.empty());
}

TEST_CASE("a misspelt column of a log is refused with the closest of either half") {
  CHECK_THROWS_WITH(
      power_of("time_s,height_m,airspeed_m_s,bus_voltage,bus_current_A\n1,2,3,4,5\n"),
      Catch::Contains("unknown column \"bus_voltage\"") && Catch::Contains("bus_voltage_V\"?"));
  CHECK(flight_problems("time_s,roll_deg,pitch_deg,yaw_deg,vn_m_s,ve_m_s,vd_m_s,bus_powr_W\n")
            .find("bus_power_W") != std::string::npos);
}

TEST_CASE(
    "an airspeed that is missing is made of velocity and measured wind, or told to be ground "
    "speed") {
  const auto read = [](const std::string& text) {
    return parse_power_log(bytes_of(text), "log.csv", {.free_flight = true});
  };
  // 3 m/s to the north in air that moves 1 m/s southward and 3 m/s westward: 4 and 3.
  CHECK(read("time_s,vn_m_s,ve_m_s,wind_north_m_s,wind_east_m_s,bus_power_W\n1,3,0,-1,-3,450\n")
            .log.airspeed == std::vector<double>{5});
  // Heading east at 12 m/s of air ahead, drifting 5 m/s to the north: 13.
  CHECK(read("time_s,yaw_deg,vn_m_s,ve_m_s,airspeed_forward_m_s,bus_power_W\n1,90,5,7,12,450\n")
            .log.airspeed.front() == Approx(13));
  const PowerLogReading ground = read("time_s,vn_m_s,ve_m_s,bus_power_W\n1,3,-4,450\n");
  CHECK(ground.log.airspeed == std::vector<double>{5});
  REQUIRE(ground.notes.size() == 1);
  CHECK_THAT(ground.notes.front().sentence, Catch::Contains("ground speed is taken as airspeed"));
  CHECK_THROWS_WITH(read("time_s,bus_power_W\n1,450\n"),
                    Catch::Contains("column \"airspeed_m_s\" is missing"));
}

TEST_CASE("an attitude may be a quaternion") {
  const std::string header =
      "time_s,quaternion_w,quaternion_x,quaternion_y,quaternion_z,vn_m_s,ve_m_s,vd_m_s\n";
  const auto row = [](int time, double w, double x, double y, double z) {
    return fmt::format("{},{:.15g},{:.15g},{:.15g},{:.15g},1,2,3\n", time, w, x, y, z);
  };
  // Half of each angle, about one axis each; the last is a yaw of 90° after a pitch of 40°.
  const double c = std::cos(20 * unit::degree);
  const double s = std::sin(20 * unit::degree);
  const double r = std::sqrt(0.5);
  const FlightLog log =
      parse_flight_log(bytes_of(header + row(0, c, s, 0, 0) + row(1, c, 0, s, 0) +
                                row(2, c, 0, 0, s) + row(3, r * c, -r * s, r * s, r * c)),
                       "log.csv")
          .log;
  const std::vector<std::array<double, 3>> degrees{{40, 0, 0}, {0, 40, 0}, {0, 0, 40}, {0, 40, 90}};
  for (std::size_t i = 0; i < degrees.size(); ++i) {
    INFO(i);
    CHECK(log.roll[i] == Approx(degrees[i][0] * unit::degree).margin(1e-12));
    CHECK(log.pitch[i] == Approx(degrees[i][1] * unit::degree).margin(1e-12));
    CHECK(log.yaw[i] == Approx(degrees[i][2] * unit::degree).margin(1e-12));
  }
  CHECK(flight_problems(header + "0,1,0,0,0,1,2,3\n1,0,0,0,0,1,2,3\n") ==
        "flight.csv:3: the quaternion's length is 0, expected 1");
  CHECK_THAT(flight_problems("time_s,quaternion_w,vn_m_s,ve_m_s,vd_m_s\n0,1,1,2,3\n"),
             Catch::Contains("column \"quaternion_x\" is missing"));
  CHECK_THAT(flight_problems("yaw_deg," + header + "0,1,0,0,0,1,2,3,4\n"),
             Catch::Contains("go without yaw_deg"));
}

TEST_CASE("a velocity may be along the drone's own axes") {
  const std::string header =
      "time_s,roll_deg,pitch_deg,yaw_deg,body_forward_m_s,body_right_m_s,body_down_m_s\n";
  const FlightLog log = parse_flight_log(bytes_of(header +
                                                  // ahead to the north-east, level
                                                  "0,0,0,45,2,0,0\n"
                                                  // nose up to the east: forward is up, too
                                                  "1,0,30,90,2,0,0\n"
                                                  // on its right side: right is down, down is west
                                                  "2,90,0,0,0,3,1\n"),
                                         "log.csv")
                            .log;
  const double root = std::sqrt(2.0);
  CHECK(log.north_velocity[0] == Approx(root));
  CHECK(log.east_velocity[0] == Approx(root));
  CHECK(log.down_velocity[0] == Approx(0).margin(1e-12));
  CHECK(log.north_velocity[1] == Approx(0).margin(1e-12));
  CHECK(log.east_velocity[1] == Approx(std::sqrt(3.0)));
  CHECK(log.down_velocity[1] == Approx(-1));
  CHECK(log.north_velocity[2] == Approx(0).margin(1e-12));
  CHECK(log.east_velocity[2] == Approx(-1));
  CHECK(log.down_velocity[2] == Approx(3));
}

TEST_CASE("an airspeed with the direction that the air comes from is a measured wind") {
  const std::string header =
      flight_header.substr(0, flight_header.size() - 1) + ",airspeed_m_s,air_from_deg\n";
  // To the north at 4 m/s with 5 m/s of air from the east: it moves 4 to the north, 5 to the west.
  const FlightLog log = parse_flight_log(bytes_of(header + "0,0,0,0,4,0,0,5,90\n"), "log.csv").log;
  CHECK(log.north_wind.front() == Approx(4));
  CHECK(log.east_wind.front() == Approx(-5));
  const std::string both =
      header.substr(0, header.size() - 1) + ",airspeed_forward_m_s\n0,0,0,0,1,2,3,4,5,6\n";
  CHECK_THAT(flight_problems(both),
             Catch::Contains("airspeed_forward_m_s and air_from_deg go without each other"));
}

TEST_CASE("columns of other names and units are read by what --columns says of them") {
  const std::string text = "t,yaw_deg,psi,v,climb,amp,remark\n0,7,0.5,36,2,150,a\n";
  const std::vector<std::string> columns{"time_ms=t",     "yaw_rad = psi", "vn_km_h=v",
                                         "vd_m_s=-climb", "ve_m_s=amp",    "pitch_deg=yaw_deg"};
  const FlightLogReading reading = parse_flight_log(
      bytes_of(text), "log.csv", {.level_where_missing = true, .columns = columns});
  CHECK(reading.log.time.front() == 0);
  CHECK(reading.log.yaw.front() == Approx(0.5));
  CHECK(reading.log.pitch.front() == Approx(7 * unit::degree));  // not a heading any more
  CHECK(reading.log.north_velocity.front() == Approx(10));
  CHECK(reading.log.down_velocity.front() == -2);
  REQUIRE(reading.notes.size() == 2);
  CHECK(reading.notes.front().sentence == "not used: the columns remark");

  const PowerLog power =
      parse_power_log(bytes_of("ms,knots,mA,U,F\n1500,10,2000,12,50\n"), "log.csv",
                      {.free_flight = true,
                       .columns = {"time_ms=ms", "airspeed_kn=knots", "bus_current_mA=mA",
                                   "bus_voltage_V=U", "ambient_temperature_F=F"}})
          .log;
  CHECK(power.time.front() == Approx(1.5));
  CHECK(power.airspeed.front() == Approx(5.14444).epsilon(1e-5));
  CHECK(bus_power_of(power).front() == Approx(24));
  CHECK(power.ambient_temperature_C.front() == Approx(10));
}

TEST_CASE("all that is wrong with --columns is told at once, with the closest name") {
  const auto problems = [](const std::vector<std::string>& columns) -> std::string {
    try {
      (void)parse_power_log(bytes_of("t,speed,p\n0,1,2\n"), "log.csv",
                            {.free_flight = true, .columns = columns});
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK(problems({"time_s=t", "airspeed_m_s=speed", "bus_power_W=p"}) == "accepted");
  const std::string all = problems({"time_s=tt", "airsped_m_s=speed", "airspeed_kg=speed", "p"});
  CHECK_THAT(all, Catch::Contains("log.csv:1: there is no column \"tt\" for time_s"));
  CHECK_THAT(all, Catch::Contains("--columns: \"airsped_m_s\" is no column of a log") &&
                      Catch::Contains("did you mean \"airspeed_m_s\"?"));
  CHECK_THAT(all, Catch::Contains("\"airspeed_kg\" has no unit of airspeed_m_s; allowed are "
                                  "airspeed_m_s, airspeed_km_h"));
  CHECK_THAT(all, Catch::Contains("\"p\" does not say what a column holds"));
  CHECK_THAT(problems({"time_s=t", "airspeed_m_s=speed", "airspeed_kn=p"}),
             Catch::Contains("airspeed_m_s is given twice"));
  CHECK_THAT(problems({"time_s=t", "airspeed_m_s=p", "bus_power_W=p"}),
             Catch::Contains("the column \"p\" is given twice"));
  CHECK_THAT(problems({"time_s=t", "bus_power_W=p"}),
             Catch::Contains("column \"airspeed_m_s\" is missing"));
  // Cells are told by both names.
  CHECK_THROWS_WITH(
      parse_power_log(
          bytes_of("t,speed,p\n0,1,x\n"), "log.csv",
          {.free_flight = true, .columns = {"time_s=t", "airspeed_m_s=speed", "bus_power_W=p"}}),
      "log.csv:2: bus_power_W (p) is \"x\", expected a number such as -1.25");
}

TEST_CASE("a file that is not there is refused with the system's reason") {
  CHECK_THROWS_WITH(read_power_log("/nowhere/power.csv"),
                    Catch::Contains("/nowhere/power.csv: cannot be opened: "));
  CHECK_THROWS_WITH(read_flight_log("/"), Catch::Contains("is a directory"));
}
