"""Logs as arrays, the published fit, and a diagnosis."""

import json
import math
import pathlib
import subprocess
import tempfile
import unittest
import warnings

import numpy as np
import tethercalc
from support import EXAMPLES, PUBLISHED, command, reference

FLIGHT = EXAMPLES / "simulated-flight.csv"


class Logs(unittest.TestCase):
    def test_messages_are_arrays_with_the_numbers_of_the_commands_csv(self):
        path = EXAMPLES / "px4-flight.ulg"
        log = tethercalc.read_log(path)
        self.assertIn("vehicle_attitude", log)
        told = command("log", path, "--csv", "vehicle_local_position").splitlines()
        columns = told[0].split(",")
        rows = [line.split(",") for line in told[1:]]
        message = log["vehicle_local_position"]
        tried = 0
        for name, array in message.items():
            if name not in columns:
                continue
            place = columns.index(name)
            expected = np.array([float(row[place]) if row[place] else np.nan for row in rows])
            # The text of a float has the digits that tell it from other floats.
            np.testing.assert_allclose(array, expected, rtol=1e-7, err_msg=name)
            tried += 1
        self.assertEqual(tried, len(columns))
        self.assertTrue(np.all(np.diff(message["time_s"]) > 0))
        self.assertFalse(message["time_s"].flags.owndata)
        self.assertEqual(str(log), command("log", path))

    def test_an_unknown_message_is_refused_with_the_closest(self):
        log = tethercalc.read_log(EXAMPLES / "px4-flight.ulg")
        with self.assertRaises(tethercalc.InputError) as caught:
            log["vehicle_attitde"]
        self.assertIn("vehicle_attitude", str(caught.exception))


