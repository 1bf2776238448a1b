"""Designs: read, changed in place, optimised; and every problem of a bad one."""

import inspect
import json
import pickle
import re
import unittest

import tethercalc
from support import EXAMPLES, PUBLISHED, command, reference


class Reading(unittest.TestCase):
    def test_a_file_a_dictionary_and_a_design_are_the_same_design(self):
        from_file = tethercalc.load(PUBLISHED)
        from_dictionary = tethercalc.Design(json.loads(PUBLISHED.read_text()))
        self.assertEqual(from_file.to_dict(), from_dictionary.to_dict())
        areas = {
            tethercalc.optimize(spec).cross_section_mm2
            for spec in (PUBLISHED, str(PUBLISHED), from_file, from_file.to_dict())
        }
        self.assertEqual(len(areas), 1)

    def test_every_numeric_field_set_in_place_is_the_field_in_the_text(self):
        tried = 0
        base = tethercalc.load(EXAMPLES / "hexacopter-400v.json")
        for field in tethercalc.fields():
            path = field["path"]
            value = base[path]
            if not isinstance(value, float) or value == 0:
                continue
            changed = base.copy()
            changed[path] = 1.01 * value
            again = tethercalc.Design(changed.to_dict())
            self.assertAlmostEqual(again[path], 1.01 * value, places=9, msg=path)
            self.assertEqual(base[path], value, path)
            self.assertEqual(
                tethercalc.optimize(changed).to_dict(), tethercalc.optimize(again).to_dict(), path
            )
            tried += 1
        self.assertGreater(tried, 15)

    def test_words_motors_and_unset_fields_are_read_and_set(self):
        design = tethercalc.load(PUBLISHED)
        design["requirements.power_at"] = "hover"
        self.assertEqual(design["requirements.power_at"], "hover")
        design["drone.motor"] = "tmotor-mn2806-650kv-13in"
        self.assertEqual(design.to_dict()["drone"]["motor"], "tmotor-mn2806-650kv-13in")
        self.assertIsNone(design["tether.cross_section_mm2"])
        design["tether.cross_section_mm2"] = 1.5
        self.assertEqual(design["tether.cross_section_mm2"], 1.5)
        design["tether.cross_section_mm2"] = None
        self.assertIsNone(design["tether.cross_section_mm2"])

    def test_an_optimum_stays_what_it_was_when_its_design_changes(self):
        design = tethercalc.load(PUBLISHED)
        optimum = tethercalc.optimize(design)
        design["supply.voltage_V"] = 60
        self.assertEqual(optimum.to_dict(), json.loads(command("optimize", PUBLISHED, "--format", "json")))


class Optimum(unittest.TestCase):
    def test_the_published_result(self):
        # Beffert and Zell 2025, section V-A.
        optimum = tethercalc.optimize(PUBLISHED)
        self.assertEqual(round(optimum.cross_section_mm2, 4), 1.0886)
        self.assertEqual(round(optimum.hover.tether_mass_g, 1), 546.9)
        self.assertEqual(round(optimum.hover.total_power_W, 1), 405.4)
        self.assertEqual(round(optimum.forward.total_power_W, 1), 444.9)

    def test_text_json_and_csv_are_the_commands(self):
        optimum = tethercalc.optimize(PUBLISHED)
        self.assertEqual(str(optimum), command("optimize", PUBLISHED))
        self.assertEqual(optimum.to_csv(), command("optimize", PUBLISHED, "--format", "csv"))

    def test_an_infeasible_design_has_no_optimum_and_says_why(self):
        design = tethercalc.load(PUBLISHED, set={"requirements.thrust_headroom": 4})
        optimum = tethercalc.optimize(design)
        self.assertFalse(optimum.feasible)
        self.assertIsNone(optimum.cross_section_mm2)
        self.assertIsNone(optimum.hover)
        self.assertEqual(optimum.limited_by, "motor_thrust")
        self.assertIn("motor", str(optimum))

    def test_the_60_designs_of_the_published_implementation(self):
        text = reference("golden/reference-designs.json").read_text()
        golden = json.loads(text)  # knows NaN, unlike strict readers
        self.assertEqual(len(golden["cases"]), 60)
        compared = 0
        for case in golden["cases"]:
            design = tethercalc.Design(spec_of(case["inputs"], golden["motors"]))
            for condition in ("hover", "forward"):
                # Their tilt comes out of a root finder, to about 1e-8.
                tolerance = 1e-9 if condition == "hover" else 1e-6
                points = case[condition]["points"]
                told = tethercalc.evaluate(design, [point["area_mm2"] for point in points])
                for point, row in zip(points, told.table):
                    for theirs, ours in GOLDEN_KEYS.items():
                        expected, value = point[theirs], row[condition][ours]
                        with self.subTest(case["id"], condition=condition, key=ours):
                            if expected is None or expected != expected:
                                self.assertIsNone(value)
                            else:
                                self.assertAlmostEqual(
                                    value, expected, delta=max(tolerance * abs(expected), 1e-12)
                                )
                        compared += 1
                self.compare_least_power(case, condition, design)
        self.assertGreater(compared, 1000)

    def compare_least_power(self, case, condition, design):
        """Where the published search was not cut off, the least power is the published one."""
        expected, area = case[condition]["min_power_W"], case[condition]["min_power_area_mm2"]
        if expected is None or expected != expected or area >= case["search_upper_mm2"] * (1 - 1e-6):
            return
        design["requirements.power_at"] = condition
        least = tethercalc.optimize(design).to_dict()["minimum_power"]
        self.assertAlmostEqual(least["total_power_W"] / expected, 1, places=6, msg=case["id"])


