# chladni_library(NAME SOURCES... LINK LIBRARIES...): the static library chladni::NAME of one folder.
function(chladni_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_library(chladni_${name} STATIC ${ARG_SOURCES})
  add_library(chladni::${name} ALIAS chladni_${name})
  target_include_directories(chladni_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_link_libraries(chladni_${name} PUBLIC ${ARG_LINK})
  set_target_properties(chladni_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  chladni_compile(chladni_${name})
endfunction()

# Warnings, and what is read before the first line of each source: standard headers, Eigen and the products that
# replace Eigen's (docs/explanation/decisions/0011-products-are-compiled-once.md).
function(chladni_compile target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion)
  # Of sources that are compiled as one, a source sees what others before it declare for themselves.
  if(NOT CMAKE_UNITY_BUILD)
    target_compile_options(${target} PRIVATE -Wshadow)
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)  # GCC 12 warns of these falsely inside Eigen
    target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized -Wno-free-nonheap-object)
  endif()
  if(CHLADNI_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  # Clang takes a compiled header of other optimisation (but none), not of other visibility, and a program takes none of
  # a library unless both are -fPIC. GCC gains nothing by one; builds with sanitizers optimise their libraries differently.
  get_target_property(visibility ${target} CXX_VISIBILITY_PRESET)
  if(NOT target STREQUAL chladni_products)
    target_link_libraries(${target} PRIVATE chladni::products)
  endif()
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL Clang OR CMAKE_BUILD_TYPE STREQUAL None
     OR NOT visibility STREQUAL CMAKE_CXX_VISIBILITY_PRESET)
    target_compile_options(${target} PRIVATE -include ${PROJECT_SOURCE_DIR}/linear/dense/products.hpp)
  elseif(target STREQUAL chladni_products)
    target_precompile_headers(${target} PRIVATE ${PROJECT_SOURCE_DIR}/linear/dense/precompiled.hpp)
  else()
    target_compile_options(${target} PRIVATE -fPIC)
    target_precompile_headers(${target} REUSE_FROM chladni_products)
  endif()
endfunction()

# chladni_test(NAME SOURCES... LINK LIBRARIES... [RANKS 1 2 3]): a GoogleTest program; with RANKS it
# runs under mpirun once for each number of ranks (its own main initialises PETSc).
function(chladni_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;RANKS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  chladni_compile(${name})
  target_link_libraries(${name} PRIVATE ${ARG_LINK})
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)  # half the build time; the libraries do the work
  target_compile_definitions(${name} PRIVATE CHLADNI_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
  if(NOT ARG_RANKS)
    target_link_libraries(${name} PRIVATE GTest::gtest_main)
    set(label "")
    if(name IN_LIST quick_programs)
      set(label PROPERTIES LABELS quick)
    endif()
    gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 ${label})
    return()
  endif()
  target_link_libraries(${name} PRIVATE GTest::gtest)
  foreach(n IN LISTS ARG_RANKS)
    add_test(NAME ${name}.ranks${n}
             COMMAND ${MPIEXEC_EXECUTABLE} --oversubscribe -n ${n} $<TARGET_FILE:${name}>)
    set_tests_properties(${name}.ranks${n} PROPERTIES PROCESSORS ${n} ENVIRONMENT
      "OPENBLAS_NUM_THREADS=1;OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1")
    label_by_time(${name}.ranks${n})
  endforeach()
endfunction()
