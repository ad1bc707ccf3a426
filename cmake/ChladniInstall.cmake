# What `cmake --install` puts where, the CMake and pkg-config packages, and the Debian packages.
# Components: squeal (program, no PETSc), fe (program chladni and the PETSc plugin), dev (headers,
# static libraries and what finds them).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/chladni)
set(light_libraries common products files dense fmu mbs_export squeal_options squeal_brake squeal)
set(fe_libraries petsc linear confinement mesh elements plate reduce air_of_gmsh sound)

# chladni_export(SET LIBRARIES...): those that are built become chladni::NAME of the package.
function(chladni_export set)
  foreach(library IN LISTS ARGN)
    if(NOT TARGET chladni_${library})
      continue()
    endif()
    set_target_properties(chladni_${library} PROPERTIES EXPORT_NAME ${library})
    install(TARGETS chladni_${library} EXPORT ${set}
            ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev
            INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/chladni)
  endforeach()
  install(EXPORT ${set} NAMESPACE chladni:: DESTINATION ${config_folder} COMPONENT dev)
endfunction()

chladni_export(chladni-squeal-targets ${light_libraries})
# A program with its manual page and with what shells need to complete its commands.
function(chladni_install_program program component)
  install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${component})
  set(folder ${PROJECT_BINARY_DIR}/share/${program})
  install(FILES ${folder}/${program}.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component})
  install(FILES ${folder}/${program}.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
          RENAME ${program} COMPONENT ${component})
  install(FILES ${folder}/_${program} DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT ${component})
  install(FILES ${folder}/${program}.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
          COMPONENT ${component})
endfunction()

chladni_install_program(squeal squeal)
if(CHLADNI_FE)
  chladni_export(chladni-fe-targets ${fe_libraries})
  chladni_install_program(chladni fe)
  install(TARGETS chladni_fmu_binary chladni_fmu_brake_binary LIBRARY DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/chladni COMPONENT fe)
  install(TARGETS chladni_mesher RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/chladni COMPONENT fe)
  set_target_properties(chladni_petsc_plugin PROPERTIES EXPORT_NAME cms)
  install(TARGETS chladni_petsc_plugin EXPORT chladni-plugin-targets
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT fe
          PUBLIC_HEADER DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev
          INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT chladni-plugin-targets NAMESPACE chladni:: DESTINATION ${config_folder}
          COMPONENT dev)
endif()

# The headers of the interface, which the README.md of each folder names; what they include is installed
# with them and may change without notice.
set(light_headers
    common/error.hpp
    common/files/hdf5.hpp
    common/files/seal.hpp
    linear/dense/dense_solvers.hpp
    linear/dense/eigenmodes.hpp
    mbs_export/make_body.hpp
    mbs_export/check_body.hpp
    mbs_export/held_modes.hpp
    mbs_export/inertia.hpp
    mbs_export/files/body_files.hpp
    mbs_export/files/body_files.hpp
    mbs_export/formats/export_error.hpp
    mbs_export/formats/formats.hpp
    mbs_export/formats/fmu_archive.hpp
    mbs_export/formats/formats.hpp
    mbs_export/formats/formats.hpp
    mbs_export/formats/formats.hpp
    mbs_export/formats/formats.hpp
    squeal/brake/disc.hpp
    squeal/study/study.hpp
    squeal/results/squeal_results.hpp
    squeal/stability/stability_search.hpp
    squeal/stability/stability_map.hpp
    squeal/stability/rotation_stability.hpp
    squeal/cycle/limit_cycle_direct.hpp
    squeal/cycle/limit_cycle_branch.hpp
    squeal/transient/transient.hpp
    squeal/models/brake.hpp
    squeal/models/flexible_disc.hpp
    squeal/models/brake.hpp
    squeal/models/rigid_disc.hpp
    squeal/brake/pad_system.hpp
    squeal/brake/radiation.hpp)
