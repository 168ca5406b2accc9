# Device code executed on the CPU (tests/gpu/emulate), where nvcc and Python are: the programs are made with the build,
# so that no test waits for a compiler.
set(emulated_programs gpu_same planted_races test_inspect test_parallel test_path test_treelets)
set(emulated_at ${PROJECT_BINARY_DIR}/emulated)
file(GLOB emulator_sources CONFIGURE_DEPENDS emulator/*.py emulator/*.h emulator/*.cpp)
list(TRANSFORM emulated_programs PREPEND ${emulated_at}/ OUTPUT_VARIABLE emulated_paths)
add_custom_command(OUTPUT ${emulated_paths}
  COMMAND Python3::Interpreter ${CMAKE_CURRENT_SOURCE_DIR}/emulate --build ${PROJECT_BINARY_DIR} --link ${emulated_programs}
  DEPENDS ${emulated_programs} ${CMAKE_CURRENT_SOURCE_DIR}/emulate ${emulator_sources}
  COMMENT "Linking ${emulated_programs} with emulated device code" VERBATIM)
add_custom_target(emulated ALL DEPENDS ${emulated_paths})

# emulated_test(NAME "SETTING=VALUE SETTING=VALUE…" PROGRAM ARGUMENTS...): SETTINGs of tests/gpu/emulate, in capitals.
# Labelled "emulated" in addition to its duration.
function(emulated_test name settings program)
  separate_arguments(settings)
  list(TRANSFORM settings PREPEND COPSE_EMULATOR_)  # of the environment
  add_test(NAME "emulated: ${name}" COMMAND ${CMAKE_COMMAND} -E env ${settings} ${emulated_at}/${program} ${ARGN})
  set_tests_properties("emulated: ${name}" PROPERTIES LABELS "emulated;medium" ${copse_test_environment})
endfunction()

foreach(schedule IN ITEMS "SEED=1" "SEED=2 BLOCKS=5 SWITCH=3" "STALE=1")
  foreach(scene IN ITEMS "cornell 300" "hairball 1000")
    string(REPLACE " " ";" generator ${scene})
    list(POP_BACK generator triangles)
    emulated_test("gpu_same on ${scene}, ${schedule}" "${schedule}" gpu_same --device cuda --generator ${generator}
                  --triangles ${triangles} --rays 2000 --size 16)
  endforeach()
endforeach()
emulated_test("gpu_same on cornell 300 without memory pools" "POOLS=0" gpu_same --device cuda --generator cornell
              --triangles 300 --rays 0 --size 0)
# The quick cases of programs. Those over ten seconds on a fast machine are slow.
foreach(part IN ITEMS "test_parallel@radixSort*" "test_parallel@~radixSort*" "test_path@In a closed body*"
                      "test_path@~In a closed body*" "test_treelets@32 lanes*" "test_treelets@~32 lanes*" "test_inspect@*")
  string(REPLACE "@" ";" part ${part})
  list(POP_FRONT part program cases)
  set(test "${program}, quick, ${cases}")
  emulated_test("${test}" "SEED=3" ${program} "~[.]~[medium]~[slow]${cases}" --device cuda)
  set_tests_properties("emulated: ${test}" PROPERTIES FAIL_REGULAR_EXPRESSION "on cuda: 0 of")
  if(NOT program STREQUAL "test_parallel")
    set_tests_properties("emulated: ${test}" PROPERTIES LABELS "emulated;slow")
  endif()
endforeach()

# Planted races are found, and the same kernels without them give right results. A missing acquire shows where data is
# kept until the next one.
foreach(planted IN ITEMS "missing-sync@SEED=0@wrong results" "missing-sync@SEED=1@wrong results"
                         "missing-second-sync@SEED=0@wrong results" "missing-second-sync@SEED=1@wrong results"
                         "relaxed-walk@STALE=1@stale reads in" "leave-early@SEED=0@a lane leaves|has left"
                         "write-behind@SEED=0@8192 bytes behind the begin of a block of 8192" "sync@SEED=1@right results"
                         "second-sync@SEED=1@right results" "ordered-walk@SEED=1@right results"
                         "ordered-walk@STALE=1@right results")
  string(REPLACE "@" ";" planted ${planted})
  list(POP_FRONT planted kernel schedule said)
  set(test "planted ${kernel}, ${schedule}")
  emulated_test(${test} ${schedule} planted_races ${kernel} cuda)
  if(NOT said STREQUAL "right results")
    set_tests_properties("emulated: ${test}" PROPERTIES PASS_REGULAR_EXPRESSION "${said}")
  endif()
endforeach()
