# Installs BUILD to a folder under WORK, then configures, builds and runs the project CONSUMER against what is there.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(failed)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\n${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${WORK}/prefix/bin/copse --version)
run(${CMAKE_COMMAND} -S ${CONSUMER} -B ${WORK}/build -G Ninja -DCMAKE_BUILD_TYPE=Release
    -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_CXX_COMPILER=${COMPILER})
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${CMAKE_COMMAND} -E chdir ${WORK} build/tree)
run(${CMAKE_COMMAND} -E chdir ${WORK} build/picture)
run(${CMAKE_COMMAND} -E chdir ${WORK} build/record)
# The module with OpenImageIO is found by programs that lie elsewhere, where there is one.
file(GLOB_RECURSE module ${WORK}/prefix/copse_oiio.so)
if(module AND NOT EXISTS ${WORK}/picture.png)
  message(FATAL_ERROR "${module} was not found by ${WORK}/build/picture")
endif()
