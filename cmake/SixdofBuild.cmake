# Compiler settings shared by every target of this project, kept off its embedders.

if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

find_program(SIXDOF_CCACHE ccache)
if(PROJECT_IS_TOP_LEVEL AND SIXDOF_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Without the first, it keeps nothing that was compiled with a precompiled header; without the second, nothing for
  # another clone of this project.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros
    CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} ${SIXDOF_CCACHE})
endif()

# Strict warnings, sanitizers and floating-point rules for our own code. Contraction (fused multiply-add) is off because
# exact results must be the same bits on every instruction set.
add_library(sixdof_build_flags INTERFACE)
target_compile_features(sixdof_build_flags INTERFACE cxx_std_20)
target_compile_options(sixdof_build_flags INTERFACE
  -Wall -Wextra -Wconversion -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align
  # Designated initializers may leave members to their defaults; gcc 12 sees overlaps in std::string that are not there.
  -Wno-missing-field-initializers $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> -ffp-contract=off)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64|ARM64)$")
  # Products of Eigen's small matrices would fuse them all the same, by the functions for NEON that this macro chooses.
  target_compile_options(sixdof_build_flags INTERFACE -U__ARM_FEATURE_FMA)
endif()
if(SIXDOF_SANITIZE)
  target_compile_options(sixdof_build_flags INTERFACE -fsanitize=${SIXDOF_SANITIZE} -fno-sanitize-recover=all)
  target_link_options(sixdof_build_flags INTERFACE -fsanitize=${SIXDOF_SANITIZE})
endif()

# sixdof_library(TARGET SOURCES...): a library of this project, exported and installed as sixdof::NAME.
function(sixdof_library target)
  add_library(${target} STATIC ${ARGN})
  set_property(GLOBAL APPEND PROPERTY sixdof_libraries ${target})
  string(REGEX REPLACE "^sixdof_" "" export_name ${target})
  add_library(sixdof::${export_name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${export_name} POSITION_INDEPENDENT_CODE ON)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/lib> $<INSTALL_INTERFACE:include>)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:sixdof_build_flags>)
endfunction()