#: Keys of the reference data, and ours.
GOLDEN_KEYS = {
    "tether_resistance_ohm": "tether_resistance_ohm",
    "tether_mass_g": "tether_mass_g",
    "pitch_deg": "pitch_deg",
    "available_power_W": "available_power_W",
    "available_thrust_per_motor_g": "available_thrust_g",
    "necessary_thrust_per_motor_g": "necessary_thrust_g",
    "drone_power_W": "drone_power_W",
    "total_power_W": "total_power_W",
}


def spec_of(inputs, motors):
    """A reference design as a spec; materials are those of the paper's Table I."""
    sheet = motors[inputs["motor"]]
    points = [
        {"thrust_g": sheet[throttle][0], "efficiency_g_per_W": sheet[throttle][1]}
        for throttle in sorted((t for t in sheet if t != "name"), key=int)
    ]
    copper = inputs["conductor"] == "copper"
    return {
        "drone": {
            "mass_g": inputs["drone_mass_g"],
            "motor_count": inputs["motor_count"],
            "motor": {"name": "of the data sheet", "source": "reference", "points": points},
            "auxiliary_power_W": inputs["payload_power_W"],
            "drag": {
                "front_area_m2": inputs["drag_front_area_m2"],
                "top_area_m2": inputs["drag_top_area_m2"],
                "linear_m_s": inputs["drag_linear_m_s"],
            },
        },
        "tether": {
            "length_m": inputs["tether_length_m"],
            "conductor": {
                "name": "of Table I",
                "source": "reference",
                "resistivity_20C_ohm_mm2_per_m": 0.0178 if copper else 0.0278,
                "temperature_coefficient_per_K": 0,
                "density_g_cm3": 8.9 if copper else 2.7,
            },
            "insulation": {
                "material": {
                    "name": "reference",
                    "source": "reference",
                    "density_g_cm3": inputs["insulation_density_g_cm3"],
                },
                "thickness_mm": inputs["insulation_thickness_mm"],
            },
        },
        "supply": {
            "voltage_V": inputs["supply_voltage_V"],
            "converter": {
                "efficiency": inputs["converter_efficiency"],
                "min_input_voltage_V": inputs["converter_min_input_voltage_V"],
            },
        },
        "flight": {
            "airspeed_m_s": inputs["airspeed_m_s"],
            "air_density_kg_m3": inputs["air_density_kg_m3"],
            "gravity_m_s2": inputs["gravity_m_s2"],
        },
        "requirements": {"thrust_headroom": inputs["thrust_headroom"]},
    }


class Errors(unittest.TestCase):
    def test_every_problem_of_a_dictionary_comes_at_once_with_its_pointer(self):
        spec = json.loads(PUBLISHED.read_text())
        spec["drone"]["mass_g"] = 0.1
        spec["drone"]["motr_count"] = 4
        with self.assertRaises(tethercalc.InputError) as caught:
            tethercalc.optimize(spec)
        problems = caught.exception.problems
        self.assertEqual(
            {problem.pointer for problem in problems}, {"/drone/mass_g", "/drone/motr_count"}
        )
        self.assertTrue(all(problem.message in str(caught.exception) for problem in problems))
        self.assertIn("motor_count", str(caught.exception))

    def test_a_files_problems_have_its_name_and_lines(self):
        with self.assertRaises(tethercalc.InputError) as caught:
            tethercalc.load(ROOT_OF_NOTHING)
        self.assertEqual(len(caught.exception.problems), 1)
        import tempfile

        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            file.write(PUBLISHED.read_text().replace('"mass_g": 1710', '"mass_g": -1'))
            file.flush()
            with self.assertRaises(tethercalc.InputError) as caught:
                tethercalc.load(file.name)
            problem = caught.exception.problems[0]
            self.assertEqual((problem.file, problem.pointer), (file.name, "/drone/mass_g"))
            line = PUBLISHED.read_text().splitlines()[problem.line - 1]
            self.assertIn("mass_g", line)

    def test_a_bad_field_or_value_is_refused_and_changes_nothing(self):
        design = tethercalc.load(PUBLISHED)
        before = design.to_dict()
        for path, value in (
            ("drone.mass", 1),
            ("drone.mass_g", -1),
            ("drone.mass_g", float("nan")),
            ("drone.mass_g", "heavy"),
            ("drone.motor_count", 4.5),
            ("drone.motor", "no such motor"),
        ):
            with self.subTest(path=path, value=value), self.assertRaises(tethercalc.InputError):
                design[path] = value
        self.assertEqual(design.to_dict(), before)

    def test_fields_in_conflict_are_told_when_something_is_computed(self):
        design = tethercalc.load(PUBLISHED)
        design["supply.voltage_V"] = 15
        with self.assertRaises(tethercalc.InputError) as caught:
            tethercalc.optimize(design)
        self.assertIn("cuts off", str(caught.exception))
        design["supply.voltage_V"] = 75
        self.assertTrue(tethercalc.optimize(design).feasible)

    def test_an_error_survives_pickling(self):
        with self.assertRaises(tethercalc.InputError) as caught:
            tethercalc.Design({})
        again = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual(again.problems, caught.exception.problems)


