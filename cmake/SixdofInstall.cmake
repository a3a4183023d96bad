# Installation and export: find_package(sixdof) gives sixdof::sixdof and the backends that were built.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(sixdof_install_targets sixdof)
foreach(backend IN ITEMS fcl bullet ode)
  if(TARGET sixdof_${backend})
    list(APPEND sixdof_install_targets sixdof_${backend})
    set(SIXDOF_HAS_${backend} ON)
  endif()
endforeach()
install(TARGETS ${sixdof_install_targets} EXPORT sixdof
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT sixdof NAMESPACE sixdof:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sixdof FILE sixdof-targets.cmake)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/lib/sixdof DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.h" PATTERN "*-inl.h" EXCLUDE)

foreach(program IN ITEMS sixdof_program sixdof-bench)
  if(TARGET ${program})
    install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  endif()
endforeach()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/sixdof-config.cmake.in
  ${PROJECT_BINARY_DIR}/sixdof-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sixdof)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sixdof-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/sixdof-config.cmake ${PROJECT_BINARY_DIR}/sixdof-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sixdof)
