# Installs BUILD under WORK, then runs the example's image tests there: they pass; another image, a missing reference
# and a program that fails do not; and references are replaced if the environment says so.
function(run expected says)  # COMMAND...
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if((status EQUAL 0) EQUAL (expected STREQUAL "fails") OR NOT output MATCHES "${says}")
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\nexited with ${status}; expected: ${expected}, with \"${says}\"\n${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
file(COPY ${EXAMPLE}/ DESTINATION ${WORK}/example)
run(passes "" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(passes "" ${CMAKE_COMMAND} -S ${WORK}/example -B ${WORK}/build -G Ninja -DCMAKE_PREFIX_PATH=${WORK}/prefix)
set(test ${CMAKE_CTEST_COMMAND} --test-dir ${WORK}/build --output-on-failure)
run(passes "100% tests passed" ${test})

file(RENAME ${WORK}/example/references/box.exr ${WORK}/kept.exr)
run(fails "COPSE_UPDATE_REFERENCES=1" ${test} -R "^box$")
file(COPY_FILE ${WORK}/example/references/box-converged.exr ${WORK}/example/references/box.exr)
run(fails "rmse [0-9.]+ is over --max-rmse.*differs[ \n]+from" ${test} -R "^box$")
run(passes "was replaced" ${CMAKE_COMMAND} -E env COPSE_UPDATE_REFERENCES=1 ${test} -V -R "^box$")
run(passes "100% tests passed" ${test} -R "^box$")
run(passes "" ${WORK}/prefix/bin/copse compare ${WORK}/example/references/box.exr ${WORK}/kept.exr --max-rmse 1e-3)
file(WRITE ${WORK}/example/box.toml "name = 1\n")
run(fails "exited with 2" ${test} -R "^box$")
