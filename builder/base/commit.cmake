# Run at every build: writes OUTPUT with the commit of SOURCE, and leaves the file alone where nothing changed, so that
# a build without changes compiles nothing. Without git, or outside a work tree, the commit is "unknown".
cmake_minimum_required(VERSION 3.25)
set(commit "unknown")
find_program(git git)
if(git AND EXISTS "${SOURCE}/.git")
  execute_process(COMMAND ${git} -C "${SOURCE}" rev-parse --short=12 HEAD
                  OUTPUT_VARIABLE head OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed)
    set(commit "${head}")
    execute_process(COMMAND ${git} -C "${SOURCE}" diff --quiet HEAD -- ERROR_QUIET RESULT_VARIABLE differs)
    if(differs)
      string(APPEND commit "+")
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT "${OUTPUT}" CONTENT "#define COPSE_COMMIT \"@commit@\"\n" @ONLY)
