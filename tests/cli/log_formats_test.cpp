// Logs of every kind through the real program: the same flight gives the same answer from each.
#include <zip.h>
#include <zlib.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "cli/published.hpp"
#include "files/log_file.hpp"
#include "support/dataflash_writer.hpp"
#include "support/flight_csv.hpp"
#include "support/run_program.hpp"
#include "support/ulog_writer.hpp"
#include "tethercalc/io/input_error.hpp"

using namespace tethercalc::test;
using Catch::Contains;
using nlohmann::json;

namespace {

const std::string example_flight = project_file("examples/simulated-flight.csv");

using Bytes = std::vector<std::byte>;

std::string text_of(const Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::uint64_t microseconds(double time) {
  return static_cast<std::uint64_t>(std::llround(time * 1e6));
}

/// The rotation of yaw, pitch and roll as PX4 logs it (w, x, y, z).
void add_attitude_of(ULogWriter& log, std::uint64_t time, double roll, double pitch, double yaw) {
  const double cr = std::cos(roll / 2), sr = std::sin(roll / 2);
  const double cp = std::cos(pitch / 2), sp = std::sin(pitch / 2);
  const double cy = std::cos(yaw / 2), sy = std::sin(yaw / 2);
  add_attitude(log, time, cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy,
               cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy);
}

/// The example flight as PX4 would log it: attitudes at the times of the velocities and, to be
/// interpolated between, one more before each.
ULogWriter example_as_ulog(bool attitudes_beside) {
  const tethercalc::FlightLog flight = read_flight_csv(example_flight);
  ULogWriter log;
  log.information("sys_name", "PX4");
  define_flight_topics(log);
  for (std::size_t i = 0; i < flight.time.size(); ++i) {
    const std::uint64_t time = microseconds(flight.time[i]);
    if (!attitudes_beside) {
      add_attitude_of(log, time, flight.roll[i], flight.pitch[i], flight.yaw[i]);
    } else if (i > 0) {
      // A fifth of the way from the sample before, and four fifths.
      for (const double share : {0.2, 0.8}) {
        const auto between = [&](const std::vector<double>& angle) {
          return angle[i - 1] + share * (angle[i] - angle[i - 1]);
        };
        const double before = flight.time[i - 1];
        add_attitude_of(log, microseconds(before + share * (flight.time[i] - before)),
                        between(flight.roll), between(flight.pitch), between(flight.yaw));
      }
    }
    add_local_position(log, time, flight.north_velocity[i], flight.east_velocity[i],
                       flight.down_velocity[i]);
  }
  return log;
}

/// The first four minutes of the example flight in PX4's format: what examples/px4-flight.ulg is.
std::string shipped_ulog() {
  const tethercalc::FlightLog flight = read_flight_csv(example_flight);
  ULogWriter log;
  log.information("sys_name", "simulated flight, not PX4");
  define_flight_topics(log);
  constexpr std::size_t four_minutes = 2400;
  for (std::size_t i = 0; i < four_minutes; ++i) {
    const std::uint64_t time = microseconds(flight.time[i]);
    add_attitude_of(log, time, flight.roll[i], flight.pitch[i], flight.yaw[i]);
    add_local_position(log, time, flight.north_velocity[i], flight.east_velocity[i],
                       flight.down_velocity[i]);
  }
  const auto& bytes = log.bytes();
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The example flight as a ground station writes a DataFlash log out.
std::string example_as_text() {
  const tethercalc::FlightLog flight = read_flight_csv(example_flight);
  std::ostringstream text;
  text.precision(12);
  text << "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\n"
       << "FMT, 64, 29, XKF1, QBccCfff, TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD\n"
       << "FMT, 65, 75, MSG, QZ, TimeUS,Message\n"
       << "FMT, 66, 14, MODE, QMB, TimeUS,Mode,Rsn\n"
       << "MSG, 1, ArduCopter V4.5.7, with a comma\n"
       << "MODE, 2, Stabilize, 0\n";
  constexpr double degree = 0.017453292519943295;
  for (std::size_t i = 0; i < flight.time.size(); ++i) {
    text << "XKF1, " << microseconds(flight.time[i]) << ", 0, " << flight.roll[i] / degree << ", "
         << flight.pitch[i] / degree << ", " << flight.yaw[i] / degree << ", "
         << flight.north_velocity[i] << ", " << flight.east_velocity[i] << ", "
         << flight.down_velocity[i] << "\n";
  }
  return text.str();
}

json drag_of(const std::string& log) {
  std::vector<std::string> command = {"drag", log, "--format", "json"};
  command.insert(command.end(), known.begin(), known.end());
  const Ran run = run_tethercalc(command);
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  return json::parse(run.out);
}

void check_same_drag(const json& a, const json& b, double tolerance) {
  for (const char* const key : {"front_area_m2", "top_area_m2", "linear_m_s"}) {
    CHECK(a.at(key).at("value").get<double>() ==
          Approx(b.at(key).at("value").get<double>()).epsilon(tolerance));
  }
  CHECK(a.at("samples") == b.at("samples"));
}

std::string gzipped(const std::string& text) {
  z_stream stream{};
  REQUIRE(deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY) == Z_OK);
  std::string packed(deflateBound(&stream, text.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

void write_zip(const std::string& path,
               const std::vector<std::pair<std::string, std::string>>& files) {
  zip_t* const archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr);
  REQUIRE(archive != nullptr);
  for (const auto& [name, text] : files) {
    zip_source_t* const source = zip_source_buffer(archive, text.data(), text.size(), 0);
    REQUIRE(zip_file_add(archive, name.c_str(), source, 0) >= 0);
  }
  REQUIRE(zip_close(archive) == 0);
}

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

}  // namespace

TEST_CASE("the ULog among the examples is the simulated flight of the CSV") {
  const std::filesystem::path path = project_file("examples/px4-flight.ulg");
  if (std::getenv("TETHERCALC_UPDATE") != nullptr) write_file(path, shipped_ulog());
  INFO("it differs; run this test with TETHERCALC_UPDATE=1 and commit the file");
  CHECK(file_text(path) == shipped_ulog());
}

TEST_CASE("a flight logged by PX4 gives the drag that its CSV gives") {
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "flight.ulg").string();
  write_file(log, text_of(example_as_ulog(false).bytes()));
  const json from_csv = drag_of(example_flight);
  // Quaternions and velocities are logged in single precision.
  check_same_drag(drag_of(log), from_csv, 1e-4);
  const std::string beside = (folder.path() / "beside.ulg").string();
  write_file(beside, text_of(example_as_ulog(true).bytes()));
  const json interpolated = drag_of(beside);
  CHECK(interpolated.at("front_area_m2").at("value").get<double>() ==
        Approx(from_csv.at("front_area_m2").at("value").get<double>()).epsilon(0.02));
}

TEST_CASE("diagnose says the same of a flight from ULog and from CSV") {
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "flight.ulg").string();
  write_file(log, text_of(example_as_ulog(false).bytes()));
  const auto findings = [](const std::string& flight) {
    const Ran run = run_tethercalc({"diagnose", published, "--flight", flight, "--mass-g", "1550",
                                    "--pitch-offset-deg", "0.8", "--format", "json"});
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    std::vector<std::string> ids;
    const json told = json::parse(run.out);
    for (const json& finding : told.at("findings")) ids.push_back(finding.at("effect"));
    return ids;
  };
  CHECK(findings(log) == findings(example_flight));
}

TEST_CASE("a DataFlash log as text gives the drag that its CSV gives, and tells its lines") {
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "flight.log").string();
  write_file(log, example_as_text());
  check_same_drag(drag_of(log), drag_of(example_flight), 1e-6);
  const json told = json::parse(run_tethercalc({"log", log, "--format", "json"}).out);
  CHECK(told.at("format") == "dataflash_text");
  CHECK(told.at("firmware") == "ArduCopter V4.5.7, with a comma");
  CHECK(told.at("skipped").at("bytes") == 0);
  CHECK(run_tethercalc({"log", log, "--csv", "MODE"}).out == "TimeUS,Mode,Rsn\n2,Stabilize,0\n");

