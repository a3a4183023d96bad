# run(COMMAND...): fails with its output unless the command exits with 0.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(result)
    message(FATAL_ERROR "${ARGN}\nexited with ${result}:\n${output}")
  endif()
endfunction()
