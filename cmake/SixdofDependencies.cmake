# Every third-party library, found in one place. README.md says why each is here; cmake/setup installs them.

find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB 2021 REQUIRED)
find_package(fmt 9 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(assimp 5 REQUIRED)
find_package(nanoflann 1.4 REQUIRED)
find_package(HDF5 1.10 REQUIRED COMPONENTS C CXX)

find_package(Boost 1.74 REQUIRED)

find_package(PkgConfig REQUIRED)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(HWY REQUIRED IMPORTED_TARGET libhwy)
pkg_check_modules(FFTW REQUIRED IMPORTED_TARGET fftw3)

if(SIXDOF_WITH_FCL)
  find_package(fcl 0.7 REQUIRED)
endif()

# sixdof_optional_backend(BACKEND MODULE PACKAGE): PkgConfig::BACKEND if SIXDOF_WITH_BACKEND is on and pkg-config knows
# MODULE; else a message that names the Debian package, and the backend is left out.
function(sixdof_optional_backend backend module package)
  if(NOT SIXDOF_WITH_${backend})
    return()
  endif()
  pkg_check_modules(${backend} QUIET IMPORTED_TARGET GLOBAL ${module})
  if(NOT ${backend}_FOUND)
    message(STATUS "No ${module}: without the backend SIXDOF_WITH_${backend} (Debian: ${package})")
  endif()
endfunction()
sixdof_optional_backend(BULLET bullet-float64 libbullet-dev)
sixdof_optional_backend(ODE ode libode-dev)

# sixdof_optional_package(BACKEND TARGET PACKAGE NAME [VERSION]): TARGET if SIXDOF_WITH_BACKEND is on and find_package(NAME
# VERSION) has it; else a message that names the Debian package, and the backend is left out.
function(sixdof_optional_package backend target package name)
  if(NOT SIXDOF_WITH_${backend})
    return()
  endif()
  find_package(${name} ${ARGN} QUIET GLOBAL)
  if(NOT TARGET ${target})
    message(STATUS "No ${name}: without the backend SIXDOF_WITH_${backend} (Debian: ${package})")
  endif()
endfunction()
sixdof_optional_package(EMBREE embree libembree-dev embree 3.13)

# In the order in which programs list their algorithms. A backend is built if sixdof_NAME is a target.
set(SIXDOF_BACKENDS fcl bullet ode embree)
if(SIXDOF_BUILD_BENCH AND PROJECT_IS_TOP_LEVEL)
  find_package(benchmark 1.7 REQUIRED)
  find_package(CLI11 2.1 REQUIRED)
elseif(SIXDOF_BUILD_BENCH)
  find_package(benchmark 1.7)
  find_package(CLI11 2.1)
  if(NOT benchmark_FOUND OR NOT CLI11_FOUND)
    message(STATUS "sixdof: no Google Benchmark or no CLI11 here, so no sixdof::bench_main and no sixdof::cli_main")
    set(SIXDOF_BUILD_BENCH OFF)
  endif()
endif()
if(SIXDOF_BUILD_TESTS)
  find_package(GTest 1.12 REQUIRED)
endif()
