"""Machine drives: modes, designs, simulation, identification, balancing, and the drive with the firmware's bits.

The functions run the commands of ``cargo driveline`` inside Python and give what ``--json`` prints: the same names, SI
units, lists of numbers as numpy arrays. What a command refuses is a :class:`Refused` with its sentence; a result with
a reservation, such as a loop without margins, comes with a :class:`Warning`.
"""

from __future__ import annotations

import csv
import json
import os
import shutil
import tempfile
import warnings
import weakref
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native

__all__ = ["Drive", "Machine", "Refused", "balancing", "example", "identify", "rotor", "simulate", "variants"]

Result = dict[str, Any]


class Refused(ValueError):
    """A file with a fault, an argument out of range, a run that could not finish: the sentence of the command."""


def _arrays(value: Any) -> Any:
    if isinstance(value, list) and len(value) > 2 and all(isinstance(one, int | float | None) for one in value):
        return np.array(value, dtype=float)
    if isinstance(value, list):
        return [_arrays(one) for one in value]
    return {key: _arrays(one) for key, one in value.items()} if isinstance(value, dict) else value


def _run(name: str, *files: str | os.PathLike[str], **options: Any) -> Result:
    arguments = [name, *(os.fspath(file) for file in files), "--json"]
    for key, value in options.items():
        option = "--" + key.rstrip("_").replace("_", "-")
        for one in value if isinstance(value, list | tuple) else [value]:
            if one is True:
                arguments.append(option)
            elif one is not None and one is not False:
                arguments.append(f"{option}={one}")
    text, failure = _native.command(arguments)
    if failure is not None:
        if not text:
            raise Refused(failure)
        warnings.warn(failure, stacklevel=3)
    result: Result = _arrays(json.loads(text))
    return result


def _table(path: str) -> dict[str, NDArray[np.float64]]:
    with open(path, encoding="utf-8", newline="") as file:
        rows = csv.reader(file)
        heads = next(rows)
        number = [[float(cell) if cell else np.nan for cell in row] for row in rows]
    return dict(zip(heads, np.array(number).reshape(-1, len(heads)).T.copy()))


def _with_table(name: str, *files: str | os.PathLike[str], **options: Any) -> Result:
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "table.csv")
        result = _run(name, *files, csv=path, **options)
        return {**result, "course": _table(path)}


class Machine:
    """A machine of a TOML file: elements from the motor to the load, encoder, rate, limits, tolerances."""

    def __init__(self, file: str | os.PathLike[str]):
        self.file = Path(file)

    @classmethod
    def of_text(cls, text: str, name: str = "machine") -> Machine:
        """A machine of the text of such a file."""
        folder = Path(tempfile.mkdtemp())
        machine = cls(folder / f"{name}.toml")
        machine.file.write_text(text, encoding="utf-8")
        weakref.finalize(machine, shutil.rmtree, folder, ignore_errors=True)
        return machine

    @classmethod
    def example(cls, name: str) -> Machine:
        """A machine that the package carries: ``hoist``, ``roll``, ``axis``, ``mill``, ``ship``."""
        return cls.of_text(example(name), name)

    @property
    def text(self) -> str:
        """The text of its file."""
        return self.file.read_text(encoding="utf-8")

    def modes(self) -> Result:
        """Natural frequencies and shapes, reductions to two masses, sensitivities."""
        return _run("modes", self.file)

    def design(self) -> Design:
        """Observer and speed loop, with margins, poles and responses."""
        return Design(_run("design", self.file))

    def rust(self) -> str:
        """The design as constants for a firmware."""
        return str(_run("design", self.file, emit="rust")["rust"])

    def replay(self, recording: str | os.PathLike[str], **options: Any) -> Result:
        """The observer over a recording; ``course`` has the estimates of each tick.

        The options are those of ``cargo driveline replay``: ``rate`` (Hz), ``torque_constant`` (N m/A), ``delay`` (s),
        ``from_`` and ``to`` (s), ``held``, ``column``, ``teeth``.
        """
        return _with_table("replay", recording, machine=self.file, **options)

    def campaign(self, draws: int = 200, seed: int = 1, **options: Any) -> Result:
        """The drive in closed loop with machines drawn from within the tolerances.

        Further options: ``drive`` (``two-mass``, ``semi-implicit``, ``rigid``, ``backlash``, ``plain``), ``tolerance``
        (``NAME=LOW..HIGH``), ``threads``.
        """
        with tempfile.TemporaryDirectory() as folder:
            results = os.path.join(folder, "results.draws")
            return _run("campaign", self.file, draws=draws, seed=seed, results=results, **options)

    def drive(self, number: str = "f32", observer: str | None = None) -> Drive:
        """The drive in ``f32`` or ``fixed``, with the bits of a firmware that ``cargo driveline new`` writes.

        ``observer``: ``two-mass``, ``semi-implicit``, ``rigid`` or ``backlash``; the selected one where it is left out.
        """
        return Drive(_native_of(_native.Drive.of_file, self.file, number, observer))


