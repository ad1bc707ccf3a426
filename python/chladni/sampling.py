"""Variants of a scene that fill a range evenly, by the generators of scipy."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

METHODS = ("sobol", "latin-hypercube")


def samples(ranges: Mapping[str, tuple[float, float]], n: int, method: str = "sobol", seed: int = 0) -> list[dict[str, float]]:
    """Variants within the ranges of some keys, for `chladni.sweep` or `chladni.write_samples`.

    Args:
        ranges: (from, to) of each key, as in `Scene.with_keys`
        n: how many; a Sobol sequence is balanced where n is a power of 2
        method: "sobol" (scrambled) or "latin-hypercube"
        seed: the same one gives the same variants

    >>> samples({"squeal.friction": (0.3, 0.6)}, 0)
    Traceback (most recent call last):
        ...
    ValueError: n = 0: give 1 or more variants
    """
    from scipy.stats import qmc  # needed here alone

    if method not in METHODS:
        raise ValueError(f"method = {method!r}: must be one of {', '.join(map(repr, METHODS))}")
    if n < 1:
        raise ValueError(f"n = {n}: give 1 or more variants")
    for key, (low, high) in ranges.items():
        if not low < high:
            raise ValueError(f"{key}: ({low}, {high}) must rise")
    engine = qmc.Sobol if method == "sobol" else qmc.LatinHypercube
    unit = engine(d=len(ranges), seed=seed)
    # The first points of the next power of 2, which scipy does not warn of.
    points = unit.random_base2((n - 1).bit_length())[:n] if method == "sobol" else unit.random(n)
    lows, highs = zip(*ranges.values())
    return [dict(zip(ranges, map(float, point))) for point in qmc.scale(points, lows, highs)]


def write_samples(path: str | os.PathLike, variants: Sequence[Mapping[str, float]]) -> None:
    """Writes variants of the same keys as the file of `squeal sweep --samples`, where places in lists count from 1.

    >>> write_samples("samples.csv", [{"squeal.friction": 0.3}, {"squeal.thickness": 0.02}])
    Traceback (most recent call last):
        ...
    ValueError: variant 2 has other keys than the first
    """
    if not variants:
        raise ValueError("there are no variants")
    keys = list(variants[0])
    for i, variant in enumerate(variants, 1):
        if list(variant) != keys:
            raise ValueError(f"variant {i} has other keys than the first")
    header = [re.sub(r"\[(\d+)\]", lambda place: f"[{int(place[1]) + 1}]", key) for key in keys]
    lines = [header, *([repr(float(variant[key])) for key in keys] for variant in variants)]
    Path(path).write_text("".join(",".join(line) + "\n" for line in lines))
