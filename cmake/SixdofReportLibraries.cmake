# Puts the JavaScript libraries of `sixdof report` into VENDOR, each under its licence. They come from npm by the lock
# file in SOURCE, or from a folder node_modules that is there already (NODE_MODULES). Without them everything else works;
# `sixdof report` then says what is missing.
#   cmake -DNPM=... -DSOURCE=... -DWORK=... -DNODE_MODULES=... -DVENDOR=... -DSTAMP=... -P SixdofReportLibraries.cmake
set(libraries vega vega-lite vega-embed three)

# is_complete(RESULT FOLDER): has every library in the version that package.json names.
function(is_complete result folder)
  set(${result} FALSE PARENT_SCOPE)
  file(READ ${SOURCE}/package.json wanted)
  foreach(library IN LISTS libraries)
    if(NOT EXISTS ${folder}/${library}/package.json)
      return()
    endif()
    file(READ ${folder}/${library}/package.json there)
    string(JSON version GET "${there}" version)
    string(JSON wanted_version GET "${wanted}" dependencies ${library})
    if(NOT version STREQUAL wanted_version)
      return()
    endif()
  endforeach()
  set(${result} TRUE PARENT_SCOPE)
endfunction()

set(modules ${NODE_MODULES})
is_complete(complete ${modules})
if(NOT complete)
  set(modules ${WORK}/node_modules)
  file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json DESTINATION ${WORK})
  execute_process(
    COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --prefer-offline --fetch-retries=1 --fetch-timeout=60000
    WORKING_DIRECTORY ${WORK} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  is_complete(complete ${modules})
  if(NOT code EQUAL 0 OR NOT complete)
    message("sixdof report: its libraries could not be fetched by npm; `sixdof report` will say so:\n${output}")
    return()
  endif()
endif()

foreach(library IN LISTS libraries)
  file(READ ${modules}/${library}/LICENSE licence)
  set(built ${modules}/${library}/build/${library}.min.js)
  if(library STREQUAL "three")
    set(built ${modules}/${library}/build/three.module.min.js)
  endif()
  file(READ ${built} text)
  string(REGEX REPLACE "\n//# sourceMappingURL=[^\n]*" "" text "${text}")
  file(WRITE ${VENDOR}/${library}.min.js "/*! ${library}\n${licence}*/\n${text}")
endforeach()
file(TOUCH ${STAMP})
