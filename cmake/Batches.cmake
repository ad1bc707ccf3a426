# Compiles the sources of each target several at a time, for builds that are made once and thrown
# away: the headers of Eigen are read once for a dozen sources. tests/tools/batches.py finds out
# which sources can stand together.

function(chladni_batch target)
  get_target_property(folder ${target} SOURCE_DIR)
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  if(NOT sources)
    return()
  endif()
  list(TRANSFORM sources PREPEND ${folder}/ REGEX "^[^/]")
  execute_process(COMMAND python3 ${PROJECT_SOURCE_DIR}/tests/tools/batches.py ${sources}
                  OUTPUT_VARIABLE batches OUTPUT_STRIP_TRAILING_WHITESPACE
                  COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE "\n" ";" batches "${batches}")
  set(n 0)
  foreach(batch IN LISTS batches)
    string(REPLACE " " ";" batch "${batch}")
    math(EXPR n "${n} + 1")
    set_source_files_properties(${batch} TARGET_DIRECTORY ${target}
                                PROPERTIES UNITY_GROUP ${target}_${n})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# Of a folder and those below it.
function(chladni_batch_all folder)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    if(type MATCHES "EXECUTABLE|_LIBRARY" AND NOT type STREQUAL "INTERFACE_LIBRARY")
      chladni_batch(${target})
    endif()
  endforeach()
  get_property(below DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(subfolder IN LISTS below)
    chladni_batch_all(${subfolder})
  endforeach()
endfunction()
