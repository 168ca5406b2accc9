# copse_add_image_test(): a ctest test that makes an image and compares it with a reference by `copse compare`.
# Comes with find_package(copse COMPONENTS image_test), which needs none of Copse's libraries, only its program.
#
#   copse_add_image_test(NAME name            name of the test
#     COMMAND program argument...             what writes the image; generator expressions and targets as in add_test
#     OUTPUT file.exr                         the image that it writes; removed before each run
#     REFERENCE file.exr                      the image that it is compared with
#     MAX_RMSE x | MAX_REL_MSE x              limits of `copse compare`; one or both
#     [WORKING_DIRECTORY folder] [TIMEOUT s])
#
# Relative files and folders are looked for in the source folder, OUTPUT in the binary folder. A test that fails prints
# the figures, and leaves OUTPUT with FILE-difference.png beside it. With COPSE_UPDATE_REFERENCES=1 in the environment
# the test replaces the reference with the rendered image, and says so: this also makes the first one.

set(COPSE_IMAGE_TEST_RUNNER ${CMAKE_CURRENT_LIST_DIR}/copse_image_test_run.cmake)

function(copse_add_image_test)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "NAME;OUTPUT;REFERENCE;MAX_RMSE;MAX_REL_MSE;WORKING_DIRECTORY;TIMEOUT" "COMMAND")
  foreach(key IN ITEMS NAME COMMAND OUTPUT REFERENCE)
    if(NOT DEFINED arg_${key})
      message(FATAL_ERROR "copse_add_image_test: ${key} is missing")
    endif()
  endforeach()
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "copse_add_image_test(${arg_NAME}): unknown arguments: ${arg_UNPARSED_ARGUMENTS}")
  endif()
  if(NOT DEFINED arg_MAX_RMSE AND NOT DEFINED arg_MAX_REL_MSE)
    message(FATAL_ERROR "copse_add_image_test(${arg_NAME}): expected MAX_RMSE or MAX_REL_MSE")
  endif()
  cmake_path(ABSOLUTE_PATH arg_REFERENCE BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
  cmake_path(ABSOLUTE_PATH arg_OUTPUT BASE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
  if(NOT DEFINED arg_WORKING_DIRECTORY)
    set(arg_WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
  endif()
  cmake_path(ABSOLUTE_PATH arg_WORKING_DIRECTORY BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})

  set(command "${arg_COMMAND}")
  list(POP_FRONT command program)
  if(TARGET ${program})
    set(program $<TARGET_FILE:${program}>)
  endif()
  set(limits)
  if(DEFINED arg_MAX_RMSE)
    list(APPEND limits --max-rmse ${arg_MAX_RMSE})
  endif()
  if(DEFINED arg_MAX_REL_MSE)
    list(APPEND limits --max-rel-mse ${arg_MAX_REL_MSE})
  endif()
  add_test(NAME ${arg_NAME}
           COMMAND ${CMAKE_COMMAND} -DCOPSE=$<TARGET_FILE:copse::copse> -DOUTPUT=${arg_OUTPUT}
                   -DREFERENCE=${arg_REFERENCE} "-DLIMITS=${limits}" -P ${COPSE_IMAGE_TEST_RUNNER}
                   -- ${program} ${command}
           WORKING_DIRECTORY ${arg_WORKING_DIRECTORY})
  if(DEFINED arg_TIMEOUT)
    set_tests_properties(${arg_NAME} PROPERTIES TIMEOUT ${arg_TIMEOUT})
  endif()
endfunction()