class Drag(unittest.TestCase):
    def test_the_published_fit_on_the_published_flight(self):
        # Beffert and Zell 2025, section V-B: value and error in percent, as printed.
        fit = tethercalc.drag(
            reference("x500-flight.csv"),
            1549,
            air_density_kg_m3=1.293,
            pitch_offset_deg=1.4955439766569403,
            start="25%",
            end="90%",
            published_kinematics=True,
        )
        for estimate, value, percent in (
            (fit.front_area_m2, "1.492e-02", "3.07"),
            (fit.top_area_m2, "1.368e-02", "3.18"),
            (fit.linear_m_s, "1.943e+01", "4.35"),
            (fit.wind_m_s[0], "-1.196e+00", "1.61"),
        ):
            self.assertEqual(f"{estimate.value:.3e}", value)
            share = 100 * estimate.standard_error_independent / abs(estimate.value)
            self.assertEqual(f"{share:.2f}", percent)
        self.assertEqual(fit.samples, 3396)
        self.assertEqual(fit.figures, ["speed", "surface"])
        self.assertIn("</svg>", fit._repr_html_())

    def test_the_answer_is_the_commands(self):
        fit = tethercalc.drag(FLIGHT, 1550, air_density_kg_m3=1.225, pitch_offset_deg=0.8)
        words = ["drag", FLIGHT, "--mass-g", 1550, "--air-density", 1.225, "--pitch-offset-deg", 0.8]
        self.assertEqual(str(fit), command(*words))
        self.assertEqual(fit.to_dict(), json.loads(command(*words, "--format", "json")))

    def test_air_by_the_weather_and_the_offset_of_a_hover_flight_are_the_commands(self):
        with tempfile.TemporaryDirectory() as folder:
            hover = pathlib.Path(folder) / "hover.csv"
            rows = ["time_s,roll_deg,pitch_deg,yaw_deg,vn_m_s,ve_m_s,vd_m_s"]
            for k in range(600):
                sway = math.sin(k / 9)
                rows.append(f"{k / 10},{sway},{1.2 + sway},{sway},{sway / 9},{sway / 8},{sway / 7}")
            hover.write_text("\n".join(rows) + "\n")
            fit = tethercalc.drag(FLIGHT, 1550, pressure_hPa=985, temperature_C=12, trim_log=hover)
            words = ["--pressure-hPa", 985, "--temperature-C", 12, "--trim-log", hover]
            self.assertEqual(str(fit), command("drag", FLIGHT, "--mass-g", 1550, *words))
        level = tethercalc.drag(
            FLIGHT, 1550, pressure_hPa=985, temperature_C=12, pitch_offset_deg=0
        )
        self.assertNotEqual(fit.front_area_m2.value, level.front_area_m2.value)

    def test_what_is_assumed_is_warned_of_where_it_is_called(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            tethercalc.drag(FLIGHT, 1550)
        self.assertEqual([one.filename for one in caught], [__file__, __file__])
        self.assertIn("1.293 kg/m³ taken (air_density_kg_m3,", str(caught[0].message))
        self.assertIn("(trim_log or pitch_offset_deg)", str(caught[1].message))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            tethercalc.drag(FLIGHT, 1550, air_density_kg_m3=1.2, pitch_offset_deg=0)
            with self.assertRaises(UserWarning):
                tethercalc.drag(FLIGHT, 1550)

    def test_bad_arguments_are_told_by_their_names(self):
        for where, arguments in (
            ("mass_g", {"mass_g": -3}),
            ("start", {"start": "a quarter"}),
            ("end", {"end": "a quarter"}),
            ("pitch_offset_deg", {"pitch_offset_deg": 46}),
            ("air_density_kg_m3", {"air_density_kg_m3": 12}),
            ("pressure_hPa", {"pressure_hPa": 1013}),
            ("trim_log", {"trim_log": FLIGHT, "pitch_offset_deg": 1}),
        ):
            with self.assertRaises(tethercalc.InputError) as caught:
                tethercalc.drag(FLIGHT, **{"mass_g": 1550, **arguments})
            self.assertEqual(caught.exception.problems[0].where, where)
            self.assertNotIn("--", str(caught.exception))
        with self.assertRaises(AttributeError) as missing:
            tethercalc.drag(FLIGHT, 1550, air_density_kg_m3=1.2, pitch_offset_deg=0).front_area
        self.assertIn("front_area_m2", str(missing.exception))


class Diagnosis(unittest.TestCase):
    def test_a_flight_shows_the_commands_findings_and_extends_the_design(self):
        told = tethercalc.diagnose(PUBLISHED, flight=FLIGHT, mass_g=1550, air_density_kg_m3=1.225)
        words = ["diagnose", PUBLISHED, "--flight", FLIGHT, "--mass-g", 1550, "--air-density", 1.225]
        self.assertEqual(told.to_dict(), json.loads(command(*words, "--format", "json")))
        self.assertEqual(str(told), command(*words))
        self.assertTrue(told.findings)
        self.assertTrue(told.findings[0].effect)
        extended = tethercalc.Design(told.to_dict()["extended"]["spec"])
        self.assertTrue(tethercalc.optimize(extended).feasible)
        self.assertIn("</svg>", told._repr_html_())

    def test_a_power_log_shows_the_commands_findings(self):
        power = EXAMPLES / "simulated-power.csv"
        given = tethercalc.load(PUBLISHED, set={"tether.cross_section_mm2": 1.09})
        told = tethercalc.diagnose(given, power=power)
        words = ["diagnose", PUBLISHED, "--set", "tether.cross_section_mm2=1.09", "--power", power]
        self.assertEqual(told.to_dict(), json.loads(command(*words, "--format", "json")))

    def test_several_flights_are_told_apart_as_the_command_does(self):
        other = EXAMPLES / "px4-flight.ulg"
        flights = [FLIGHT, other]
        told = tethercalc.diagnose(PUBLISHED, flight=flights, start="5%", end="95%")
        words = ["diagnose", PUBLISHED, "--flight", FLIGHT, "--flight", other]
        words += ["--from", "5%", "--to", "95%"]
        self.assertEqual(str(told), command(*words))
        self.assertIn(f"flight 2 is {other}", " ".join(str(told).split()))
        self.assertEqual(told.to_csv(), command(*words, "--format", "csv"))

    def test_an_effect_of_two_files_is_refused_as_by_the_command(self):
        effects = [EXAMPLES / "effects" / "braking-wake.json"] * 2
        with self.assertRaises(tethercalc.InputError) as caught:
            tethercalc.diagnose(PUBLISHED, flight=FLIGHT, effects=effects)
        words = [word for effect in effects for word in ("--effects", effect)]
        with self.assertRaises(subprocess.CalledProcessError) as refused:
            command("diagnose", PUBLISHED, "--flight", FLIGHT, *words)
        self.assertEqual(refused.exception.returncode, 2)
        self.assertIn("is an effect of another file, too", str(caught.exception))
        self.assertIn(str(caught.exception), refused.exception.stderr)

    def test_what_is_of_the_power_needs_a_log_of_it(self):
        for arguments, where in (
            ({"free_flight": True}, "free_flight"),
            ({"batteries": [0]}, "batteries"),
            ({"log": FLIGHT}, "log"),
        ):
            with self.assertRaises(tethercalc.InputError) as caught:
                tethercalc.diagnose(PUBLISHED, flight=FLIGHT, **arguments)
            self.assertEqual(caught.exception.problems[0].where, where)

    def test_an_unknown_effect_or_no_log_is_refused(self):
        with self.assertRaises(tethercalc.InputError) as caught:
            tethercalc.diagnose(PUBLISHED, flight=FLIGHT, base="linear_drga")
        self.assertIn("linear_drag", str(caught.exception))
        with self.assertRaises(tethercalc.InputError):
            tethercalc.diagnose(PUBLISHED)


if __name__ == "__main__":
    unittest.main()