def _native_of(make: Callable[..., _native.Drive], *arguments: Any) -> _native.Drive:
    try:
        return make(*arguments)
    except ValueError as error:
        raise Refused(str(error)) from None


class Design(dict[str, Any]):
    """What ``design --json`` prints, as a dictionary."""

    def frequency_response(self, machine: str = "nominal") -> Any:
        """The open loop as ``control.FrequencyResponseData``, for `python-control`; ``machine``: nominal or drawn.

        The loop is L of 1 + L: its margins are those of ``speed_loop``.
        """
        responses = self._responses()
        one = responses[machine]
        hertz, first = np.unique(responses["hz"], return_index=True)
        return import_module("control").frd((one["real"] + 1j * one["imaginary"])[first], 2 * np.pi * hertz)

    def plot(self) -> Any:
        """Bode plot of the loop with its band over the tolerances; the figure of matplotlib."""
        from matplotlib import pyplot

        responses = self._responses()
        figure, axes = pyplot.subplots(2, 1, sharex=True)
        nominal, within = responses["nominal"]["open"], responses["open_within"]
        for axis, part in zip(axes, ["gain", "phase"]):
            shown = [curve[part] for curve in (nominal, within["least"], within["most"])]
            middle, least, most = (20 * np.log10(curve) if part == "gain" else curve for curve in shown)
            axis.semilogx(responses["hz"], middle)
            axis.fill_between(responses["hz"], least, most, alpha=0.3)
            axis.grid(True)
        axes[0].set_ylabel("gain, dB")
        axes[1].set_ylabel("phase, degrees")
        axes[1].set_xlabel("frequency, Hz")
        return figure

    def _responses(self) -> Result:
        if self["responses"] is None:
            raise Refused("the machine has no shaft, so there is no speed loop")
        return dict(self["responses"])


