# One line a room.
copse_test(test_parallel test_parallel.cu)
