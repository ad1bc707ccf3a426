# chladni_library(NAME SOURCES... LINK LIBRARIES...): the static library chladni::NAME of one folder.
function(chladni_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_library(chladni_${name} STATIC ${ARG_SOURCES})
  add_library(chladni::${name} ALIAS chladni_${name})
  target_include_directories(chladni_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_link_libraries(chladni_${name} PUBLIC ${ARG_LINK})
  set_target_properties(chladni_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  chladni_warnings(chladni_${name})
endfunction()

# What takes little of the run time and a quarter of the compiling: not optimised where CHLADNI_QUICK asks so.
set(rarely_at_work chladni_report chladni_report_fe chladni_scene chladni_cli chladni_squeal_case chladni squeal)

function(chladni_warnings target)
  if(CHLADNI_QUICK AND target IN_LIST rarely_at_work)
    target_compile_options(${target} PRIVATE -O0)
  endif()
  # In a batch a source sees what others before it declare for themselves.
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion
                                           $<IF:$<BOOL:${CHLADNI_BATCHES}>,-Wshadow=local,-Wshadow>
                                           # GCC 12 warns of these falsely inside Eigen.
                                           -Wno-maybe-uninitialized -Wno-free-nonheap-object)
  if(CHLADNI_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# chladni_test(NAME SOURCES... LINK LIBRARIES... [RANKS 1 2 3]): a GoogleTest program; with RANKS it
# runs under mpirun once for each number of ranks (its own main initialises PETSc).
function(chladni_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;RANKS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  chladni_warnings(${name})
  target_link_libraries(${name} PRIVATE ${ARG_LINK})
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:$<IF:$<BOOL:${CHLADNI_QUICK}>,-O0,-O1>>)  # half the build time; the libraries do the work
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
