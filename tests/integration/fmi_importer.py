"""An importer of FMUs of FMI 2.0 and 3.0, as far as those of Chladni need one, and what the standard asks of them."""

import ctypes
import re
import subprocess
import zipfile
from xml.etree import ElementTree

import numpy as np


class Fmu:
    """An FMU that is unpacked, described and loaded."""

    def __init__(self, file, folder, version):
        self.version, self.folder, self.messages = version, folder, []
        with zipfile.ZipFile(file) as archive:
            assert archive.testzip() is None
            archive.extractall(folder)
        self.model = ElementTree.parse(folder / "modelDescription.xml").getroot()
        self.variables = list(self.model.find("ModelVariables"))
        self.reference = {v.get("name"): int(v.get("valueReference")) for v in self.variables}
        identifier = self.model.find("CoSimulation").get("modelIdentifier")
        platform = {2: "linux64", 3: "x86_64-linux"}[version]
        self.binary = folder / "binaries" / platform / f"{identifier}.so"
        self.library = ctypes.CDLL(str(self.binary))
        self.token = self.model.get("guid" if version == 2 else "instantiationToken")
        self.instance = None

    def function(self, name):
        found = getattr(self.library, f"fmi{self.version}{name}")
        found.restype = ctypes.c_int
        return found

    def instantiate(self, token=None, resources=None, kind="CoSimulation"):
        token = (token or self.token).encode()
        resources = resources or self.folder / "resources"
        if self.version == 2:
            logger = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int, ctypes.c_char_p,
                                              ctypes.c_char_p, ctypes.c_char_p])  # fmt: skip
            self.logger = logger(lambda env, name, status, category, form, text: self.messages.append(text.decode()))
            self.callbacks = (ctypes.c_void_p * 5)(ctypes.cast(self.logger, ctypes.c_void_p), None, None, None, None)
            make = self.library.fmi2Instantiate
            make.restype = ctypes.c_void_p
            self.instance = make(b"body", int(kind == "CoSimulation"), token, resources.as_uri().encode(), self.callbacks, 0, 0)
        else:
            logger = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_char_p)
            self.logger = logger(lambda env, status, category, text: self.messages.append(text.decode()))
            make = getattr(self.library, f"fmi3Instantiate{kind}")
            make.restype = ctypes.c_void_p
            false, path = ctypes.c_bool(False), f"{resources}/".encode()
            last = (None, self.logger)
            more = (false, false, None, ctypes.c_size_t(0), *last, None) if kind == "CoSimulation" else last
            self.instance = make(b"body", token, path, false, false, *more)
        return self

    def call(self, name, *arguments, status=0):
        found = self.function(name)(ctypes.c_void_p(self.instance), *arguments)
        assert found == status, f"fmi{self.version}{name} ends with {found} instead of {status}: {self.messages}"

    def initialize(self):
        zero, size = ctypes.c_double(0.0), (0, ctypes.c_double(0.0), ctypes.c_double(0.0), 0, ctypes.c_double(0.0))
        assert zero.value == 0.0
        if self.version == 2:
            self.call("SetupExperiment", *size)
            self.call("EnterInitializationMode")
        else:
            self.call("EnterInitializationMode", *size)
        self.call("ExitInitializationMode")
        return self

    def references(self, names):
        return (ctypes.c_uint32 * len(names))(*(self.reference[name] for name in names)), ctypes.c_size_t(len(names))

    def get(self, names):
        values = (ctypes.c_double * len(names))()
        size = () if self.version == 2 else (ctypes.c_size_t(len(names)),)
        self.call("GetReal" if self.version == 2 else "GetFloat64", *self.references(names), values, *size)
        return np.array(values)

    def set(self, names, given, status=0):
        values = (ctypes.c_double * len(names))(*given)
        size = () if self.version == 2 else (ctypes.c_size_t(len(names)),)
        self.call("SetReal" if self.version == 2 else "SetFloat64", *self.references(names), values, *size, status=status)

    def step(self, time, h):
        last = (ctypes.c_int(1),)
        if self.version == 3:
            last = (ctypes.c_bool(True), *(ctypes.byref(ctypes.c_bool()) for _ in range(3)), ctypes.byref(ctypes.c_double()))
        self.call("DoStep", ctypes.c_double(time), ctypes.c_double(h), *last)

    def jacobian(self, unknowns, knowns):
        columns = []
        for known in knowns:
            values, one = (ctypes.c_double * len(unknowns))(), (ctypes.c_double * 1)(1.0)
            sizes = () if self.version == 2 else (ctypes.c_size_t(1),)
            last = () if self.version == 2 else (ctypes.c_size_t(len(unknowns)),)
            self.call("GetDirectionalDerivative", *self.references(unknowns), *self.references([known]), one, *sizes, values, *last)
            columns.append(np.array(values))
        return np.array(columns).T

    def names(self, pattern):
        return [v.get("name") for v in self.variables if re.fullmatch(pattern, v.get("name"))]

    def states(self):
        return self.names(r"mode\[\d+\]\.q") + self.names(r"mode\[\d+\]\.q_dot")

    def free(self):
        self.library[f"fmi{self.version}FreeInstance"](ctypes.c_void_p(self.instance))
        self.instance = None


