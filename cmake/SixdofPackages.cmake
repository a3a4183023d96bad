# Debian packages by `cpack`, one of each component: `sixdof` and `libsixdof-dev`. The programs depend on what their shared
# libraries are in on this system; the library, on what SixdofInstall.cmake lists in `needed`.
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION share/doc/libsixdof-dev RENAME copyright COMPONENT development)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_PACKAGE_CONTACT "The sixdof authors")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_COMPONENTS_ALL development)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libsixdof-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
  "Headers, static libraries and CMake package, with which algorithms of your own are built into the programs.")

list(TRANSFORM needed REPLACE " *#.*" "")
set(depends ${needed})
list(REMOVE_ITEM depends g++ make cmake)
if(SIXDOF_BUILD_BENCH)
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION share/doc/sixdof RENAME copyright COMPONENT programs)
  list(APPEND CPACK_COMPONENTS_ALL programs)
  set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME sixdof)
  set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION science)
  set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS "python3, nodejs, librsvg2-bin, libbenchmark-tools, python3-scipy")
  set(CPACK_COMPONENT_PROGRAMS_DESCRIPTION
    "Programs sixdof, sixdof-bench and sixdof-compare, with configuration sets, lists of rows and pages of results.")
  list(APPEND depends "sixdof (= ${PROJECT_VERSION})")  # its data are the programs' that are built with the library
endif()
list(JOIN depends ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "g++, cmake, ninja-build | make")
include(CPack)
