"""Spack recipe of Chladni.

From the sources that this file stands in, without a release:

    spack repo create ~/chladni-repo chladni_repo && spack repo add ~/chladni-repo
    mkdir -p ~/chladni-repo/packages/chladni && cp packaging/spack/package.py ~/chladni-repo/packages/chladni
    spack dev-build --source-path "$PWD" chladni@main
"""

from spack.package import *


class Chladni(CMakePackage):
    """Shells, plates and beams on PETSc, reduced by component-mode synthesis to modal bodies, and the
    squeal of a disc between pads."""

    license("BSD-2-Clause")

    # No archive to fetch: `spack dev-build`, or `spack develop --path SOURCES chladni@main`.
    version("main")

    variant("fe", default=True, description="meshes, elements and reduction: the program chladni; else squeal alone")
    variant("python", default=False, description="the Python package chladni")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("python@3.9:", type="build")  # generates pages and completions
    depends_on("googletest", type="test")

    depends_on("eigen@3.4:")
    depends_on("fmt")
    depends_on("tomlplusplus")
    depends_on("cli11")
    depends_on("nlohmann-json@3:")
    depends_on("hdf5@1.10:~mpi+hl")  # one rank writes, and `squeal` links no MPI
    depends_on("zlib-api")

    with when("+fe"):
        depends_on("mpi")
        # Real numbers; ~hdf5, since that of PETSc would be the parallel one.
        depends_on("petsc@3.18:~complex~hdf5+mumps+metis+shared")
        depends_on("slepc@3.18:~arpack")
        depends_on("mumps+mpi+metis+double+complex")  # zmumps too, for the sound field
        depends_on("metis@5:")
        depends_on("openblas")
        depends_on("gmsh@4.8:+opencascade~fltk+shared")
        depends_on("muparser")

    with when("+python"):
        extends("python")
        depends_on("py-pybind11@2.10:", type="build")
        depends_on("py-numpy", type=("build", "run"))
        depends_on("py-h5py", type="run")

    generator("ninja")

    def cmake_args(self):
        arguments = [
            self.define_from_variant("CHLADNI_FE", "fe"),
            self.define_from_variant("CHLADNI_PYTHON", "python"),
            self.define("BUILD_TESTING", self.run_tests),
            self.define("CMAKE_UNITY_BUILD", True),
            self.define("CMAKE_UNITY_BUILD_BATCH_SIZE", "12"),
        ]
        if "+python" in self.spec:
            arguments.append(self.define("PYTHON_EXECUTABLE", self.spec["python"].command.path))
        return arguments

    def setup_build_environment(self, env):
        # The build asks PETSC_DIR and SLEPC_DIR where pkg-config files are; Spack sets the prefixes.
        if "+fe" in self.spec:
            env.unset("PETSC_ARCH")
