"""What is installed serves a project of its own, and the Debian packages hold what they should.

Usage: install.py BUILD_DIR
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
LIBRARY = ROOT / "examples/library"
sys.path.insert(0, str(ROOT / "tests/integration"))
import plugin_page  # noqa: E402


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if done.returncode:
        sys.exit(f"FAILED: {' '.join(map(str, command))}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}")
    return done.stdout


def require(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")
    print(f"ok      {what}", flush=True)


def build_consumer(source, build, prefix):
    run("cmake", "-G", "Ninja", "-S", source, "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}",
        "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")  # fmt: skip
    run("cmake", "--build", build)


def use_programs(prefix, folder):
    """The installed programs make the body that the consumers read."""
    scene = ROOT / "tests/data/coarse_disc.toml"
    run(prefix / "bin/chladni", "run", scene, "--output", folder)
    run(prefix / "bin/chladni", "mesh", ROOT / "examples/hat_disc/hat_disc.geo", "--output", folder)  # in the program of libexec
    return next(folder.glob("*.body.h5"))


def use_libraries(prefix, folder, body):
    build_consumer(LIBRARY, folder / "all", prefix)
    programs = {**os.environ, "PATH": f"{prefix / 'bin'}:{os.environ['PATH']}"}  # the mesher is looked for beside them
    said = run(folder / "all/reduce_disc", env=programs)
    require("6 masters and 10 modes" in said, f"a C++ program on the FE libraries: {said.strip()}")
    said = run(folder / "all/brake", body)
    require("squeals from" in said, f"a C++ program on squeal: {said.strip()}")
    said = run(folder / "all/membrane", "-n", "20")
    require(said.strip(), "a C program on the PETSc class")

    build_consumer(LIBRARY / "light", folder / "light", prefix)
    cache = (folder / "light/CMakeCache.txt").read_text()
    require("PETSC" not in cache and "MPI_CXX" not in cache, "find_package(chladni COMPONENTS squeal) asks for no PETSc")
    linked = run("ldd", folder / "light/brake")
    require("petsc" not in linked and "mpi" not in linked, "nor does its program link it")


def use_pkg_config(prefix, folder, body):
    environment = {**os.environ, "PKG_CONFIG_PATH": str(prefix / "lib/pkgconfig")}
    flags = run("pkg-config", "--cflags", "--libs", "chladni", env=environment).split()
    run("c++", LIBRARY / "light/brake.cpp", "-o", folder / "brake", *flags)
    require("squeals from" in run(folder / "brake", body), "pkg-config chladni")
    flags = run("pkg-config", "--cflags", "--libs", "chladni-petsc", env=environment).split()
    run("mpicc", ROOT / "examples/plugin/membrane.c", "-o", folder / "membrane", *flags, "-lm")
    run(folder / "membrane", "-n", "20", env={**os.environ, "LD_LIBRARY_PATH": str(prefix / "lib")})
    require(True, "pkg-config chladni-petsc")


def use_plugin_page(prefix, folder):
    """The program of docs/how-to/plugin.md, compiled as the page says of an installed library."""
    folder = folder / "page"
    folder.mkdir()
    by_pkg_config = next(block for block in plugin_page.blocks("sh") if "PKG_CONFIG_PATH" in block)
    plugin_page.runs(folder, by_pkg_config.replace("/opt/chladni", str(prefix)), {})
    (folder / "CMakeLists.txt").write_text(plugin_page.blocks("cmake")[0])
    plugin_page.runs(folder, f"cmake -B build -DCMAKE_PREFIX_PATH={prefix}\ncmake --build build\nmv build/reduce .", {})


def use_debs(build, folder):
    run("cpack", "--config", build / "CPackConfig.cmake", "-B", folder / "debs")
    debs = {file.name.split("_")[0]: file for file in (folder / "debs").glob("*.deb")}
    require(set(debs) == {"chladni", "chladni-squeal", "libchladni-dev"}, f"Debian packages {sorted(debs)}")
    for name, file in debs.items():
        run("dpkg-deb", "-x", file, folder / name)
    light = run("dpkg-deb", "-f", debs["chladni-squeal"], "Depends")
    require("libhdf5" in light and "petsc" not in light, f"chladni-squeal depends on {light.strip()}")
    require("petsc" in run("dpkg-deb", "-f", debs["chladni"], "Depends"), "chladni depends on PETSc")
    said = run(folder / "chladni-squeal/usr/bin/squeal", "run", ROOT / "examples/oscillator/scene.toml",
               "--output", folder)  # fmt: skip
    require("wrote" in said, "squeal runs from its package")
    require("chladni" in run(folder / "chladni/usr/bin/chladni", "--version"), "so does chladni")
    for package, program in (("chladni-squeal", "squeal"), ("chladni", "chladni")):
        share = folder / package / "usr/share"
        require(f".TH {program} 1" in (share / f"man/man1/{program}.1").read_text(), f"{program} has a manual page")
        require(f"complete -o filenames -F _{program} {program}" in
                (share / f"bash-completion/completions/{program}").read_text(), "and bash completes it")
    plugin = list((folder / "chladni").rglob("libchladni_petsc.so"))
    require(len(plugin) == 1, "and the plugin is in it")


def main(build):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        prefix = folder / "prefix"
        run("cmake", "--install", build, "--prefix", prefix)
        body = use_programs(prefix, folder)
        use_libraries(prefix, folder, body)
        use_pkg_config(prefix, folder, body)
        use_plugin_page(prefix, folder)
        use_debs(build, folder)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
