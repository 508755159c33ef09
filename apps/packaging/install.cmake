# What `cmake --install` and cpack put where: programs (bin), the libraries with their headers and
# find_package(pushid), the workflow. Components become Debian packages, so that fitting
# recordings needs neither headers nor LibTorch.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(pushid_libraries models restoration peers datasets residuals adjoint ident large_networks peer_files forecasts)
install(TARGETS pushid_options EXPORT pushid_targets)
set_target_properties(pushid_options PROPERTIES EXPORT_NAME options)
foreach(library ${pushid_libraries})
  set_target_properties(pushid_${library} PROPERTIES EXPORT_NAME ${library})
  install(TARGETS pushid_${library} EXPORT pushid_targets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
endforeach()
foreach(room models datasets residuals ident)
  install(DIRECTORY ${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/pushid COMPONENT development
          FILES_MATCHING PATTERN "*.h")
endforeach()

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/pushid)
install(EXPORT pushid_targets NAMESPACE pushid:: FILE pushidTargets.cmake
        DESTINATION ${package_folder} COMPONENT development)
configure_package_config_file(apps/packaging/pushidConfig.cmake.in ${PROJECT_BINARY_DIR}/pushidConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
# Before 1.0 every minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/pushidConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pushidConfig.cmake ${PROJECT_BINARY_DIR}/pushidConfigVersion.cmake
        DESTINATION ${package_folder} COMPONENT development)

get_property(programs GLOBAL PROPERTY PUSHID_PROGRAMS)
foreach(program ${programs})
  set(component programs)
  if(program MATCHES "^pushid-train-")
    set(component training)
  endif()
  install(TARGETS ${program} COMPONENT ${component})
  string(REPLACE pushid-command pushid page ${program})
  install(FILES ${PUSHID_MANUAL}/${page}.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component})
endforeach()
install(DIRECTORY apps/schemas DESTINATION ${CMAKE_INSTALL_DATADIR}/pushid COMPONENT programs)
install(DIRECTORY apps/workflow DESTINATION ${CMAKE_INSTALL_DATADIR}/pushid COMPONENT programs
        USE_SOURCE_PERMISSIONS)
install(DIRECTORY ${PROJECT_BINARY_DIR}/share/pushid/models DESTINATION ${CMAKE_INSTALL_DATADIR}/pushid COMPONENT programs)
install(FILES README.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT programs)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR pushid)
set(CPACK_PACKAGE_CONTACT "the pushid project")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL programs development)
if(PUSHID_TORCH)
  list(APPEND CPACK_COMPONENTS_ALL training)
endif()
if(PUSHID_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME pushid)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS snakemake)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libpushid-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libceres-dev, libeigen3-dev, nlohmann-json3-dev, libxxhash-dev, libsqlite3-dev")
set(CPACK_DEBIAN_TRAINING_PACKAGE_NAME pushid-training)
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-pushid)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3, python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS python3-matplotlib)
include(CPack)
