"""Scenes, and what the programs make of them."""

from __future__ import annotations

import html
import os
import shutil
import tempfile
import tomllib
import weakref
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from chladni import _squeal
from chladni.files import File
from chladni.toml_text import toml_text

# Lines that messages name are then those of `Scene.text`, not of a file.
_CHANGED = " with other keys"

Listener = Callable[[str, float], object]


class Scene:
    """One case from the mesh to the squeal, checked as the programs check a scene file (docs/reference/scene.md).

    Args:
        source: text of a scene file, or its keys as nested dicts
        folder: where a mesh file that the scene names is; the current one if nothing is said
        path: what messages call the scene

    Raises:
        chladni.Error: names line, key and value of what is wrong, and what is allowed

    >>> Scene({"squeal": {"model": "rigid disk"}})
    Traceback (most recent call last):
        ...
    chladni.Error: scene:2: squeal.model = "rigid disk": ...
    """

    def __init__(self, source: str | Mapping[str, Any], folder: str | os.PathLike | None = None, path: str = "scene"):
        text = source if isinstance(source, str) else toml_text(source)
        name = os.path.join(os.fspath(folder), path) if folder is not None else path
        self._scene = _squeal.Scene.parse(text, name)

    @classmethod
    def read(cls, path: str | os.PathLike) -> Scene:
        """The scene of a TOML file."""
        scene = cls.__new__(cls)
        scene._scene = _squeal.Scene.read(os.fspath(path))
        return scene

    name = property(lambda self: self._scene.name, doc="stem of the files that runs write")
    title = property(lambda self: self._scene.title)
    text = property(lambda self: self._scene.text, doc="TOML text of the scene")
    path = property(lambda self: self._scene.path, doc="what messages call the scene")
    notes = property(lambda self: self._scene.notes, doc="numbers that look like another unit's, a line for each")

    def to_dict(self) -> dict[str, Any]:
        """All keys as nested dicts; a copy."""
        return tomllib.loads(self.text)

    def __getitem__(self, key: str) -> Any:
        """The value of "squeal.friction", or of "squeal.pads[0].stiffness": lists count from 0."""
        place: Any = self.to_dict()
        for step in _steps(key):
            try:
                place = place[step]
            except (KeyError, IndexError, TypeError):
                raise KeyError(f"{key}: the scene does not say it") from None
        return place

    def __contains__(self, key: str) -> bool:
        try:
            self[key]
        except KeyError:
            return False
        return True

    def with_keys(self, changes: Mapping[str, Any]) -> Scene:
        """Another scene with these values of keys, checked; None takes a key away.

        scene.with_keys({"squeal.friction": 0.4, "squeal.pads[0].stiffness": 5e6})
        """
        keys = self.to_dict()
        for key, value in changes.items():
            _set(keys, _steps(key), value)
        changed = Scene.__new__(Scene)
        name = self.path if self.path.endswith(_CHANGED) else self.path + _CHANGED
        changed._scene = _squeal.Scene.parse(toml_text(keys), name)
        return changed

    def __setitem__(self, key: str, value: Any) -> None:
        """Sets a key; the scene stays as it was where the value is refused."""
        self._scene = self.with_keys({key: value})._scene

    def __delitem__(self, key: str) -> None:
        self[key] = None

    def squeal(self, body: str | os.PathLike | File | None = None, output: str | os.PathLike | None = None,
               progress: Listener | None = None) -> File:  # fmt: skip
        """The analyses of `[squeal]`, in this process, as `squeal run` performs them.

        Args:
            body: a `*.body.h5` or what was opened of it; if nothing is said NAME.body.h5 in `output`
            output: folder for NAME.squeal.h5; if nothing is said a temporary one, which goes with the result
            progress: is called with the name of the analysis and the part of the whole that is done, 0 to 1

        Returns:
            the results: numbers, and arrays with units and named axes

        Raises:
            chladni.Error: with the words of the program; where an analysis failed after others had succeeded,
                its attribute `results` holds those
        """
        folder = _Folder(output)
        if self._scene.needs_body and body is None and output is None:
            raise _squeal.Error(f"{self.path}: squeal needs a body: give it as `body`, or the folder of the scene as `output`")
        notes = _squeal.run_squeal(self._scene, folder.path, _path_of(body), progress)
        results = File(os.path.join(folder.path, f"{self.name}.squeal.h5"))
        results.notes = notes
        results._folder = folder
        if "failure" in results:
            error = _squeal.Error(results["failure"])
            error.results = results
            raise error
        return results

    def run(self, output: str | os.PathLike | None = None, progress: Listener | None = None) -> Run:
        """Mesh, reduction, body and, where the scene has `[squeal]`, the analyses; in this process.

        Args:
            output: folder for the files; if nothing is said a temporary one, which goes with the result
            progress: is called with the name of the phase and its part that is done, 0 to 1
        """
        folder = _Folder(output)
        if not self._scene.needs_body:
            self.squeal(output=folder.path, progress=progress)
            return Run(self, folder)
        try:
            from chladni import finite_elements
        except ImportError as missing:
            raise ImportError(
                f"{missing}; a mesh needs python3-petsc4py, python3-slepc4py and a build with PETSc; `squeal` takes "
                "a `body` that was made elsewhere"
            ) from None
        run = Run(self, folder, at=finite_elements.same_on_all_ranks(folder.path))
        run.notes = finite_elements.make_body(self._scene, run.folder, progress)
        if self._scene.has_squeal:
            finite_elements.on_first_rank(lambda: self.squeal(output=run.folder, progress=progress))
        return run

    def __reduce__(self):
        return _again, (self.text, self.path)

    def __repr__(self) -> str:
        return f"<Scene {self.name}: {self.title}>"

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self.text)}</pre>"


