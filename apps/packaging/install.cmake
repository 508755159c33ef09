# What `cmake --install` and cpack put where: programs (bin), the libraries with their headers and
# find_package(pushid), the workflow. Components become Debian packages, so that fitting
# recordings needs neither headers nor LibTorch.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS pushid_options EXPORT pushid_targets)
set_target_properties(pushid_options PROPERTIES EXPORT_NAME options)
foreach(library ${PUSHID_LIBRARIES} generators forecasts)
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

set(private_folder ${CMAKE_INSTALL_LIBDIR}/pushid)
install(TARGETS pushid_shared pushid_forecasts_shared LIBRARY DESTINATION ${private_folder} COMPONENT programs NAMELINK_SKIP)
get_property(programs GLOBAL PROPERTY PUSHID_PROGRAMS)
foreach(program ${programs})
  set_target_properties(${program} PROPERTIES INSTALL_RPATH "$ORIGIN/../${private_folder}")
  set(component programs)
  if(program MATCHES "^pushid-train-")
    set(component training)
  endif()
  install(TARGETS ${program} COMPONENT ${component})
endforeach()
install(DIRECTORY apps/schemas DESTINATION ${CMAKE_INSTALL_DATADIR}/pushid COMPONENT programs)
install(DIRECTORY apps/workflow DESTINATION ${CMAKE_INSTALL_DATADIR}/pushid COMPONENT programs
        USE_SOURCE_PERMISSIONS)
install(DIRECTORY ${PROJECT_BINARY_DIR}/share/pushid/models DESTINATION ${CMAKE_INSTALL_DATADIR}/pushid COMPONENT programs)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT programs)

# Debian packages, a component each (tests/install/consumer_test.sh).
function(pushid_package component name synopsis)
  string(TOUPPER ${component} key)
  set(CPACK_DEBIAN_${key}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_DESCRIPTION "${synopsis}" PARENT_SCOPE)
  install(FILES LICENSE RENAME copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component})
endfunction()
pushid_package(programs pushid "estimates how pushed people balance, from motion capture")
pushid_package(development libpushid-dev "libraries and headers of pushid")
set(CPACK_COMPONENTS_ALL programs development)
if(PUSHID_TORCH)
  pushid_package(training pushid-training "training of pushid's networks, by LibTorch")
  list(APPEND CPACK_COMPONENTS_ALL training)
endif()
if(PUSHID_PYTHON)
  pushid_package(python python3-pushid "import pushid: fits recordings of pushed people")
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR pushid)
set(CPACK_PACKAGE_CONTACT "The pushid authors <nobody@pushid.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "balance and recovery of pushed people, from motion capture")
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/ident)
set(CPACK_DEBIAN_TRAINING_PACKAGE_DEPENDS "pushid (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS snakemake)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libceres-dev, libeigen3-dev, nlohmann-json3-dev, libxxhash-dev")
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3, python3-numpy, python3-yaml")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS python3-matplotlib)
include(CPack)
