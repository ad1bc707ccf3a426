# Compiles the sources of each target several at a time, for what is built once: the headers of
# Eigen are read, and its templates filled in, once for a dozen sources. tests/tools/batches.py finds
# out which sources can stand together. A batch names them relative to the project, so that compiler
# caches know it again in other folders.

function(chladni_batch target)
  get_target_property(folder ${target} SOURCE_DIR)
  get_target_property(sources ${target} SOURCES)
  set(others ${sources})
  list(FILTER others EXCLUDE REGEX "\\.cpp$")
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  if(NOT sources OR sources MATCHES "^${PROJECT_BINARY_DIR}/batches/")  # which has been done
    return()
  endif()
  list(TRANSFORM sources PREPEND ${folder}/ REGEX "^[^/]")
  execute_process(COMMAND python3 ${PROJECT_SOURCE_DIR}/tests/tools/batches.py ${sources}
                  OUTPUT_VARIABLE batches OUTPUT_STRIP_TRAILING_WHITESPACE
                  COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE "\n" ";" batches "${batches}")
  set(files "")
  foreach(batch IN LISTS batches)
    string(REPLACE " " ";" batch "${batch}")
    set(text "")
    foreach(source IN LISTS batch)
      cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
      string(APPEND text "#include \"${source}\"\n")
    endforeach()
    list(LENGTH files n)
    set(file ${PROJECT_BINARY_DIR}/batches/${target}_${n}.cpp)
    file(CONFIGURE OUTPUT ${file} CONTENT "${text}" @ONLY)
    list(APPEND files ${file})
  endforeach()
  set_target_properties(${target} PROPERTIES SOURCES "${files};${others}")
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
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
