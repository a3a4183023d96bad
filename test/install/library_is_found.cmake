# A consumer of the library alone, by find_package and by pkg-config.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

set(flags "${CXX_FLAGS}")
if(SANITIZE)
  string(APPEND flags " -fsanitize=${SANITIZE}")
endif()
file(REMOVE_RECURSE ${WORK}/consumer)
run(${CMAKE_COMMAND} -G Ninja -S ${SOURCE} -B ${WORK}/consumer -DCMAKE_PREFIX_PATH=${INSTALLED} "-DCMAKE_CXX_FLAGS=${flags}")
run(${CMAKE_COMMAND} --build ${WORK}/consumer)
run(${WORK}/consumer/consumer)

file(GLOB pc_folder ${INSTALLED}/lib*/pkgconfig ${INSTALLED}/lib/*/pkgconfig)
set(ENV{PKG_CONFIG_PATH} "${pc_folder}")
run(sh -c "${CXX} -std=c++20 ${flags} ${SOURCE}/consumer.cpp $(pkg-config --cflags --libs sixdof) -o ${WORK}/consumer/by_pkg_config")
run(${WORK}/consumer/by_pkg_config)
