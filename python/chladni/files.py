"""Files of Chladni as plain objects: groups with attributes, arrays with units and named axes."""

from __future__ import annotations

import html
import os
from collections.abc import Iterator
from typing import Any

import numpy as np

from chladni import _squeal
from chladni.axes import axes_of


class Array:
    """Numbers or texts with a unit, and a name for each axis.

    Attributes:
        values: the numpy array, of shape `shape`
        unit: SI unit as text, "1" for pure numbers, "text" for texts
        dims: name of each axis
        coords: for some axes the values along them, each an `Array` of one axis

    `numpy.asarray(array)`, `array[i, j]` and all functions of numpy take the values.
    """

    def __init__(self, values: np.ndarray, unit: str, dims: tuple[str, ...], coords: dict[str, Array] | None = None):
        self.values, self.unit, self.dims, self.coords = values, unit, dims, coords or {}

    @property
    def shape(self) -> tuple[int, ...]:
        return self.values.shape

    def __array__(self, dtype=None) -> np.ndarray:
        return np.asarray(self.values, dtype)

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, index):
        return self.values[index]

    def __iter__(self) -> Iterator:
        return iter(self.values)

    def sel(self, **wanted: float | str):
        """The values where the coordinates along the named axes are nearest to the wanted numbers, or are the wanted texts.

        >>> speed = Array(np.array([1.0, 2.0]), "rad/s", ("speed",))
        >>> Array(np.array([[3, 4], [5, 6]]), "1", ("speed", "eigenvalue"), {"speed": speed}).sel(speed=1.9)
        array([5, 6])
        """
        index: list[Any] = [slice(None)] * self.values.ndim
        for axis, value in wanted.items():
            if axis not in self.coords:
                raise KeyError(f"no coordinates along {axis!r}; there are some along {sorted(self.coords)}")
            index[self.dims.index(axis)] = self.coords[axis]._place_of(value)
        return self.values[tuple(index)]

    def _place_of(self, value: float | str) -> int:
        if isinstance(value, str):
            if value not in self.values:
                raise KeyError(f"no {value!r} along this axis; there are {list(self.values)}")
            return list(self.values).index(value)
        return int(np.abs(self.values - value).argmin())

    def __repr__(self) -> str:
        axes = ", ".join(f"{dim}: {n}" for dim, n in zip(self.dims, self.shape))
        return f"<Array ({axes}) [{self.unit}]\n{self.values!r}>"


class Group:
    """What stands in one group of a file, as attributes and as items: `results.eigenvalues.lambda_re`,
    `results["eigenvalues/lambda_re"]`. A pair `x_re`, `x_im` is there as complex `x` too."""

    def __init__(self, members: dict[str, Any]):
        self._members = members

    def __getitem__(self, name: str):
        head, _, rest = name.partition("/")
        if head in self._members:
            member = self._members[head]
        elif f"{head}_re" in self._members and f"{head}_im" in self._members:
            re, im = self._members[f"{head}_re"], self._members[f"{head}_im"]
            member = Array(re.values + 1j * im.values, re.unit, re.dims, re.coords)
        else:
            raise KeyError(f"{head!r}; there are {', '.join(self._members)}")
        return member[rest] if rest else member

    def __contains__(self, name: str) -> bool:
        try:
            self[name]
        except (KeyError, TypeError):
            return False
        return True

    def __getattr__(self, name: str):
        if name.startswith("__") or name == "_members":
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(f"no {error.args[0]}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._members)

    def __len__(self) -> int:
        return len(self._members)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._members]

    def items(self):
        """Pairs of name and member: a `Group`, an `Array`, a number or a text."""
        return self._members.items()

    def __repr__(self) -> str:
        return f"<Group of {', '.join(self._members)}>"


class File(Group):
    """A file that was read and checked: a modal body, a reduced system, frequency responses, results of squeal, of radiation or of sound.

    Attributes:
        format: "chladni-body", "chladni-reduced", "chladni-response", "chladni-squeal", "chladni-radiation" or "chladni-sound"
        path: of the file
        units: unit of each number, by the name of its dataset
        notes: what is to be told of the brake, where it was made by `Scene.squeal`

    Pictures of a scene's files stand in `Run`, which Jupyter shows as the page of `squeal report`.
    """

    def __init__(self, path: str | os.PathLike):
        self.path = os.fspath(path)
        self.format, values = _squeal.file_values(self.path)
        self.units = {name: unit for name, unit, _ in values}
        self.notes: list[str] = []
        self._description: str | None = None
        self._folder: Any = None  # keeps a temporary folder alive
        super().__init__(_tree(self.format, values))

    def describe(self) -> str:
        """The table that `chladni info` prints."""
        if self._description is None:
            self._description = _squeal.describe(self.path)
        return self._description

    def __getstate__(self) -> dict[str, Any]:
        """With its description, since a temporary file is gone where this arrives."""
        self.describe()
        return {**self.__dict__, "_folder": None}

    def __repr__(self) -> str:
        return f"<{self.format} {self.path}: {', '.join(self)}>"

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self.describe())}</pre>"


def _tree(form: str, values: list[tuple[str, str, Any]]) -> dict[str, Any]:
    """The members of the root: dicts of dicts become groups."""
    arrays: dict[str, Any] = {}
    for name, unit, value in values:
        if isinstance(value, list):
            value = np.array(value, dtype=object)
        is_array = isinstance(value, np.ndarray)
        arrays[name] = Array(value, unit, axes_of(form, name, value.ndim)[0]) if is_array else value
    for name, array in arrays.items():
        if isinstance(array, Array):
            places = axes_of(form, name, array.values.ndim)[1]
            array.coords = {dim: arrays[at] for dim, at in places.items() if at in arrays and at != name}
    root: dict[str, Any] = {}
    for name, member in arrays.items():
        *groups, last = name.split("/")
        place = root
        for group in groups:
            place = place.setdefault(group, {})
        place[last] = member
    return _grouped(root)


def _grouped(members: dict[str, Any]) -> dict[str, Any]:
    return {name: Group(_grouped(member)) if isinstance(member, dict) else member for name, member in members.items()}


def open_file(path: str | os.PathLike) -> File:
    """Reads a `*.body.h5`, `*.reduced.h5`, `*.response.h5`, `*.squeal.h5`, `*.radiation.h5` or `*.sound.h5`.

    Raises `chladni.Error` with the words of the programs where it is none or is damaged.
    """
    return File(path)