class Run:
    """The files of a scene in a folder; in Jupyter the page of `squeal report`, with its pictures.

    Attributes:
        scene: the `Scene`
        folder: path of the folder; of the first rank under mpirun
        notes: what is to be told of the body, a line for each
        reduced, body, squeal: what the files hold, each a `File`; None where there is no such file
    """

    def __init__(self, scene: Scene, folder: str | os.PathLike | _Folder, at: str | None = None):
        self.scene = scene
        self._folder = folder if isinstance(folder, _Folder) else _Folder(folder)
        self.folder: str = at or self._folder.path
        self.notes: list[str] = []

    reduced = property(lambda self: self._file("reduced"))
    body = property(lambda self: self._file("body"))
    squeal = property(lambda self: self._file("squeal"))

    def _file(self, kind: str) -> File | None:
        path = Path(self.folder) / f"{self.scene.name}.{kind}.h5"
        if not path.exists():
            return None
        file = File(str(path))
        file._folder = self._folder
        return file

    def report(self) -> str:
        """The page of `squeal report`, as text in HTML."""
        return _squeal.report_html(self.scene._scene, self.folder)

    def _repr_html_(self) -> str:
        page = html.escape(self.report(), quote=True)
        return f'<iframe srcdoc="{page}" width="100%" height="800" style="border:0"></iframe>'

    def __repr__(self) -> str:
        return f"<Run of {self.scene!r} in {self.folder}>"


class _Folder:
    """A folder for files: the user's, or a temporary one that goes with the last that holds it."""

    def __init__(self, path: str | os.PathLike | None):
        self.path = os.fspath(path) if path is not None else tempfile.mkdtemp(prefix="chladni-")
        if path is None:
            weakref.finalize(self, shutil.rmtree, self.path, ignore_errors=True)

    def __reduce__(self):
        return _Folder, (self.path,)


def _again(text: str, path: str) -> Scene:
    return Scene(text, path=path)


def _path_of(body: str | os.PathLike | File | None) -> str:
    """Of a body; empty for none."""
    return body.path if isinstance(body, File) else "" if body is None else os.fspath(body)


def _steps(key: str) -> list[str | int]:
    """ "squeal.pads[0].stiffness" as ["squeal", "pads", 0, "stiffness"]."""
    steps: list[str | int] = []
    for part in key.split("."):
        name, *places = part.split("[")
        steps += [name, *(int(place.rstrip("]")) for place in places)]
    return steps


def _set(table: Any, steps: list[str | int], value: Any) -> None:
    last: Any
    *way, last = steps
    for step, following in zip(way, steps[1:]):
        if isinstance(table, dict) and step not in table and isinstance(following, str):
            table[step] = {}
        table = table[step]
    if value is not None:
        table[last] = value
    elif isinstance(table, list) or last in table:
        del table[last]


def _squeal_of(job: tuple[Scene, str]) -> File | _squeal.Error:
    scene, body = job
    try:
        results = scene.squeal(body=body or None)
    except _squeal.Error as error:
        return error
    return results


def sweep(scene: Scene, variants: Iterable[Mapping[str, Any]], body: str | os.PathLike | File | None = None,
          processes: int | None = None) -> Iterator[File | Exception]:  # fmt: skip
    """The results of squeal for each variant of a scene, in processes of their own, in the order of the variants.

    Args:
        scene: with `[squeal]`
        variants: for each the keys that differ, as in `Scene.with_keys`
        body: as in `Scene.squeal`
        processes: how many at a time; if nothing is said as many as there are processors

    Yields:
        the results of each variant; where it failed the `chladni.Error`, which the caller may raise
    """
    jobs = [(scene.with_keys(variant), _path_of(body)) for variant in variants]
    n = processes or os.cpu_count() or 1
    with ProcessPoolExecutor(n, mp_context=get_context("forkserver")) as pool:
        yield from pool.map(_squeal_of, jobs, chunksize=max(1, len(jobs) // (8 * n)))
