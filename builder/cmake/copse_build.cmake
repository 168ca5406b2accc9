# How every target of Copse is compiled: one source for nvcc and for a plain C++ compiler, warnings, sanitizers.

if(COPSE_CUDA STREQUAL "AUTO")
  include(CheckLanguage)
  check_language(CUDA)
  if(CMAKE_CUDA_COMPILER)
    set(copse_has_cuda ON)
  else()
    set(copse_has_cuda OFF)
  endif()
else()
  set(copse_has_cuda ${COPSE_CUDA})
endif()
if(copse_has_cuda)
  set(CMAKE_CUDA_ARCHITECTURES ${COPSE_CUDA_ARCHITECTURES})
  enable_language(CUDA)
  if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)  # CMake 3.25 does not know that nvcc 12 and later speak C++20.
    set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION "-std=c++20")
    set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION "-std=c++20")
    list(APPEND CMAKE_CUDA_COMPILE_FEATURES cuda_std_20)
  endif()
  find_package(CUDAToolkit REQUIRED)
  message(STATUS "copse: CUDA ${CUDAToolkit_VERSION} for ${COPSE_CUDA_ARCHITECTURES}")
else()
  message(STATUS "copse: no CUDA; kernels run on the CPU only")
endif()

find_package(OpenMP REQUIRED COMPONENTS CXX)
find_package(Threads REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)

# -ffp-contract=off: the same arithmetic whatever the instruction set, so that trees and images do not depend on it.
set(copse_host_flags -Wall -Wextra -ffp-contract=off -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  list(APPEND copse_host_flags -Wno-restrict)  # False alarms on std::string, GCC bug 105651.
endif()
if(COPSE_WERROR)
  list(APPEND copse_host_flags -Werror)
  set(copse_device_werror "-Werror=all-warnings;")
endif()
if(COPSE_NATIVE)
  list(APPEND copse_host_flags -march=native)
else()
  list(APPEND copse_host_flags -Wno-psabi)  # Vectors of eight are passed only between functions of one file.
endif()
if(COPSE_SANITIZE)
  list(APPEND copse_host_flags -fsanitize=${COPSE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
endif()

add_library(copse_options INTERFACE)
list(JOIN copse_host_flags "," copse_host_flags_joined)
# Device code is not compressed: tests/gpu/emulate reads its PTX, and archives compress it better as a whole.
target_compile_options(copse_options INTERFACE
  "$<$<COMPILE_LANGUAGE:CXX>:${copse_host_flags}>"
  "$<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=${copse_host_flags_joined},-fopenmp;${copse_device_werror}-diag-suppress=20012;--fmad=false;-lineinfo;--no-compress>")
# nvcc cannot read fmt 9's consteval; format strings in .cu files are checked at run time.
target_compile_definitions(copse_options INTERFACE $<$<COMPILE_LANGUAGE:CUDA>:FMT_CONSTEVAL=>)
if(COPSE_SANITIZE)
  target_link_options(copse_options INTERFACE -fsanitize=${COPSE_SANITIZE})
endif()

# For code that runs once per program: it compiles in a third to a half less time than with -O3.
set(copse_once_flags "$<$<AND:$<CONFIG:Release>,$<COMPILE_LANGUAGE:CXX>>:-O1>")

# Fuzzers are led by what an input reaches in the rooms that read files; counting elsewhere would only slow them down.
# These are the flags of -fsanitize=fuzzer-no-link without its language option, which precompiled headers would lack.
set(copse_has_fuzzer OFF)
if(COPSE_FUZZ)
  include(CheckCXXSourceCompiles)
  set(CMAKE_REQUIRED_FLAGS -fsanitize=fuzzer)
  check_cxx_source_compiles(
    "#include <cstddef>\n#include <cstdint>\nextern \"C\" int LLVMFuzzerTestOneInput(const uint8_t*, size_t) { return 0; }"
    copse_links_libfuzzer)
  unset(CMAKE_REQUIRED_FLAGS)
  set(copse_has_fuzzer ${copse_links_libfuzzer})
endif()
set(copse_reading_rooms "/(builder/base|tracer/scene/io|tracer/image|tracer/bench|tracer/report|tracer/session)/")
set(copse_coverage_flags -fsanitize-coverage=inline-8bit-counters,indirect-calls,trace-cmp,pc-table)

# copse_sources(TARGET FILES...): adds sources; .cu files go to nvcc, or to the C++ compiler where CUDA is off.
function(copse_sources target)
  set(files)
  foreach(file IN LISTS ARGN)
    cmake_path(ABSOLUTE_PATH file)
    list(APPEND files ${file})
    if(copse_has_fuzzer AND file MATCHES "${copse_reading_rooms}")
      set_property(SOURCE ${file} TARGET_DIRECTORY ${target} APPEND PROPERTY COMPILE_OPTIONS ${copse_coverage_flags})
    endif()
    if(file MATCHES "\\.cu$" AND NOT copse_has_cuda)
      set_source_files_properties(${file} TARGET_DIRECTORY ${target} PROPERTIES LANGUAGE CXX COMPILE_OPTIONS "-x;c++")
    endif()
  endforeach()
  target_sources(${target} PRIVATE ${files})
endfunction()
