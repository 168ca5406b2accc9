# One line a test program.
copse_test(test_builder test_builder.cu test_builder_methods.cu test_builder_validate.cpp test_builder_parameters.cpp
           test_builder_cost.cpp test_builder_traffic.cpp test_end_point_overlap.cpp)
copse_test(test_linear test_linear.cpp test_linear_hlbvh.cpp test_linear_aac.cpp)
copse_test(test_treelets test_treelets.cu)
copse_test(test_kmeans test_kmeans.cu)
copse_test(test_parallel test_parallel.cu test_parallel_traffic.cu test_parallel_errors.cu test_parallel_reduce.cu test_parallel_primitives.cu
           test_parallel_warp.cu test_parallel_breadth_first.cu test_parallel_fibers.cpp)
copse_test(test_generators test_generators.cpp test_scene_descriptions.cpp)
copse_test(test_image test_image.cpp test_image_texels.cpp test_image_compare.cpp)
copse_test(test_reference test_reference.cpp test_reference_tree.cpp test_reference_views.cpp)
copse_test(test_traversal test_traversal.cu test_traversal_batches.cu test_traversal_watertight.cu
           test_traversal_counts.cpp)
copse_test(test_scene test_scene.cpp test_scene_obj.cpp test_scene_ply.cpp test_scene_meshes.cpp test_scene_fuzz.cpp)
copse_test(test_random test_random.cpp)
copse_test(test_path test_path.cpp test_path_light.cpp support/path_scenes.cu)
copse_test(test_inspect test_inspect_surfaces.cpp test_inspect_clusters.cpp test_inspect_heatmap.cpp support/path_scenes.cu)
copse_test(test_truth test_truth.cpp support/path_scenes.cu)

# The program from outside, and an installed Copse in a project of its user.
copse_test(test_cli test_cli.cpp test_cli_measures.cpp test_cli_inputs.cpp test_cli_files.cpp test_cli_terminal.cpp
           test_cli_memory.cpp test_cli_views.cpp test_cli_integrators.cpp support/program.cpp)
copse_test(test_preview test_preview.cpp support/program.cpp)
copse_test(test_peers test_peers.cpp support/program.cpp support/path_scenes.cu)
copse_test(test_report test_report.cpp support/program.cpp)
copse_test(test_bench test_bench.cpp test_bench_resume.cpp support/program.cpp)
foreach(name IN ITEMS test_cli test_preview test_bench test_peers test_report)
  target_compile_definitions(${name} PRIVATE COPSE_PROGRAM="$<IF:$<BOOL:${COPSE_TEST_ROOT}>,${COPSE_TEST_ROOT}/bin/copse,$<TARGET_FILE:copse>>")
  add_dependencies(${name} copse)
endforeach()
if(NOT COPSE_SANITIZE)
  add_test(NAME "scenes/fetch.sh: what is fetched is whole, checked and resumed"
           COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/test_fetch.sh ${PROJECT_SOURCE_DIR}/scenes/fetch.sh
                   $<TARGET_FILE:copse> ${CMAKE_CURRENT_BINARY_DIR}/fetch)
  add_test(NAME "install: a project that finds copse builds and runs"
           COMMAND ${CMAKE_COMMAND} -DBUILD=${PROJECT_BINARY_DIR} -DWORK=${CMAKE_CURRENT_BINARY_DIR}/install
                   -DCONSUMER=${CMAKE_CURRENT_SOURCE_DIR}/consumer -DCOMPILER=${CMAKE_CXX_COMPILER}
                   -P ${CMAKE_CURRENT_SOURCE_DIR}/install_test.cmake)
  add_test(NAME "install: another project holds its images against references"
           COMMAND ${CMAKE_COMMAND} -DBUILD=${PROJECT_BINARY_DIR} -DWORK=${CMAKE_CURRENT_BINARY_DIR}/image_test
                   -DEXAMPLE=${CMAKE_CURRENT_SOURCE_DIR}/image_test_example -P
                   ${CMAKE_CURRENT_SOURCE_DIR}/image_test_test.cmake)
  add_test(NAME "package: what cpack makes runs where it is unpacked, and in an empty root"
           COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/gpu/package_test.sh ${PROJECT_BINARY_DIR}
                   ${CMAKE_CURRENT_BINARY_DIR}/package)
  # Of tests/gpu/bundle's archive, where there is one. 77 is said by the script itself, never by a count of failures.
  add_test(NAME "bundle: tests/gpu/run runs in an empty root"
           COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/gpu/bare_root.sh)
  set_tests_properties("bundle: tests/gpu/run runs in an empty root" PROPERTIES SKIP_RETURN_CODE 77)
endif()