ROOT_OF_NOTHING = "/nowhere/at-all.json"


def keys_in(value):
    """All keys of an answer, however deep."""
    if isinstance(value, list):
        return {key for entry in value for key in keys_in(entry)}
    if isinstance(value, dict):
        return set(value).union(*map(keys_in, value.values()))
    return set()


class Studies(unittest.TestCase):
    def test_each_answer_is_the_commands(self):
        area = ["--set", "tether.cross_section_mm2=1.09"]
        given = tethercalc.load(PUBLISHED, set={"tether.cross_section_mm2": 1.09})
        asked = [
            (tethercalc.evaluate(PUBLISHED, ["AWG18", 1.5]), ["evaluate", PUBLISHED, "--area-mm2", "AWG18,1.5"]),
            (tethercalc.compare(PUBLISHED, "alike"), ["compare", PUBLISHED, "--motors", "alike"]),
            (tethercalc.envelope(given), ["envelope", PUBLISHED, *area]),
            (tethercalc.rules(PUBLISHED, "us"), ["rules", PUBLISHED, "--rules", "us"]),
            (tethercalc.shape(given, wind_m_s=8), ["shape", PUBLISHED, "--wind", 8, *area]),
            (
                tethercalc.design(PUBLISHED, {"supply.voltage_V": "40..100"}),
                ["design", PUBLISHED, "--free", "supply.voltage_V=40..100"],
            ),
        ]
        for answer, words in asked:
            with self.subTest(words[0]):
                self.assertEqual(str(answer), command(*words))
                told = json.loads(command(*words, "--format", "json"))
                self.assertEqual(answer.to_dict(), told)
                self.assertEqual(dir(answer) + list(told), dir(answer) + list(answer.to_dict()))
                self.assertIn("<pre>", answer._repr_html_())

    def test_docstrings_name_only_parameters_and_keys_that_there_are(self):
        flight = EXAMPLES / "simulated-flight.csv"
        answers = {
            tethercalc.evaluate: tethercalc.evaluate(PUBLISHED, 1.1),
            tethercalc.compare: tethercalc.compare(PUBLISHED, "alike"),
            tethercalc.envelope: tethercalc.envelope(PUBLISHED, 1.1),
            tethercalc.shape: tethercalc.shape(PUBLISHED, area_mm2=1.1),
            tethercalc.rules: tethercalc.rules(PUBLISHED, "eu-c3"),
            tethercalc.design: tethercalc.design(PUBLISHED, {"supply.voltage_V": "70..75"}),
            tethercalc.drag: tethercalc.drag(
                flight, 1550, air_density_kg_m3=1.225, pitch_offset_deg=0.8
            ),
            tethercalc.diagnose: tethercalc.diagnose(PUBLISHED, flight=flight, mass_g=1550),
        }
        for function, answer in answers.items():
            known = keys_in(answer.to_dict()) | set(inspect.signature(function).parameters)
            known |= set(tethercalc.__all__)
            names = re.findall(r"`([A-Za-z_.0-9]+)`", function.__doc__)
            self.assertGreater(len(names), 3, function.__name__)
            for name in names:
                with self.subTest(f"{function.__name__}: {name}"):
                    self.assertTrue(set(name.split(".")) <= known)
        columns = tethercalc.sweep(PUBLISHED, {"drone.mass_g": [1500]}).array.dtype.names
        for name in ("status", "limited_by", "cross_section_mm2", "forward.total_power_W"):
            self.assertIn(name, tethercalc.sweep.__doc__)
            self.assertIn(name, columns)

    def test_a_code_is_explained_as_by_the_command(self):
        self.assertEqual(tethercalc.explain("propwash"), command("explain", "propwash"))
        self.assertEqual(tethercalc.explain(), command("explain"))
        for finding in tethercalc.diagnose(
            PUBLISHED, flight=EXAMPLES / "simulated-flight.csv", mass_g=1550
        ).findings:
            self.assertIn(finding.title, tethercalc.explain(finding.effect))
        with self.assertRaises(tethercalc.InputError) as caught:
            tethercalc.explain("propwosh")
        self.assertIn("propwash", str(caught.exception))

    def test_a_figure_is_the_plot(self):
        svg = tethercalc.optimize(PUBLISHED).figure().svg
        self.assertTrue(svg.startswith("<svg") or svg.startswith("<?xml"), svg[:40])
        self.assertIn("</svg>", svg)
        with self.assertRaises(KeyError):
            tethercalc.optimize(PUBLISHED).figure("nothing")


if __name__ == "__main__":
    unittest.main()