class Drive:
    """A drive at rest: the library's own tick, with the bits of the firmware."""

    #: The brake is open and the governor at work.
    RELEASED = 1
    _OUTPUTS = ["torque", "motor_speed", "shaft_torque", "load_speed", "load_torque"]

    def __init__(self, native: _native.Drive):
        self._native = native

    @classmethod
    def variant(cls, name: str) -> Drive:
        """A drive of the firmware's scenes, such as ``hoist/f32/reduced/10000``; fixed point is per unit."""
        return cls(_native_of(_native.Drive.variant, name))

    @property
    def name(self) -> str:
        """The observer of a machine's drive, or the variant."""
        return self._native.name

    @property
    def rate_hz(self) -> int:
        """Ticks a second."""
        return self._native.rate_hz

    @property
    def bases(self) -> tuple[float, float]:
        """Torque (N m) and speed (rad/s) of 1 in fixed point; 1 in ``f32``."""
        return self._native.bases

    def exchange(self, words: NDArray[np.uint32]) -> NDArray[np.uint32]:
        """A tick for each row of eight words, as on the firmware's link.

        In: angle (2^-32 turn), torque of the last tick, setpoint, flags, two vibrations, two for the panel. Out: torque,
        motor speed, shaft torque, load speed, load torque, faults, 0, the panel's answer.
        """
        words = np.asarray(words, dtype=np.uint32)
        if words.ndim != 2 or words.shape[1] != 8:
            raise Refused(f"expected rows of eight words, not an array of {words.shape}")
        return np.frombuffer(self._native.exchange(words.tobytes()), dtype=np.uint32).reshape(words.shape)

    def run(
        self, angle: ArrayLike, torque: ArrayLike, setpoint: ArrayLike, released: ArrayLike = True
    ) -> dict[str, NDArray[Any]]:
        """A tick for each element: angle of the motor (rad), torque applied in the last tick (N m), setpoint (rad/s).

        Where ``released`` is false the drive holds against a closed brake, and ``setpoint`` is the torque it holds with
        (N m). Gives arrays of ``torque``, the command (N m), the estimates ``motor_speed``, ``load_speed`` (rad/s),
        ``shaft_torque``, ``load_torque`` (N m), and ``faults`` (bits).
        """
        parts = [np.asarray(part) for part in (angle, torque, setpoint, released)]
        angle, torque, setpoint, released = np.broadcast_arrays(*(np.atleast_1d(part) for part in parts))
        words = np.zeros((angle.size, 8), dtype=np.uint32)
        turns = np.asarray(angle, dtype=float) / (2 * np.pi)
        words[:, 0] = np.rint((turns - np.floor(turns)) * 2.0**32).astype(np.uint64).astype(np.uint32)
        base_torque, base_speed = self.bases
        words[:, 1] = self._words(torque, base_torque)
        words[:, 2] = self._words(setpoint, base_speed)
        if not np.all(released):
            words[:, 2] = np.where(released, words[:, 2], self._words(setpoint, base_torque))
        words[:, 3] = np.where(released, self.RELEASED, 0)
        out = self.exchange(words)
        bases = [base_torque, base_speed, base_torque, base_speed, base_torque]
        result: dict[str, NDArray[Any]] = {
            name: self._values(out[:, at], base) for at, (name, base) in enumerate(zip(self._OUTPUTS, bases))
        }
        result["faults"] = out[:, 5].copy()
        return result

    def _words(self, values: ArrayLike, base: float) -> NDArray[np.uint32]:
        return np.frombuffer(self._native.to_words(np.asarray(values, dtype=float).tobytes(), base), dtype=np.uint32)

    def _values(self, words: NDArray[np.uint32], base: float) -> NDArray[np.float64]:
        return np.frombuffer(self._native.of_words(words.tobytes(), base), dtype=float)


def variants() -> list[str]:
    """Names of the firmware's drives, for :meth:`Drive.variant`."""
    return _native.variants()


def example(name: str) -> str:
    """The text of a file to begin with, as ``cargo driveline example`` prints it."""
    return str(_run("example", name)["text"])


def simulate(file: str | os.PathLike[str], unproven: bool = False) -> Result:
    """A run of a train file by the full solver; ``course`` has the forces and speeds over time."""
    return _with_table("simulate", file, unproven=unproven)


def identify(recording: str | os.PathLike[str], **options: Any) -> Result:
    """A machine from a recording of torque and motion; ``machine`` is its :class:`Machine`.

    The options are those of ``cargo driveline identify``: ``rate`` (Hz), ``torque_constant`` (N m/A), ``from_`` and
    ``to`` (s), ``counts``, ``column``; for a table of a frequency response ``response`` (angle, speed, acceleration),
    which gives no machine.
    """
    if "response" in options:
        return _run("identify", recording, **options)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{Path(recording).stem}.toml"
        result = _run("identify", recording, toml=path, **options)
        return {**result, "machine": Machine.of_text(path.read_text(encoding="utf-8"), path.stem)}


def balancing(file: str | os.PathLike[str]) -> Result:
    """Weights from the readings of a rotor's runs, the predicted residual and the grade."""
    return _run("balancing", file)


def rotor(file: str | os.PathLike[str]) -> Result:
    """Critical speeds of a rotor, its whirls over the speed, its vibration by unbalance."""
    return _run("rotor", file)
