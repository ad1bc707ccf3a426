"""Co-simulation of a body as FMU 2.0 with ctypes alone: a knock on one degree of freedom, and how it rings on.

Usage: hammer.py BODY.fmu FORCE OUTPUT    such as: hammer.py strip.fmu R.F_z R.u_z
"""

import ctypes
import sys
import tempfile
import zipfile
from pathlib import Path
from xml.etree import ElementTree

fmu, force, output = sys.argv[1:]
folder = tempfile.mkdtemp()
zipfile.ZipFile(fmu).extractall(folder)
model = ElementTree.parse(f"{folder}/modelDescription.xml").getroot()
reference = {v.get("name"): int(v.get("valueReference")) for v in model.iter("ScalarVariable")}
identifier = model.find("CoSimulation").get("modelIdentifier")
library = ctypes.CDLL(f"{folder}/binaries/linux64/{identifier}.so")
library.fmi2Instantiate.restype = ctypes.c_void_p


class Callbacks(ctypes.Structure):  # logger, allocateMemory, freeMemory, stepFinished, environment
    _fields_ = [(f"pointer_{i}", ctypes.c_void_p) for i in range(5)]


def call(name, *arguments):
    if getattr(library, name)(ctypes.c_void_p(body), *arguments) != 0:
        sys.exit(f"{name} failed")


def one(name, value=0.0):
    return (ctypes.c_uint * 1)(reference[name]), ctypes.c_size_t(1), (ctypes.c_double * 1)(value)


body = library.fmi2Instantiate(b"body", 1, model.get("guid").encode(), (Path(folder) / "resources").as_uri().encode(),
                               ctypes.byref(Callbacks()), 0, 0)  # fmt: skip
call("fmi2SetupExperiment", 0, ctypes.c_double(0), ctypes.c_double(0), 0, ctypes.c_double(0))
call("fmi2EnterInitializationMode")
call("fmi2ExitInitializationMode")

step = 1e-4  # s
for i in range(20):
    call("fmi2SetReal", *one(force, 100.0 if i < 3 else 0.0))
    call("fmi2DoStep", ctypes.c_double(i * step), ctypes.c_double(step), 1)
    response = one(output)
    call("fmi2GetReal", *response)
    print(f"{(i + 1) * step:.4f} s  {output} = {response[2][0]: .4e}")
library.fmi2FreeInstance(ctypes.c_void_p(body))
