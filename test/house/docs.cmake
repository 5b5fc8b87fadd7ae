# API documentation by Doxygen, from the public headers and doc/library. Any warning fails.
#   cmake -D ROOT=<checkout> -D PUBLIC_HEADERS=<list, a header per line> -D OUTPUT=<folder> -P docs.cmake
cmake_minimum_required(VERSION 3.25)

find_program(doxygen doxygen)
if(NOT doxygen)
  message("skipped: doxygen is not installed")
  return()
endif()
file(STRINGS ${PUBLIC_HEADERS} headers)
list(JOIN headers " " headers)
file(READ ${ROOT}/doc/api/Doxyfile settings)
file(MAKE_DIRECTORY ${OUTPUT})
file(WRITE ${OUTPUT}/Doxyfile "${settings}\nINPUT = doc/library doc/api/groups.dox ${headers}\nOUTPUT_DIRECTORY = ${OUTPUT}\n")
execute_process(COMMAND ${doxygen} ${OUTPUT}/Doxyfile WORKING_DIRECTORY ${ROOT} RESULT_VARIABLE failed ERROR_VARIABLE messages)
if(failed OR messages)
  message(FATAL_ERROR "${messages}")
endif()
