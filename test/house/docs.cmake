# API documentation by Doxygen, from the public headers and doc/library. Any warning fails. So does a common header
# (doc/api/common_headers.txt) that is not public, or that a document does not list.
#   cmake -D ROOT=<checkout> -D PUBLIC_HEADERS=<list, a header per line> -D OUTPUT=<folder> -P docs.cmake
cmake_minimum_required(VERSION 3.25)

file(STRINGS ${PUBLIC_HEADERS} headers)
file(STRINGS ${ROOT}/doc/api/common_headers.txt common_headers)
foreach(document doc/library/using.md doc/library/api.md)
  file(READ ${ROOT}/${document} text)
  foreach(header IN LISTS common_headers)
    string(FIND "${text}" "${header}" place)
    if(place EQUAL -1)
      message(FATAL_ERROR "${document} does not list ${header} (doc/api/common_headers.txt)")
    endif()
    # Headers of features that are off are not public.
    if(NOT header IN_LIST headers AND NOT header MATCHES "_vk.h$|^scarp/(source|scene/file)/")
      message(FATAL_ERROR "doc/api/common_headers.txt: ${header} is not a public header")
    endif()
  endforeach()
endforeach()

find_program(doxygen doxygen)
if(NOT doxygen)
  message("skipped: doxygen is not installed")
  return()
endif()
list(JOIN headers " " headers)
file(READ ${ROOT}/doc/api/Doxyfile settings)
file(MAKE_DIRECTORY ${OUTPUT})
file(WRITE ${OUTPUT}/Doxyfile "${settings}\nINPUT = doc/library doc/api/groups.dox ${headers}\nOUTPUT_DIRECTORY = ${OUTPUT}\n")
execute_process(COMMAND ${doxygen} ${OUTPUT}/Doxyfile WORKING_DIRECTORY ${ROOT} RESULT_VARIABLE failed ERROR_VARIABLE messages)
if(failed OR messages)
  message(FATAL_ERROR "${messages}")
endif()
