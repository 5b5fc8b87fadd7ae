# The library exports exactly the functions of scarp_c.h:
#   cmake -D HEADER=<scarp_c.h> -D LIBRARY=<libscarp_c.so> -D NM=<nm> -P symbols.cmake
cmake_minimum_required(VERSION 3.25)

file(READ ${HEADER} text)
string(REGEX MATCHALL "SCARP_C_API [a-z0-9_ *]*scarp_[a-z0-9_]+\\(" declared "${text}")
list(TRANSFORM declared REPLACE ".*(scarp_[a-z0-9_]+)\\($" "\\1")
list(SORT declared)
string(REGEX MATCHALL "\nSCARP_C_API " every "${text}")
list(LENGTH every expected)
list(LENGTH declared count)
if(count LESS 30 OR NOT count EQUAL expected)
  message(FATAL_ERROR "${HEADER}: ${expected} functions, but ${count} names found: ${declared}")
endif()

execute_process(COMMAND ${NM} -D --defined-only ${LIBRARY} OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^ \n]+\n" exported "${symbols}")
list(TRANSFORM exported STRIP)
list(SORT exported)
if(NOT exported STREQUAL declared)
  message(FATAL_ERROR "exported: ${exported}\ndeclared: ${declared}")
endif()
message("${count} functions")
