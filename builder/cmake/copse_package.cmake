# `cpack` from a build folder: copse-VERSION-Linux-ARCHITECTURE.tar.gz, what `cmake --install` puts there and the shared
# libraries that the program needs, except glibc's own. It runs wherever it is unpacked, on any processor of the kind
# where the build had -DCOPSE_NATIVE=OFF. OpenImageIO's 258 libraries stay out: without them on the machine, the program
# renders only EXR and says so.
set_target_properties(copse PROPERTIES INSTALL_RPATH "$ORIGIN/../lib")
# RPATH, not RUNPATH: it holds for the libraries' own libraries too.
target_link_options(copse PRIVATE -Wl,--disable-new-dtags)
if(COPSE_NATIVE)
  install(CODE [[message(WARNING "this package runs only on processors like this machine's; configure with -DCOPSE_NATIVE=OFF for any")]]
          COMPONENT libraries EXCLUDE_FROM_ALL)
endif()
install(CODE [[
  file(GET_RUNTIME_DEPENDENCIES EXECUTABLES "${CMAKE_INSTALL_PREFIX}/bin/copse"
       RESOLVED_DEPENDENCIES_VAR libraries UNRESOLVED_DEPENDENCIES_VAR missing
       PRE_EXCLUDE_REGEXES "^ld-linux" "^lib(c|m|dl|pthread|rt)\\.so" "^libcuda\\.so")
  if(missing)
    message(FATAL_ERROR "not found: ${missing}")
  endif()
  foreach(library IN LISTS libraries)
    file(INSTALL "${library}" DESTINATION "${CMAKE_INSTALL_PREFIX}/lib" FOLLOW_SYMLINK_CHAIN)
  endforeach()
]] COMPONENT libraries EXCLUDE_FROM_ALL)

set(CPACK_GENERATOR TGZ)
set(CPACK_PACKAGE_NAME copse)
set(CPACK_PACKAGE_FILE_NAME copse-${PROJECT_VERSION}-${CMAKE_SYSTEM_NAME}-${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
# In this order, one archive: the libraries are those of the program that is there by then.
set(CPACK_INSTALL_CMAKE_PROJECTS "${PROJECT_BINARY_DIR};copse;ALL;/;${PROJECT_BINARY_DIR};copse;libraries;/")
include(CPack)
