// The tests of test_simd.cpp without wide registers: beside them in one program, as a library and its user's code are.
#define COPSE_TEST_BASELINE
#include "tests/builder/math/test_simd.cpp"
