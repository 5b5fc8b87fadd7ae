# doc/user/marches.md holds what `scarp marches --markdown` prints:
#   cmake -D ROOT=<checkout> -D SCARP=<program> -P marches_table.cmake
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND ${SCARP} marches --markdown OUTPUT_VARIABLE table COMMAND_ERROR_IS_FATAL ANY)
file(READ ${ROOT}/doc/user/marches.md page)
string(FIND "${page}" "${table}" place)
string(LENGTH "${table}" length)
if(place EQUAL -1 OR length LESS 100)
  message(FATAL_ERROR "doc/user/marches.md differs from what `scarp marches --markdown` prints:\n${table}")
endif()
