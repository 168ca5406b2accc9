# One line a room.
copse_test(test_builder test_builder.cu)
copse_test(test_image test_image.cpp test_image_texels.cpp)
copse_test(test_reference test_reference.cpp)
copse_test(test_traversal test_traversal.cu)
copse_test(test_parallel test_parallel.cu test_parallel_primitives.cu test_parallel_warp.cu test_parallel_fibers.cpp)
