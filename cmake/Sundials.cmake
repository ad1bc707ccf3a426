# chladni_use_cvode(TARGET) gives a test or a benchmark the reference integrator CVODE of SUNDIALS
# (libsundials-dev), or a stand-in that says that it is not there.
find_library(SUNDIALS_CVODE sundials_cvode)
find_library(SUNDIALS_NVECTOR sundials_nvecserial)

function(chladni_use_cvode target)
  set(folder ${PROJECT_SOURCE_DIR}/references/squeal)
  if(SUNDIALS_CVODE AND SUNDIALS_NVECTOR)
    target_sources(${target} PRIVATE ${folder}/cvode.cpp)
    target_link_libraries(${target} PRIVATE ${SUNDIALS_CVODE} ${SUNDIALS_NVECTOR})
  else()
    target_sources(${target} PRIVATE ${folder}/no_cvode.cpp)
  endif()
endfunction()
