# What `cmake --install` puts where: headers, libraries, the CMake package, pkg-config files.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/xtrack)
install(TARGETS xtrack_core xtrack_gestures EXPORT xtrackTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY core/include/xtrack gestures/include/xtrack
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp")
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(EXPORT xtrackTargets NAMESPACE xtrack:: DESTINATION ${package_dir})
configure_package_config_file(cmake/xtrackConfig.cmake.in xtrackConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(xtrackConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/xtrackConfig.cmake
              ${PROJECT_BINARY_DIR}/xtrackConfigVersion.cmake
              cmake/FindOpenCV.cmake
        DESTINATION ${package_dir})

# pkg-config: a static library makes the user link what it stands on; a shared one does not.
file(RELATIVE_PATH XTRACK_PC_PREFIX ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig
     ${CMAKE_INSTALL_PREFIX})
foreach(part core gestures)
  get_target_property(outside xtrack_${part} XTRACK_OUTSIDE_LIBRARIES)
  set(XTRACK_PC_OUTSIDE "-pthread")
  foreach(library ${outside})
    if(library)
      string(REGEX REPLACE "^.*::" "" library ${library})
      string(TOLOWER ${library} library)  # JPEG::JPEG is libjpeg, PNG::PNG libpng
      string(PREPEND XTRACK_PC_OUTSIDE "-l${library} ")
    endif()
  endforeach()
  set(XTRACK_PC_LIBS "-L\${libdir} -lxtrack_${part}")
  if(NOT BUILD_SHARED_LIBS)
    string(APPEND XTRACK_PC_LIBS " ${XTRACK_PC_OUTSIDE}")
  endif()
  set(XTRACK_PC_NAME xtrack-${part})
  set(XTRACK_PC_REQUIRES "eigen3 >= 3.4")
  if(part STREQUAL "gestures")
    set(XTRACK_PC_REQUIRES "xtrack-core = ${PROJECT_VERSION}")
  endif()
  configure_file(cmake/xtrack.pc.in xtrack-${part}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/xtrack-${part}.pc
          DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()
