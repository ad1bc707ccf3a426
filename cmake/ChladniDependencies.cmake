# Every dependency is a package of Debian 12 and 13; nothing is downloaded.
find_package(PkgConfig REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)  # 5 follows 3.4, and says that it is not compatible
if(Eigen3_VERSION VERSION_LESS 3.4)
  message(FATAL_ERROR "Chladni needs Eigen 3.4 or newer; found ${Eigen3_VERSION}")
endif()
find_package(fmt REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json 3 REQUIRED)
# The serial HDF5, also in `chladni`: files are written by one rank, and `squeal` must not link MPI.
pkg_search_module(HDF5 REQUIRED IMPORTED_TARGET hdf5-serial hdf5)  # Debian's name, and HDF5's own
find_library(ZLIB_LIBRARY z REQUIRED)  # FMUs are zip archives

# For the Python of the system, which has Debian's numpy and petsc4py; another one is chosen by PYTHON_EXECUTABLE. An
# interpreter without sanitizers loads no module with them.
if(CHLADNI_PYTHON)
  find_program(PYTHON_EXECUTABLE python3 PATHS /usr/bin NO_DEFAULT_PATH)
  execute_process(COMMAND ${PYTHON_EXECUTABLE} -c "import sysconfig; print(sysconfig.get_path('include'))"
                  OUTPUT_VARIABLE python_headers OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(EXISTS ${python_headers}/Python.h AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    find_package(pybind11 2.10 QUIET)
  endif()
  if(NOT pybind11_FOUND)
    message(STATUS "Without the Python package: it needs pybind11-dev and python3-dev, and no sanitizers")
    set(CHLADNI_PYTHON OFF)
  endif()
endif()

if(CHLADNI_FE)
  find_package(MPI REQUIRED COMPONENTS CXX)
  # PETSc and SLEPc of one's own, named as their makefiles name them.
  foreach(package PETSC SLEPC)
    set(folder $ENV{${package}_DIR})
    if(NOT folder)
      continue()
    endif()
    if(EXISTS ${folder}/$ENV{PETSC_ARCH}/lib/pkgconfig)
      set(folder ${folder}/$ENV{PETSC_ARCH})
    elseif(NOT EXISTS ${folder}/lib/pkgconfig)
      message(FATAL_ERROR "${package}_DIR is ${folder} and PETSC_ARCH is \"$ENV{PETSC_ARCH}\", but neither "
                          "${folder}/$ENV{PETSC_ARCH}/lib/pkgconfig nor ${folder}/lib/pkgconfig is there: build it "
                          "first, or unset ${package}_DIR to take that of the system")
    endif()
    set(ENV{PKG_CONFIG_PATH} "${folder}/lib/pkgconfig:$ENV{PKG_CONFIG_PATH}")
    message(STATUS "${package}_DIR: ${folder}")
  endforeach()
  # pkg-config leaves out the folders where compilers look anyway: /usr/include and those in CPATH.
  set(allowed "$ENV{PKG_CONFIG_ALLOW_SYSTEM_CFLAGS}")
  set(ENV{PKG_CONFIG_ALLOW_SYSTEM_CFLAGS} 1)
  pkg_check_modules(PETSC REQUIRED IMPORTED_TARGET petsc>=3.18)
  if(allowed STREQUAL "")
    unset(ENV{PKG_CONFIG_ALLOW_SYSTEM_CFLAGS})
  endif()
  include(PetscConfiguration)
  check_petsc_configuration("${PETSC_INCLUDE_DIRS};${PETSC_INCLUDEDIR}")
  pkg_check_modules(SLEPC REQUIRED IMPORTED_TARGET slepc>=3.18)
  pkg_check_modules(MUPARSER REQUIRED IMPORTED_TARGET muparser)  # formulas of the position
  find_library(GMSH_LIBRARY gmsh REQUIRED)
  # Those that PETSc was built with, where it brought its own.
  find_library(METIS_LIBRARY metis HINTS ${PETSC_LIBRARY_DIRS} ${PETSC_LIBDIR} REQUIRED)
  # The one that PETSc links; its C interface takes an ordering by METIS, which PETSc's does not.
  find_library(MUMPS_LIBRARY dmumps HINTS ${PETSC_LIBRARY_DIRS} ${PETSC_LIBDIR} REQUIRED)
  # Complex equations of the sound field, beside the real PETSc.
  find_library(ZMUMPS_LIBRARY zmumps HINTS ${PETSC_LIBRARY_DIRS} ${PETSC_LIBDIR} REQUIRED)
  # dgemm and dsyrk of the projection; OpenBLAS, since the reference BLAS is five times slower.
  find_library(OPENBLAS_LIBRARY openblas REQUIRED)
endif()