  // Lines that are no messages, one with a value too few, and one that a cut left half.
  const std::string damaged = "Ground station 1.3\n" + example_as_text() +
                              "XKF1, 999, 0, 1, 1, 1, 1, 1\nXKF1, 1000, 0, 1, 1, 1, 1, 1, 12";
  write_file(log, damaged);
  const json skipped = json::parse(run_tethercalc({"log", log, "--format", "json"}).out);
  CHECK(skipped.at("skipped").at("messages") == 3);
  CHECK(skipped.at("skipped").at("stretches").at(0).at("offset") == 0);
  CHECK(skipped.at("types") == told.at("types"));
}

TEST_CASE("compressed logs are read as they are uncompressed") {
  const TemporaryFolder folder;
  const std::string text = text_of(example_as_ulog(false).bytes());
  const std::string plain = (folder.path() / "flight.ulg").string();
  write_file(plain, text);
  const auto told = [](const std::string& file) {
    json answer = json::parse(run_tethercalc({"log", file, "--format", "json"}).out);
    answer.erase("file");
    return answer;
  };
  const json expected = told(plain);
  const std::string gz = plain + ".gz";
  write_file(gz, gzipped(text));
  CHECK(told(gz) == expected);
  // Files put together are one.
  write_file(gz, gzipped(text.substr(0, 1000)) + gzipped(text.substr(1000)));
  CHECK(told(gz) == expected);
  const std::string zip = (folder.path() / "flight.zip").string();
  write_zip(zip, {{"flight.ulg", text}, {"__MACOSX/._flight.ulg", "nothing"}});
  CHECK(told(zip) == expected);
  const Ran packed = run_shell("xz -k " + shell_quoted(plain));
  REQUIRE(packed.exit_code == 0);
  CHECK(told(plain + ".xz") == expected);
  CHECK(drag_of(gz) == drag_of(plain));
}

