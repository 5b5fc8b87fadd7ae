# doc/user/options.md is what `scarp options --markdown` prints:
#   cmake -D ROOT=<checkout> -D SCARP=<program> -P options_page.cmake
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND ${SCARP} options --markdown OUTPUT_VARIABLE printed COMMAND_ERROR_IS_FATAL ANY)
file(READ ${ROOT}/doc/user/options.md page)
string(LENGTH "${printed}" length)
if(NOT "${page}" STREQUAL "${printed}" OR length LESS 1000)
  message(FATAL_ERROR "doc/user/options.md is out of date: scarp options --markdown > doc/user/options.md")
endif()
