# Runs PROGRAM NAME under ThreadSanitizer. KERNEL names the kernel whose operator() a race must be reported in, with exit
# status 66; without KERNEL nothing may be reported.
#   cmake -DPROGRAM=… -DNAME=… [-DKERNEL=…] -P planted_races.cmake
execute_process(COMMAND ${PROGRAM} ${NAME} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(KERNEL)
  if(NOT status EQUAL 66)
    message(FATAL_ERROR "${NAME}: exit status ${status}, not ThreadSanitizer's 66\n${output}")
  endif()
  if(NOT output MATCHES "data race[^#]*#0 ${KERNEL}[^\n]*operator\\(\\)[^\n]*planted_races\\.cu:[0-9]+")
    message(FATAL_ERROR "${NAME}: no data race reported at a line of ${KERNEL}\n${output}")
  endif()
elseif(NOT status EQUAL 0 OR output MATCHES "ThreadSanitizer")
  message(FATAL_ERROR "${NAME}: exit status ${status}; a report on correct code\n${output}")
endif()
