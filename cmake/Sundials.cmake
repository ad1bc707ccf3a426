# chladni_use_cvode(TARGET) gives a test or a benchmark the reference integrator CVODE of SUNDIALS
# (libsundials-dev), or a stand-in that says that it is not there.
find_library(SUNDIALS_CVODE sundials_cvode)
find_library(SUNDIALS_NVECTOR sundials_nvecserial)
find_library(SUNDIALS_CORE sundials_core)  # from SUNDIALS 7 on
find_file(SUNDIALS_CONFIG sundials/sundials_config.h)
set(sundials_needs_mpi "")
if(SUNDIALS_CORE AND SUNDIALS_CONFIG)  # its headers want those of MPI where it is built with MPI
  file(STRINGS ${SUNDIALS_CONFIG} sundials_needs_mpi REGEX "^#define SUNDIALS_MPI_ENABLED +1")
endif()
if(sundials_needs_mpi)
  find_package(MPI QUIET COMPONENTS CXX)
endif()

function(chladni_use_cvode target)
  set(folder ${PROJECT_SOURCE_DIR}/tests/references/squeal)
  if(SUNDIALS_CVODE AND SUNDIALS_NVECTOR AND (NOT sundials_needs_mpi OR TARGET MPI::MPI_CXX))
    target_sources(${target} PRIVATE ${folder}/cvode.cpp)
    target_link_libraries(${target} PRIVATE ${SUNDIALS_CVODE} ${SUNDIALS_NVECTOR} $<$<BOOL:${SUNDIALS_CORE}>:${SUNDIALS_CORE}>
                                            $<$<BOOL:${sundials_needs_mpi}>:MPI::MPI_CXX>)
  else()
    target_sources(${target} PRIVATE ${folder}/no_cvode.cpp)
  endif()
endfunction()
