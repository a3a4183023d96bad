# Installs the build, moves the installation, and looks whether anything in it still names the folders of source or build.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

file(REMOVE_RECURSE ${WORK}/prefix ${INSTALLED})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
cmake_path(GET INSTALLED PARENT_PATH parent)
file(MAKE_DIRECTORY ${parent})
file(RENAME ${WORK}/prefix ${INSTALLED})

# bash finds the completion of a program by the program's name.
foreach(program IN ITEMS sixdof sixdof-bench)
  if(EXISTS ${INSTALLED}/bin/${program})
    file(READ ${INSTALLED}/share/bash-completion/completions/${program} script)
    if(NOT script MATCHES "complete -F [_a-z]+ ${program}\n$")
      message(FATAL_ERROR "no completion of ${program} in:\n${script}")
    endif()
  endif()
endforeach()

# Assertions and debugging information name source files.
set(kind_of_files --text)
if(NOT BUILD_TYPE STREQUAL "Release")
  set(kind_of_files --binary-files=without-match)
endif()
# At the begin of a path, also behind -I: the folders may be /sixdof, and share/sixdof/ is none of them.
set(patterns "")
foreach(folder IN ITEMS ${SOURCE} ${BUILD})
  string(REGEX REPLACE "([][+.*()^$?|{}\\])" "\\\\\\1" folder ${folder})
  list(APPEND patterns -e "(^|[^-[:alnum:]_./]|-[[:alpha:]])${folder}/")
endforeach()
execute_process(COMMAND ${CMAKE_COMMAND} -E env LC_ALL=C grep -rlE ${kind_of_files} ${patterns} ${INSTALLED}
  OUTPUT_VARIABLE files RESULT_VARIABLE result)
if(NOT result EQUAL 1)
  message(FATAL_ERROR "these name ${SOURCE} or ${BUILD}:\n${files}")
endif()
