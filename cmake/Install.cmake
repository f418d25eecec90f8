# SPDX-FileCopyrightText: 2026 The opp-mapping authors
# SPDX-License-Identifier: BSD-3-Clause
# Installation for users of the libraries: find_package(opp COMPONENTS opp mapping).
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/opp)

foreach(component opp mapping)
  set(target opp_${component})
  if(component STREQUAL opp)
    set(target opp)
  endif()
  install(TARGETS ${target} EXPORT opp-${component}-targets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY libs/${component}/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  # Two sets of targets: who asks for opp alone needs neither MRPT nor OctoMap.
  install(EXPORT opp-${component}-targets NAMESPACE opp:: DESTINATION ${package_folder})
endforeach()

configure_package_config_file(cmake/oppConfig.cmake.in ${PROJECT_BINARY_DIR}/oppConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
# Below 1.0 a new minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/oppConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/oppConfig.cmake ${PROJECT_BINARY_DIR}/oppConfigVersion.cmake
        DESTINATION ${package_folder})
install(DIRECTORY config/ DESTINATION ${CMAKE_INSTALL_DATADIR}/opp-mapping/config)
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