set(fe_headers
    common/petsc.hpp
    linear/kernels/dense_matrices.hpp
    linear/kernels/small_matrices.hpp
    linear/cholesky/factorization.hpp
    linear/cholesky/sylvester.hpp
    linear/lanczos/block_lanczos.hpp
    linear/progress.hpp
    linear/solver_options.hpp
    mesh/generators.hpp
    mesh/mesh.hpp
    mesh/partition.hpp
    mesh/quality.hpp
    plate/elements/beam_element.hpp
    plate/elements/shell_element.hpp
    plate/dofs/dof_map.hpp
    plate/dofs/free_motions.hpp
    plate/dofs/dof_map.hpp
    plate/assembly/assemble.hpp
    plate/assembly/assemble.hpp
    plate/assembly/recovery.hpp
    plate/assembly/assemble.hpp
    reduce/craig_bampton.hpp
    reduce/reduction.hpp
    reduce/support.hpp
    reduce/craig_bampton.hpp
    reduce/craig_bampton.hpp
    reduce/static_condensation.hpp
    reduce/mixed_interface.hpp
    reduce/error_estimates.hpp
    reduce/completeness.hpp
    reduce/tolerance_search.hpp
    reduce/supported_solutions.hpp
    reduce/reduced_system.hpp
    sound/study.hpp
    sound/sound_file.hpp
    sound/field.hpp)

# chladni_with_included(OUT HEADERS...): these and what they include of the project.
function(chladni_with_included out)
  set(headers "")
  set(next ${ARGN})
  while(next)
    list(POP_FRONT next header)
    if(header IN_LIST headers)
      continue()
    endif()
    list(APPEND headers ${header})
    file(STRINGS ${PROJECT_SOURCE_DIR}/${header} lines REGEX "^#include \"")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" name "${line}")
      list(APPEND next ${name})
    endforeach()
  endwhile()
  set(${out} ${headers} PARENT_SCOPE)
endfunction()

set(interface ${light_headers})
if(CHLADNI_FE)
  list(APPEND interface ${fe_headers})
endif()
chladni_with_included(headers ${interface})
foreach(header IN LISTS headers)
  cmake_path(GET header PARENT_PATH folder)
  install(FILES ${PROJECT_SOURCE_DIR}/${header}
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/chladni/${folder} COMPONENT dev)
endforeach()

configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/chladni-config.cmake.in ${PROJECT_BINARY_DIR}/chladni-config.cmake
  INSTALL_DESTINATION ${config_folder} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/chladni-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/chladni-config.cmake
              ${PROJECT_BINARY_DIR}/chladni-config-version.cmake
        DESTINATION ${config_folder} COMPONENT dev)

set(pkg_config_files chladni)
if(CHLADNI_FE)
  list(APPEND pkg_config_files chladni-petsc)
endif()
file(RELATIVE_PATH pkg_config_prefix /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
foreach(file IN LISTS pkg_config_files)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/${file}.pc.in ${PROJECT_BINARY_DIR}/${file}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${file}.pc
          DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)
endforeach()

foreach(component squeal fe dev)
  set(package_of_squeal chladni-squeal)
  set(package_of_fe chladni)
  set(package_of_dev libchladni-dev)
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package_of_${component}} RENAME copyright
          COMPONENT ${component})
endforeach()

set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # `programs` is enough
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The Chladni authors <chladni@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Modal bodies of plates and shells, and their squeal")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_SQUEAL_PACKAGE_NAME chladni-squeal)
set(CPACK_DEBIAN_FE_PACKAGE_NAME chladni)
set(CPACK_DEBIAN_FE_PACKAGE_RECOMMENDS openmpi-bin)
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libchladni-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libeigen3-dev, libfmt-dev, libhdf5-dev, zlib1g-dev")
set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS
    "libpetsc-real-dev, libslepc-real-dev, libmetis-dev, libmumps-dev, libmuparser-dev, libopenblas-dev")
set(CPACK_COMPONENTS_ALL squeal dev)
if(CHLADNI_FE)
  list(APPEND CPACK_COMPONENTS_ALL fe)
endif()
include(CPack)

# All that is installed, without the tests: for packages.
add_custom_target(programs)
foreach(target chladni_petsc_plugin chladni_self_description squeal_self_description)
  if(TARGET ${target})
    add_dependencies(programs ${target})
  endif()
endforeach()
foreach(library IN LISTS light_libraries fe_libraries)
  if(TARGET chladni_${library})
    add_dependencies(programs chladni_${library})
  endif()
endforeach()
