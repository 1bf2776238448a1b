"""Logs as arrays, the published fit, and a diagnosis."""

import json
import unittest

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

    def test_bad_arguments_are_told_by_their_names(self):
        with self.assertRaises(tethercalc.InputError) as caught:
            tethercalc.drag(FLIGHT, -3)
        self.assertEqual(caught.exception.problems[0].where, "mass_g")
        with self.assertRaises(tethercalc.InputError):
            tethercalc.drag(FLIGHT, 1550, start="a quarter")
        with self.assertRaises(AttributeError) as missing:
            tethercalc.drag(FLIGHT, 1550).front_area
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

    def test_an_unknown_effect_or_no_log_is_refused(self):
        with self.assertRaises(tethercalc.InputError) as caught:
            tethercalc.diagnose(PUBLISHED, flight=FLIGHT, base="linear_drga")
        self.assertIn("linear_drag", str(caught.exception))
        with self.assertRaises(tethercalc.InputError):
            tethercalc.diagnose(PUBLISHED)


if __name__ == "__main__":
    unittest.main()
