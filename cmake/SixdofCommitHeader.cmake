# Part of the installed package, too.
set(sixdof_commit_script ${CMAKE_CURRENT_LIST_DIR}/SixdofCommit.cmake CACHE INTERNAL "")

# sixdof_commit_header(TARGET): sources of TARGET may include "sixdof_commit.h", which has the commit of the project that
# calls this. It is looked up at every build and written to a header that changes only when the commit does.
function(sixdof_commit_header target)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${target}_commit)
  add_custom_target(${target}_commit
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DOUTPUT=${folder}/sixdof_commit.h
      -P ${sixdof_commit_script}
    BYPRODUCTS ${folder}/sixdof_commit.h
    COMMENT "Looking up the commit"
    VERBATIM)
  add_dependencies(${target} ${target}_commit)
  target_include_directories(${target} PRIVATE ${folder})
endfunction()
