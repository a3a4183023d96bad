# Installation and export: find_package(sixdof) gives sixdof::sixdof, the backends that were built, and sixdof::bench_main
# and sixdof::cli_main if the programs were built. Nothing installed names its folder: it may be moved. Two components:
# `programs` with their data, and `development`, what programs of others are built with.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/sixdof)
set(data_folder share/sixdof)  # as lib/sixdof/base/data_folder.h looks for it

foreach(backend IN LISTS SIXDOF_BACKENDS)
  if(TARGET sixdof_${backend})
    set(SIXDOF_HAS_${backend} ON)
  endif()
endforeach()
get_property(libraries GLOBAL PROPERTY sixdof_libraries)

# Target install-ready builds what `cmake --install` copies: bench/run builds less, the tests need more. An installation
# that lacks something says so before it copies anything.
# expect_built(COMPONENT TARGET...): the files of these targets must be there when COMPONENT is installed.
function(expect_built component)
  list(TRANSFORM ARGN REPLACE "(.+)" "\"$<TARGET_FILE:\\1>\"" OUTPUT_VARIABLE files)
  list(JOIN files " " files)
  set(first "cmake --build ${PROJECT_BINARY_DIR} --target install-ready")
  install(CODE "
    foreach(file IN ITEMS ${files})
      if(NOT EXISTS \"\${file}\")
        message(FATAL_ERROR \"\${file} is not built yet. First: ${first}\")
      endif()
    endforeach()" COMPONENT ${component})
endfunction()
if(PROJECT_IS_TOP_LEVEL)
  add_custom_target(install-ready)
  add_dependencies(install-ready ${libraries})
  expect_built(development ${libraries})
  if(SIXDOF_BUILD_BENCH)
    add_dependencies(install-ready sixdof_program sixdof-bench sixdof_completions)
    expect_built(programs sixdof_program sixdof-bench)
  endif()
endif()

# In an export of its own: a project without GoogleTest has everything else.
list(REMOVE_ITEM libraries sixdof_conformance)
if(TARGET sixdof_conformance)
  set(SIXDOF_HAS_conformance ON)
  install(TARGETS sixdof_conformance EXPORT sixdof_conformance
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  install(EXPORT sixdof_conformance NAMESPACE sixdof:: DESTINATION ${package_folder}
    FILE sixdof-conformance-targets.cmake COMPONENT development)
endif()
install(TARGETS ${libraries} EXPORT sixdof
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
install(EXPORT sixdof NAMESPACE sixdof:: DESTINATION ${package_folder} FILE sixdof-targets.cmake COMPONENT development)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/lib/sixdof DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
  FILES_MATCHING PATTERN "*.h" PATTERN "query/README.md" PATTERN "process/README.md" PATTERN "conformance/README.md"
  PATTERN "*-inl.h" EXCLUDE)

if(SIXDOF_BUILD_BENCH)
  install(TARGETS sixdof_program sixdof-bench RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
  install(PROGRAMS ${PROJECT_SOURCE_DIR}/bench/compare DESTINATION ${CMAKE_INSTALL_BINDIR} RENAME sixdof-compare
    COMPONENT programs)
  install(PROGRAMS ${PROJECT_SOURCE_DIR}/bench/gate ${PROJECT_SOURCE_DIR}/bench/compare  # of sixdof gate
    DESTINATION ${data_folder}/bench COMPONENT programs)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/bench/scripts DESTINATION ${data_folder}/bench COMPONENT programs
    FILES_MATCHING PATTERN "gate_*.py")
  install(FILES ${PROJECT_SOURCE_DIR}/bench/all_algorithms_suite.json ${PROJECT_SOURCE_DIR}/bench/default_suite.json
    ${PROJECT_SOURCE_DIR}/bench/own_pair_suite.json ${PROJECT_SOURCE_DIR}/bench/paper_suite.json
    ${PROJECT_SOURCE_DIR}/bench/scenes_suite.json
    DESTINATION ${data_folder}/bench COMPONENT programs)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/bench/new_algorithm ${PROJECT_SOURCE_DIR}/bench/external
    DESTINATION ${data_folder}/bench COMPONENT programs)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/fixtures DESTINATION ${data_folder} COMPONENT programs
    FILES_MATCHING PATTERN "manifest.json" PATTERN "*.h5" PATTERN "whole_file.py")
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/lib/sixdof/report/page ${PROJECT_SOURCE_DIR}/lib/sixdof/report/figures
    ${PROJECT_BINARY_DIR}/share/sixdof/report/vendor
    DESTINATION ${data_folder}/report COMPONENT programs)
  install(FILES ${PROJECT_SOURCE_DIR}/models/models.json ${PROJECT_SOURCE_DIR}/models/collection.json
    DESTINATION ${data_folder}/models COMPONENT programs)
  install(PROGRAMS ${PROJECT_SOURCE_DIR}/models/fetch DESTINATION ${data_folder}/models COMPONENT programs)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/linked_data_folder.cpp DESTINATION ${data_folder}/cmake
    COMPONENT development)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/share/bash-completion DESTINATION share COMPONENT programs)
endif()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/sixdof-config.cmake.in
  ${PROJECT_BINARY_DIR}/sixdof-config.cmake
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sixdof-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/sixdof-config.cmake ${PROJECT_BINARY_DIR}/sixdof-config-version.cmake
  ${PROJECT_SOURCE_DIR}/cmake/SixdofCommit.cmake ${PROJECT_SOURCE_DIR}/cmake/SixdofCommitHeader.cmake
  DESTINATION ${package_folder} COMPONENT development)

# What a project needs that uses the package, by Debian's names. test/downstream/chroot installs these and nothing else.
set(needed
  "g++                 # compiler"
  "make                # or ninja-build"
  "cmake               # find_package(sixdof)"
  "pkg-config          # finds libraries that have no CMake package"
  "libeigen3-dev       # part of the interface"
  "libtbb-dev" "libfmt-dev" "nlohmann-json3-dev" "libassimp-dev" "libhdf5-dev" "libxxhash-dev" "libhwy-dev")
set(needed_by_fcl libfcl-dev)
set(needed_by_bullet libbullet-dev)
set(needed_by_ode libode-dev)
set(needed_by_embree libembree-dev)
set(needed_by_gts libgts-dev)
set(needed_by_simbody libsimbody-dev)
set(needed_by_ccd libccd-dev)
set(needed_by_mujoco libmujoco-dev)
set(needed_by_cgal libcgal-dev)
foreach(backend IN LISTS SIXDOF_BACKENDS)
  if(SIXDOF_HAS_${backend})
    foreach(package IN LISTS needed_by_${backend})
      list(APPEND needed "${package}  # backend ${backend}")
    endforeach()
  endif()
endforeach()
if(SIXDOF_BUILD_BENCH)
  list(APPEND needed "libbenchmark-dev    # programs of your own: sixdof::bench_main, sixdof::cli_main")
endif()
if(SIXDOF_HAS_conformance)
  list(APPEND needed "libgtest-dev        # tests of your own: sixdof::conformance")
endif()
list(JOIN needed "\n" lines)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/packages.txt CONTENT "${lines}\n")
install(FILES ${PROJECT_BINARY_DIR}/packages.txt DESTINATION ${data_folder} COMPONENT development)

# pkg-config, for the core library alone.
file(RELATIVE_PATH prefix_of_pc /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(${PROJECT_SOURCE_DIR}/cmake/sixdof.pc.in ${PROJECT_BINARY_DIR}/sixdof.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/sixdof.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

if(PROJECT_IS_TOP_LEVEL)
  include(SixdofPackages)
endif()
