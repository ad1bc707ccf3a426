"""A PETSC_DIR whose numbers or indices are not Chladni's is refused when CMake configures, by its name and what to do.

Usage: petsc_configuration.py SOURCE_DIR
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

REAL = ["PETSC_USE_REAL_DOUBLE", "PETSC_USE_SHARED_LIBRARIES"]


def petsc_folder(folder, uses):
    """As PETSc's makefiles leave it under PETSC_DIR/PETSC_ARCH, as far as CMake looks before it compiles anything."""
    arch = folder / "arch-opt"
    (arch / "lib/pkgconfig").mkdir(parents=True)
    (arch / "include").mkdir()
    (arch / "lib/pkgconfig/petsc.pc").write_text(
        f"Name: PETSc\nDescription: faked\nVersion: 3.20.1\nCflags: -I{arch}/include\nLibs: -L{arch}/lib\n")  # fmt: skip
    if uses is not None:
        (arch / "include/petscconf.h").write_text("".join(f"#define {name} 1\n" for name in uses))
    return arch


def configured(source, folder, uses, searched=None):
    """What CMake says; `searched` is a variable of the compilers' that names PETSc's headers."""
    folder.mkdir()
    arch = petsc_folder(folder, uses)
    environment = dict(os.environ, PETSC_DIR=str(folder), PETSC_ARCH=arch.name)
    for name in ("SLEPC_DIR", "PKG_CONFIG_ALLOW_SYSTEM_CFLAGS"):
        environment.pop(name, None)
    if searched:
        environment[searched] = str(arch / "include")
    done = subprocess.run(["cmake", "-G", "Ninja", "-S", source, "-B", folder / "build"], env=environment,
                          capture_output=True, text=True, timeout=100, check=False)  # fmt: skip
    return done.returncode, " ".join((done.stdout + done.stderr).split())


def checked(source, folder, uses):
    """What the check alone says, which takes no compiler."""
    folder.mkdir()
    arch = petsc_folder(folder, uses)
    script = folder / "check.cmake"
    script.write_text(f'include({source}/cmake/PetscConfiguration.cmake)\ncheck_petsc_configuration("{arch}/include")\n')
    done = subprocess.run(["cmake", "-P", script], capture_output=True, text=True, timeout=100, check=False)
    return done.returncode, " ".join((done.stdout + done.stderr).split())


def expect(good, claim, said):
    if not good:
        sys.exit(f"FAILED: {claim}\n{said}")
    print(f"ok      {claim}", flush=True)


def main(source):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        refused = {
            "complex": (["PETSC_USE_COMPLEX", *REAL], ["complex numbers", "--with-scalar-type=complex"]),
            # pkg-config does not name the folders that compilers search anyway.
            "CPATH": (["PETSC_USE_COMPLEX", *REAL], ["complex numbers"]),
            "CPLUS_INCLUDE_PATH": (["PETSC_USE_COMPLEX", *REAL], ["complex numbers"]),
            "64bit": ([*REAL, "PETSC_USE_64BIT_INDICES"], ["64-bit indices", "--with-64-bit-indices"]),
            "single": (["PETSC_USE_REAL_SINGLE"], ["single precision", "--with-precision=single"]),
            "none": (None, ["none of them has petscconf.h"]),
        }
        for case, (uses, words) in refused.items():
            if case == "complex" or case.endswith("PATH"):
                code, said = configured(source, folder / case, uses, case if case.endswith("PATH") else None)
            else:
                code, said = checked(source, folder / case, uses)
            expect(code != 0, f"{case}: CMake ends with an error", said)
            for word in [*words, str(folder / case / "arch-opt/include")]:
                expect(word in said, f"{case}: which says {word!r}", said)
            expect("PETSC_DIR" in said, f"{case}: and what to do", said)
        # One of double precision and 32-bit indices passes, whatever the indices of its BLAS are.
        code, said = checked(source, folder / "real", [*REAL, "PETSC_USE_64BIT_BLAS_INDICES"])
        expect(code == 0, "real: is not refused", said)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
