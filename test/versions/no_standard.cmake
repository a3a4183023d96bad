# Fails if OPTIONS, the compile options of a package, name a C++ standard.
if("${OPTIONS}" MATCHES "-std=")
  message(FATAL_ERROR "a package chooses the C++ standard: ${OPTIONS}")
endif()