TEST_CASE("compressed logs that are cut, several, or too much are refused") {
  const TemporaryFolder folder;
  const std::string text = text_of(example_as_ulog(false).bytes());
  const std::string gz = (folder.path() / "cut.gz").string();
  const std::string packed = gzipped(text);
  write_file(gz, packed.substr(0, packed.size() / 2));
  const std::string zip = (folder.path() / "two.zip").string();
  write_zip(zip, {{"a.ulg", text}, {"b.ulg", text}});
  for (const auto& [file, reason] : std::vector<std::pair<std::string, std::string>>{
           {gz, "is compressed by gzip, but damaged or cut"},
           {zip, "is a zip archive of 2 files (a.ulg, b.ulg)"}}) {
    const Ran run = run_tethercalc({"log", file});
    CHECK(run.exit_code == 2);
    CHECK(run.out.empty());
    CHECK_THAT(run.err, Contains(reason));
  }
  const std::string bomb = gzipped(std::string(10'000'000, '\0'));
  CHECK(bomb.size() < 20'000);
  CHECK(tethercalc::unpacked(bytes_of(bomb), "bomb.gz", 10'000'000)->size() == 10'000'000);
  CHECK_THROWS_WITH(tethercalc::unpacked(bytes_of(bomb), "bomb.gz", 9 << 20),
                    Contains("bomb.gz: unpacks to more than 9 MiB"));
  CHECK_FALSE(tethercalc::unpacked(bytes_of(text), "plain"));
}

TEST_CASE("what is no log is named by what it is") {
  const TemporaryFolder folder;
  std::string telemetry;
  for (int i = 0; i < 5; ++i) {
    // Time, then a MAVLink 2 packet with 4 bytes of payload.
    telemetry += std::string("\0\5\x12\x34\x56\x78\x9A\xBC", 8) +
                 std::string("\xFD\4\0\0\1\1\1\0\0\0pay!\1\2", 16);
  }
  std::mt19937_64 random(1);
  std::string noise(100'000, '\0');
  for (char& c : noise) c = static_cast<char>(random());
  for (const auto& [content, reason] : std::vector<std::pair<std::string, std::string>>{
           {telemetry, "is a MAVLink telemetry log (.tlog)"},
           {"H Product:Blackbox flight data recorder by Nicholas Sherlock\nH Data version:2\n",
            "is a Betaflight or INAV blackbox log"},
           {std::string("\0\0\0\x20", 4) + "ftypisom" + std::string(100, '\0'), "is a video"},
           {"RIFF1234AVI LIST" + std::string(100, '\0'), "is a video (AVI)"},
           {"\x1A\x45\xDF\xA3" + std::string(100, '\1'), "is a video (MKV or WebM)"},
           {"\xFF\xD8\xFF\xE0" + std::string(100, '\0'), "is a JPEG picture"},
           {std::string("\xFF\xFEt\0i\0m\0e\0", 10), "is UTF-16; save it as UTF-8"},
           {"<?xml version=\"1.0\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\">",
            "is a KML track"},
           {"{\"fileType\": \"Plan\"}", "is JSON"},
           {"Flew well today.\n", "is a text, but not one of an autopilot's log"},
           {noise, "is no log: no message of ArduPilot or PX4 was found in its 100000 bytes"},
           {"<" + noise, "is no log: no message of ArduPilot"},
           {"{" + noise, "is no log: no message of ArduPilot"}}) {
    const std::string file = (folder.path() / "file").string();
    write_file(file, content);
    const Ran run = run_tethercalc({"log", file});
    CAPTURE(reason);
    CHECK(run.exit_code == 2);
    CHECK(run.out.empty());
    CHECK_THAT(run.err, Contains(reason));
  }
}

TEST_CASE("a log of which no sample can be judged is refused, and log says so before") {
  const std::string log = project_file("fuzz/corpus/ulog/no-sample-can-be-judged");
  const Ran diagnosed =
      run_tethercalc({"diagnose", project_file("examples/holybro-x500.json"), "--flight", log});
  CHECK(diagnosed.exit_code == 2);
  CHECK_THAT(diagnosed.err, Contains("no sample of the flight can be judged"));
  CHECK_THAT(run_tethercalc({"log", log}).out,
             Contains("diagnose --flight: no, no sample of the flight can be judged"));
}

TEST_CASE("log tells vehicle, flights, battery, wind and what can be done with a PX4 log") {
  ULogWriter log = example_as_ulog(false);
  log.format(
      "vehicle_status:uint64_t timestamp;uint8_t vehicle_type;uint8_t system_type;bool is_vtol;");
  log.format("vehicle_land_detected:uint64_t timestamp;bool landed;");
  log.format("battery_status:uint64_t timestamp;float voltage_v;float current_a;");
  log.format("wind:uint64_t timestamp;float windspeed_north;float windspeed_east;");
  log.subscribe(10, "vehicle_status");
  log.subscribe(11, "vehicle_land_detected");
  log.subscribe(12, "battery_status");
  log.subscribe(13, "wind");
  const auto at = [](double time) { return ULogContent().put(microseconds(time)); };
  log.data(10, at(505).put(std::uint8_t{1}).put(std::uint8_t{13}).put(false));
  for (const auto& [time, landed] :
       {std::pair{505.0, true}, {510.0, false}, {520.0, true}, {530.0, false}, {545.0, true}}) {
    log.data(11, at(time).put(landed));
  }
  for (int i = 0; i <= 36; ++i) log.data(12, at(510 + i).put(20.0F).put(5.0F));
  log.data(13, at(546).put(0.0F).put(-3.0F));  // it blows to the west
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "flight.ulg").string();
  write_file(file, text_of(log.bytes()));
  const json told = json::parse(run_tethercalc({"log", file, "--format", "json"}).out);
  CHECK(told.at("format") == "ulog");
  CHECK(told.at("vehicle") == "a multirotor (hexarotor)");
  REQUIRE(told.at("flying").at("flights").size() == 2);
  CHECK(told.at("flying").at("flights")[1].at("start_s") == 530);
  CHECK(told.at("flying").at("duration_s") == 25);
  CHECK(told.at("batteries")[0].at("energy_Wh").get<double>() == Approx(20 * 5 * 36 / 3600.0));
  CHECK(told.at("wind").at("speed_m_s") == 3);
  CHECK(told.at("wind").at("from_deg").get<double>() == Approx(90));
  CHECK(told.at("uses")[0].at("possible") == true);
  const Ran text = run_tethercalc({"log", file});
  CHECK_THAT(text.out, Contains("format     PX4 ULog") &&
                           Contains("flight 2: 530.0 s to 545.0 s") && Contains("mean 5.00 A") &&
                           Contains("3.0 m/s from 90°") &&
                           Contains("drag: yes, vehicle_local_position and vehicle_attitude"));

  std::vector<std::string> command = {"drag", file};
  command.insert(command.end(), known.begin(), known.end());
  CHECK_THAT(run_tethercalc(command).err, Contains("the estimator's guess, no measurement"));
}

TEST_CASE("a PX4 log of something else than a multirotor is refused by what it is") {
  ULogWriter log = example_as_ulog(false);
  log.format("vehicle_status:uint64_t timestamp;uint8_t vehicle_type;");
  log.subscribe(10, "vehicle_status");
  log.data(10, ULogContent().put(std::uint64_t{5'000'000}).put(std::uint8_t{2}));
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "plane.ulg").string();
  write_file(file, text_of(log.bytes()));
  std::vector<std::string> command = {"drag", file};
  command.insert(command.end(), known.begin(), known.end());
  const Ran run = run_tethercalc(command);
  CHECK(run.exit_code == 2);
  CHECK_THAT(run.err, Contains("PX4, an aeroplane"));
}
