# README shows examples/hello_terrain.cpp as it is compiled, except for its licence line:
#   cmake -D ROOT=<checkout> -P readme.cmake
cmake_minimum_required(VERSION 3.25)
file(READ ${ROOT}/examples/hello_terrain.cpp example)
string(REGEX REPLACE "^// SPDX[^\n]*\n" "" example "${example}")
file(READ ${ROOT}/README.md readme)
string(FIND "${readme}" "\n```cpp\n${example}```\n" place)
if(place EQUAL -1)
  message(FATAL_ERROR "README.md does not show examples/hello_terrain.cpp word for word; copy it there")
endif()
