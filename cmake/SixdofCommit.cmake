# cmake -DSOURCE=DIR -DOUTPUT=FILE -P SixdofCommit.cmake: writes the commit and whether tracked files differ from it.
# Runs at every build, so that the figures carry the commit they were built from; the file is touched only when its
# content changes.
execute_process(COMMAND git -C ${SOURCE} rev-parse HEAD
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed ERROR_QUIET)
set(dirty false)
if(failed)
  set(commit "unknown")
else()
  execute_process(COMMAND git -C ${SOURCE} status --porcelain --untracked-files=no
    OUTPUT_VARIABLE changes OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(changes)
    set(dirty true)
  endif()
endif()
string(SUBSTRING ${commit} 0 12 short)
if(dirty)
  string(APPEND short " (modified)")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT
"#pragma once
inline constexpr const char* k_commit = \"${commit}\";
inline constexpr const char* k_short_commit = \"${short}\";
inline constexpr bool k_commit_dirty = ${dirty};
")
