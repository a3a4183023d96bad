# Configures without any backend, and with packages of the optional ones that pkg-config cannot use: both work, the
# second says what is left out, and the list of algorithms compiles. What is not built is not installed.
function(run output_variable)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(result)
    message(FATAL_ERROR "${ARGN}\nexited with ${result}:\n${output}")
  endif()
  set(${output_variable} "${output}" PARENT_SCOPE)
endfunction()

function(expect_no_backend build)
  file(READ ${build}/build.ninja rules)
  foreach(backend IN LISTS ARGN)
    if(rules MATCHES "libsixdof_${backend}")
      message(FATAL_ERROR "${build} builds the backend ${backend}")
    endif()
  endforeach()
  run(output ${CMAKE_COMMAND} --build ${build}
    --target bench/CMakeFiles/sixdof_bench_common.dir/common/all_algorithms.cpp.o)
endfunction()

file(REMOVE_RECURSE ${WORK}/without ${WORK}/unusable ${WORK}/pkgconfig ${WORK}/prefix)
set(configure ${CMAKE_COMMAND} -G Ninja -S ${SOURCE} -DSIXDOF_BUILD_TESTS=OFF -DSIXDOF_INSTALL=OFF)
run(output ${configure} -B ${WORK}/without -DSIXDOF_INSTALL=ON -DSIXDOF_WITH_FCL=OFF -DSIXDOF_WITH_BULLET=OFF -DSIXDOF_WITH_ODE=OFF
  -DSIXDOF_WITH_EMBREE=OFF -DSIXDOF_WITH_GTS=OFF -DSIXDOF_WITH_SIMBODY=OFF -DSIXDOF_WITH_CCD=OFF -DSIXDOF_WITH_MUJOCO=OFF -DSIXDOF_WITH_COAL=OFF)
# CGAL is off by default: a program that links it is under the GPL.
expect_no_backend(${WORK}/without fcl bullet ode embree gts simbody ccd mujoco coal cgal)

# An installation of what is not built says how to build it, and copies nothing.
execute_process(COMMAND ${CMAKE_COMMAND} --install ${WORK}/without --prefix ${WORK}/prefix
  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT result OR NOT output MATCHES "install-ready" OR EXISTS ${WORK}/prefix/lib)
  message(FATAL_ERROR "an installation of nothing exited with ${result}:\n${output}")
endif()

foreach(module IN ITEMS bullet-float64 ode gts simbody ccd)
  file(WRITE ${WORK}/pkgconfig/${module}.pc
    "Name: ${module}\nDescription: unusable\nVersion: 1\nRequires: sixdof-no-such-package\n")
endforeach()
set(ENV{PKG_CONFIG_PATH} ${WORK}/pkgconfig)
run(output ${configure} -B ${WORK}/unusable -DCMAKE_DISABLE_FIND_PACKAGE_embree=ON -DCMAKE_DISABLE_FIND_PACKAGE_mujoco=ON)
foreach(words IN ITEMS "No bullet-float64: .*libbullet-dev" "No ode: .*libode-dev" "No embree: .*libembree-dev"
        "No gts: .*libgts-dev" "No simbody: .*libsimbody-dev" "No ccd: .*libccd-dev" "No mujoco: .*libmujoco-dev")
  if(NOT output MATCHES "${words}")
    message(FATAL_ERROR "no message '${words}' in:\n${output}")
  endif()
endforeach()
expect_no_backend(${WORK}/unusable bullet ode embree gts simbody ccd mujoco cgal)
