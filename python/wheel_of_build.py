"""What pip calls for `pip install .`: CMake builds the package, and this packs it (PEP 517).

--config-settings fe=off          the package `chladni-squeal`, without PETSc
--config-settings build=FOLDER    packs what is built in that folder of CMake's
"""

import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]


def version():
    return re.search(r"project\(chladni VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text())[1]


def is_on(settings, key):
    word = str(settings.get(key, "on")).lower()
    if word not in ("on", "off"):
        raise SystemExit(f"--config-settings {key}={word}: give on or off")
    return word == "on"


def build(with_fe):
    """The folder in which CMake has built the package."""
    folder = SOURCE / "build" / ("python" if with_fe else "python-squeal")
    environment = {"CCACHE_BASEDIR": str(SOURCE), "CCACHE_NOHASHDIR": "true", **os.environ}
    choices = {"CMAKE_BUILD_TYPE": "Release", "CHLADNI_FE": "ON" if with_fe else "OFF", "CMAKE_UNITY_BUILD": "ON",
               "CMAKE_UNITY_BUILD_BATCH_SIZE": "12", "BUILD_TESTING": "OFF", "PYTHON_EXECUTABLE": sys.executable}  # fmt: skip
    options = [f"-D{name}={value}" for name, value in choices.items()]
    for words in (["-S", SOURCE, "-B", folder, "-G", "Ninja", "-Wno-dev", *options], ["--build", folder, "--target", "chladni_python"]):
        subprocess.run(["cmake", *words], check=True, env=environment)
    return folder


def files_of(folder, with_fe):
    """What the wheel holds: (name in it, file)."""
    package = folder / "python" / "chladni"
    for path in sorted(package.iterdir()):
        is_heavy = path.name.startswith(("_fe.", "_cms.", "reduction.py", "finite_elements.py"))
        if path.is_file() and (with_fe or not is_heavy):
            yield f"chladni/{path.name}", path
    if with_fe:
        plugin = (folder / "lib/libchladni_petsc.so").resolve()
        yield "chladni/libchladni_petsc.so." + ".".join(version().split(".")[:2]), plugin
        yield "chladni/chladni-mesher", folder / "libexec/chladni/chladni-mesher"


def metadata(name):
    needs = "with PETSc, which python3-petsc4py and python3-slepc4py bring" if name == "chladni" else "without PETSc"
    return (f"Metadata-Version: 2.1\nName: {name}\nVersion: {version()}\n"
            f"Summary: Modal bodies of plates and shells, and their squeal, {needs}\n"
            "License: BSD-2-Clause\nRequires-Python: >=3.11\nRequires-Dist: numpy\n")  # fmt: skip


def pack(wheel, info, files, texts):
    """Writes a wheel with its list of digests."""
    record = []
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for name, content, mode in [*((n, f.read_bytes(), f.stat().st_mode) for n, f in files),
                                    *((n, t.encode(), 0o100644) for n, t in texts.items())]:  # fmt: skip
            entry = zipfile.ZipInfo(name, (2020, 1, 1, 0, 0, 0))
            entry.external_attr, entry.compress_type = mode << 16, zipfile.ZIP_DEFLATED
            archive.writestr(entry, content, compresslevel=1)
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            record.append(f"{name},sha256={digest},{len(content)}\n")
        archive.writestr(f"{info}/RECORD", "".join(record) + f"{info}/RECORD,,\n")


def names(settings):
    """Name of the package, and the stem of its files."""
    name = "chladni" if is_on(settings, "fe") else "chladni-squeal"
    return name, f"{name.replace('-', '_')}-{version()}"


def texts_of(settings):
    """What pip reads of the package: name and text of each file."""
    name, stem = names(settings)
    wheel = f"Wheel-Version: 1.0\nGenerator: chladni\nRoot-Is-Purelib: false\nTag: {tag()}\n"
    return {f"{stem}.dist-info/METADATA": metadata(name), f"{stem}.dist-info/WHEEL": wheel}


def tag():
    """For this interpreter on this machine."""
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    for name, text in texts_of(config_settings or {}).items():
        file = Path(metadata_directory) / name
        file.parent.mkdir(exist_ok=True)
        file.write_text(text)
    return file.parent.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    settings = config_settings or {}
    with_fe = is_on(settings, "fe")
    folder = Path(settings["build"]).resolve() if "build" in settings else build(with_fe)
    stem = names(settings)[1]
    wheel = f"{stem}-{tag()}.whl"
    pack(Path(wheel_directory) / wheel, f"{stem}.dist-info", files_of(folder, with_fe), texts_of(settings))
    return wheel