def description_rules(fmu, version):
    """What the standard asks of a modelDescription.xml, as far as it concerns ours."""
    names = [v.get("name") for v in fmu.variables]
    if len(set(names)) != len(names):
        yield "two variables have one name"
    if [int(v.get("valueReference")) for v in fmu.variables] != list(range(len(names))):
        yield "value references are not those of the order of variables"
    units = {unit.get("name") for unit in fmu.model.find("UnitDefinitions")}
    states, structure = {}, fmu.model.find("ModelStructure")
    for v in fmu.variables:
        real = v[0] if version == 2 else v
        causality, initial = v.get("causality"), v.get("initial")
        if real.get("unit") is not None and real.get("unit") not in units:
            yield f"{v.get('name')} has a unit that is not defined"
        if (real.get("start") is not None) != (causality in ("parameter", "input") or initial == "exact"):
            yield f"{v.get('name')} has a start value, or none, against the rules"
        if causality in ("independent", "input") and initial is not None:
            yield f"{v.get('name')} must not say `initial`"
        if causality == "output" and initial != "calculated":
            yield f"{v.get('name')} is no calculated output"
        if real.get("derivative") is not None:
            state = fmu.variables[int(real.get("derivative")) - (version == 2)]
            states[v.get("name")] = state.get("name")
            if v.get("name") != f"der({state.get('name')})":
                yield f"{v.get('name')} is the derivative of {state.get('name')}"
    independent = [v for v in fmu.variables if v.get("causality") == "independent"]
    if len(independent) != 1:
        yield "there is not one independent variable"
    lists = {"Output": "Outputs", "ContinuousStateDerivative": "Derivatives", "InitialUnknown": "InitialUnknowns"}
    found = {}
    for name, in_version_2 in lists.items():
        unknowns = structure.findall(name) if version == 3 else structure.find(in_version_2)
        key = "valueReference" if version == 3 else "index"
        places = [int(unknown.get(key)) - (version == 2) for unknown in unknowns]
        found[name] = [names[place] for place in places]
        for unknown in unknowns:
            known = [int(word) - (version == 2) for word in (unknown.get("dependencies") or "").split()]
            if known != sorted(set(known)) or any(not 0 <= place < len(names) for place in known):
                yield f"{name}: dependencies that are none"
    if found["Output"] != [v.get("name") for v in fmu.variables if v.get("causality") == "output"]:
        yield "the list of outputs is not that of the outputs"
    if found["ContinuousStateDerivative"] != list(states):
        yield "the list of derivatives is not that of the derivatives"
    calculated = [v.get("name") for v in fmu.variables if v.get("initial") == "calculated"]
    if found["InitialUnknown"] != calculated:
        yield "the list of initial unknowns is not that of all calculated variables"


def needs_nothing(fmu):
    needed = subprocess.run(["objdump", "-p", fmu.binary], capture_output=True, text=True, check=True).stdout
    libraries = set(re.findall(r"NEEDED +(\S+)", needed))
    if not libraries <= {"libc.so.6", "libm.so.6", "ld-linux-x86-64.so.2"}:
        yield f"the library needs {libraries}"
