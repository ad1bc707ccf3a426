# What `cmake --install` puts where, the CMake and pkg-config packages, and the Debian packages.
# Components: squeal (program, no PETSc), fe (program chladni and the PETSc plugin), dev (headers,
# static libraries and what finds them).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/chladni)
set(light_libraries common mbs_export squeal)
set(fe_libraries petsc mesh elements plate reduce reduce_export sound)
set(header_folders common mbs_export squeal mesh plate reduce reduce_export sound)

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
install(TARGETS squeal RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT squeal)
if(CHLADNI_FE)
  chladni_export(chladni-fe-targets ${fe_libraries})
  install(TARGETS chladni RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT fe)
  set_target_properties(chladni_petsc_plugin PROPERTIES EXPORT_NAME cms)
  install(TARGETS chladni_petsc_plugin EXPORT chladni-plugin-targets
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT fe
          PUBLIC_HEADER DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev
          INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT chladni-plugin-targets NAMESPACE chladni:: DESTINATION ${config_folder}
          COMPONENT dev)
endif()

foreach(folder IN LISTS header_folders)
  if(NOT CHLADNI_FE AND NOT folder IN_LIST light_libraries)
    continue()
  endif()
  if(EXISTS ${PROJECT_SOURCE_DIR}/${folder})
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder}
            DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/chladni COMPONENT dev
            FILES_MATCHING PATTERN "*.hpp" PATTERN plugin EXCLUDE)
  endif()
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
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libeigen3-dev, libfmt-dev, libhdf5-dev")
set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS
    "libpetsc-real-dev, libslepc-real-dev, libgmsh-dev, libmetis-dev, libmumps-dev, libmuparser-dev, libopenblas-dev")
set(CPACK_COMPONENTS_ALL squeal dev)
if(CHLADNI_FE)
  list(APPEND CPACK_COMPONENTS_ALL fe)
endif()
include(CPack)
