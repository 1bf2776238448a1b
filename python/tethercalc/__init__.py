"""Design calculator for drones powered through a tether.

    >>> import tethercalc
    >>> design = tethercalc.load("examples/holybro-x500.json")
    >>> design["supply.voltage_V"] = 60
    >>> optimum = tethercalc.optimize(design)
    >>> optimum.cross_section_mm2

Wherever a design is asked for, a Design, a spec as a dictionary, or the path of a spec's file will
do. Fields and numbers bear their units in their names, as in specs and in the program's JSON.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence

from . import _core
from ._core import (
    Answer,
    Design,
    Figure,
    Log,
    OperatingPoint,
    Optimum,
    Sweep,
    explain,
    fields,
    load,
    optimize,
    read_log,
)
from ._core import version as __version__
from ._errors import InputError, Problem
from ._types import Area, Areas, Path, Paths, Spec, Texts, Varied

__all__ = [
    "Answer",
    "Design",
    "Figure",
    "InputError",
    "Log",
    "OperatingPoint",
    "Optimum",
    "Problem",
    "Sweep",
    "compare",
    "design",
    "diagnose",
    "drag",
    "envelope",
    "evaluate",
    "explain",
    "fields",
    "load",
    "optimize",
    "read_log",
    "rules",
    "shape",
    "sweep",
]


def _word(value: object) -> str:
    """A value as the grammar PATH=VALUES writes it."""
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(float(value))  # type: ignore[arg-type]


def _texts(values: Texts | None) -> list[str]:
    if values is None:
        return []
    return [values] if isinstance(values, str) else list(values)


def _areas(areas: Areas) -> list[str]:
    if areas is None:
        return []
    several = areas if isinstance(areas, Iterable) and not isinstance(areas, str) else [areas]
    return [_word(area) for area in several]


def _paths(paths: Paths | None) -> list[str]:
    if paths is None:
        return []
    several = [paths] if isinstance(paths, (str, os.PathLike)) else paths
    return [os.fspath(path) for path in several]


def _columns(columns: Mapping[str, str] | None) -> list[str]:
    return [f"{name}={column}" for name, column in (columns or {}).items()]


def _path(path: Path | None) -> str:
    return "" if path is None else os.fspath(path)


def _place(place: float | str | None) -> str:
    """A place in a log: seconds, or a text such as "25%"."""
    return "" if place is None else place if isinstance(place, str) else repr(float(place))


def _varied(vary: Varied) -> list[str]:
    """Axes as the grammar PATH=VALUES writes them."""
    if isinstance(vary, str):
        return [vary]
    if not isinstance(vary, Mapping):
        return list(vary)
    texts = []
    for path, values in vary.items():
        words = values if isinstance(values, str) else ",".join(_word(value) for value in values)
        texts.append(f"{path}={words}")
    return texts


def sweep(
    spec: Spec,
    vary: Varied,
    *,
    sample: int | None = None,
    method: str = "sobol",
    seed: int = 0,
    jobs: int = 0,
) -> Sweep:
    """Computes many designs on all cores, or on `jobs` of them.

    `vary` maps dot paths to lists of values or to texts such as "40:100:5", "10..60" and
    "75~1.5", or lists "path=values" as --vary takes them. Every combination is computed or, with
    `sample`, as many draws by `method`: "sobol" or "lhs". Ctrl-C ends it.

    The result's `array` has a record a design: the varied fields, then `status`, `limited_by`,
    `limiting_condition` and `cross_section_mm2`, then `hover` and `forward` with every number of
    an OperatingPoint, such as `array["forward.total_power_W"]`. Numbers that do not exist are
    NaN.
    """
    return _core._sweep(spec, _varied(vary), sample, method, seed, jobs)


def evaluate(spec: Spec, area_mm2: Areas = None) -> Answer:
    """What cables of these cross-sections do, in mm² or as "AWG18"; else the spec's own.

    `table` has an entry a cross-section, whose `hover` and `forward` have the numbers of an
    OperatingPoint; `thermal` the temperatures in °C where a heat balance is asked for;
    `cable` tension, strength and, of a solved tether, how it hangs, likewise; `voltage_class` the class of the supply's voltage.
    """
    return _core._evaluate(spec, _areas(area_mm2))


def compare(spec: Spec, motors: Texts = "all") -> Answer:
    """The optimum with each of several motors: "all", "alike", names or files.

    "alike" are the spec's own and those nearest in greatest thrust. `motors` has an entry a
    motor: `motor`, `status`, `optimum` with `cross_section_mm2`, `limited_by`, `hover` and
    `forward`, `best_headroom`, and where there is no optimum the `reason`.
    """
    return _core._compare(spec, _texts(motors))


def design(
    spec: Spec,
    free: Varied,
    *,
    minimize: str = "total_power_W",
    subject_to: Texts | None = None,
    standard: str = "",
    pareto: Texts | None = None,
    seed: int = 1,
) -> Answer:
    """The best whole design among those that the `free` fields allow, and what binds it.

    `free` is written as for `sweep`: "40..400" is searched, a list is enumerated. `subject_to`
    lists demands such as "tether_mass_g<=400", in the unit that the name ends in; `minimize` is
    such a name or the path of a field. `standard` ("awg" or "iec") leaves sizes that can be
    bought, and `pareto` names two quantities whose front is wanted.

    `value` is the least found, `free` the fields' values there, `cross_section_mm2`, `hover` and
    `forward` its cable and operating points, `prices` what each demand costs, `spec` the whole
    design and `pareto` the front.
    """
    return _core._design(
        spec, _varied(free), minimize, _texts(subject_to), standard, _texts(pareto), seed
    )


def envelope(spec: Spec, area_mm2: Area = None) -> Answer:
    """How high, heavy, fast and in how much wind a given cable flies.

    `area_mm2` is a cross-section in mm² or as "AWG18", else the spec's own. `greatest` has
    `height_m`, `payload_g`, `headwind_m_s` and `airspeed_m_s`, each with its value and what limits
    it; `curves` has one of them over another.
    """
    return _core._envelope(spec, _areas(area_mm2))


def rules(spec: Spec, book: str) -> Answer:
    """How a design's figures stand to published rules: "eu-c3", "uk", "us" or "electrical".

    The cable is the spec's own, else the optimum. `counts` has how many clauses `pass`, `fail` and
    are `unknown`; `clauses` each with `document`, `clause`, `edition`, `text`, our `value` (least
    and greatest), `limit`, `margin_percent`, `verdict` and `because`. A pass is no more than that
    the figure is within the clause's number.
    """
    return _core._rules(spec, book)


def shape(
    spec: Spec,
    *,
    area_mm2: Area = None,
    height_m: float | None = None,
    offset_m: float | None = None,
    wind_m_s: float | None = None,
    wind_from_deg: float = 0,
    slack_percent: float | None = None,
    length_m: float | None = None,
    winch_tension_N: float | None = None,
    stiffness_N: float | None = None,
    station_height_m: float | None = None,
    profile: str | None = None,
    reference_height_m: float | None = None,
    exponent: float | None = None,
    roughness_m: float | None = None,
) -> Answer:
    """How the cable hangs, and what the drone feels of it. What is not given the spec says.

    The drone is `height_m` above the station and `offset_m` aside; the cable is as long as it
    takes and `slack_percent` more, or `length_m`, or pulled by the winch with `winch_tension_N`.
    The wind is `wind_m_s` at `reference_height_m`, or at the drone, and blows from
    `wind_from_deg`, clockwise from above, 0 being where the drone stands aside. `profile`
    ("uniform", "power-law" or "logarithmic") says how it grows with height, with `exponent` or
    `roughness_m`, the station being `station_height_m` over ground. `stiffness_N` is axial, force
    per strain.

    `outcome` is "hangs" or says why there is no such cable. `length_m` is its length, `T_drone_N`
    and `T_anchor_N` the pulls at its ends, `F_on_drone_N` the force by axis (aside, to its left,
    up), `solved` and `straight` what the drone does with this cable and with a straight one,
    `stations` the curve.
    """
    return _core._shape(
        spec,
        _areas(area_mm2),
        height_m,
        offset_m,
        _areas(wind_m_s),
        wind_from_deg,
        _areas(slack_percent),
        length_m,
        winch_tension_N,
        stiffness_N,
        station_height_m,
        profile,
        reference_height_m,
        exponent,
        roughness_m,
    )


def drag(
    logs: Paths,
    mass_g: float,
    *,
    air_density_kg_m3: float | None = None,
    pressure_hPa: float | None = None,
    temperature_C: float | None = None,
    pitch_offset_deg: float | None = None,
    trim_log: Path | None = None,
    start: float | str | None = None,
    end: float | str | None = None,
    core: int = 0,
    columns: Mapping[str, str] | None = None,
    published_kinematics: bool = False,
) -> Answer:
    """The drag that flights of one drone show, with honest errors.

    `start` and `end` are seconds of the log's clock or texts such as "25%" of its samples; without
    them the part that moves is used. The air density is given, or follows from pressure and
    temperature; so is the pitch offset, or measured by `trim_log`, a hover flight. What is assumed
    where neither is given, and what is amiss with a log, is warned of; `notes` has the same.

    `columns` says what logs in CSV call their columns: {"airspeed_km_h": "wind", "vd_m_s": "-climb"}.

    `front_area_m2`, `top_area_m2` and `linear_m_s` have `value`, `standard_error` and `ci95`, the
    ends of the 95 % interval; `wind_m_s` has one a flight. `rmse_m_s2` is what the fit leaves of
    the acceleration, `table` the force (N) and tilt (degrees) over the airspeed, `drone.drag` the
    block for a spec. Of several flights drag is shared and the wind is each one's own.
    """
    flown = _core._Flight(
        core,
        _place(start),
        _place(end),
        _path(trim_log),
        pitch_offset_deg,
        mass_g,
        air_density_kg_m3,
        pressure_hPa,
        temperature_C,
        published_kinematics,
        _columns(columns),
    )
    return _core._drag(_paths(logs), flown)


def diagnose(
    spec: Spec,
    *,
    flight: Paths | None = None,
    power: Paths | None = None,
    log: Paths | None = None,
    base: Texts | None = None,
    effects: Paths | None = None,
    batteries: Sequence[int] = (),
    free_flight: bool = False,
    mass_g: float | None = None,
    air_density_kg_m3: float | None = None,
    pressure_hPa: float | None = None,
    temperature_C: float | None = None,
    pitch_offset_deg: float | None = None,
    trim_log: Path | None = None,
    start: float | str | None = None,
    end: float | str | None = None,
    core: int = 0,
    columns: Mapping[str, str] | None = None,
) -> Answer:
    """What the simulation of measured flights gets wrong, why, and how far the design moves.

    `flight` and `power` are logs of either kind, `log` is one that holds both; several are of one
    drone, and of free flights where their power is judged. `base` names
    effects that are taken for granted, `effects` files with further ones. What is known of the
    flight is written as for `drag`; mass and air are else the spec's. `batteries` are the numbers
    of the monitors that feed the motors, `free_flight` says that the power was logged without the
    tether.

    `findings` has what was found, each with `effect`, `title`, `parameters`, the `gain_percent`
    on held-out data and what it is `indistinguishable_from`; `suspected`, `ruled_out`,
    `not_testable` and `not_identifiable` the other verdicts, `unexplained` what has no name,
    `notes` what was done to the log. `extended.spec` is the design with what was found in it,
    `design_impact` how far its `cross_section_mm2` and `total_power_W` move. With logs of both
    kinds each has its own under `flight` and `power`.
    """
    flown = _core._Flight(
        core,
        _place(start),
        _place(end),
        _path(trim_log),
        pitch_offset_deg,
        mass_g,
        air_density_kg_m3,
        pressure_hPa,
        temperature_C,
        False,
        _columns(columns),
    )
    return _core._diagnose(
        spec,
        _paths(flight),
        _paths(power),
        _paths(log),
        _texts(base),
        _paths(effects),
        [str(number) for number in batteries],
        free_flight,
        flown,
    )
