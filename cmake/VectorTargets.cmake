# Target vector_targets: compiles each file *_simd.cpp for each set of vector instructions alone, as users do who compile for one
# processor (-march=...): syntax only, warnings are errors. A build for all sets at once has other branches and finds less.
# With g++ and clang++ for x86-64, and g++ for ARM, where they are installed. Processors for which a compiler selects the same
# set of Highway's are compiled once.
set(vector_flags -std=c++20 -DHWY_COMPILE_ONLY_STATIC -DNDEBUG -ffp-contract=off -Wall -Wextra -Wpedantic -Wshadow
    -Wconversion -Wno-sign-conversion -Werror)
file(GLOB_RECURSE vector_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scarp/*_simd*.cpp)
set(vector_stamps "")
set(asks_for_set ${PROJECT_BINARY_DIR}/vectors/set.cpp)
file(WRITE ${asks_for_set} "#include <hwy/detect_targets.h>\nHWY_STATIC_TARGET\n")

# vector_target(COMPILER PROCESSOR FLAGS...)
function(vector_target compiler processor)
  if(NOT compiler)
    return()
  endif()
  execute_process(COMMAND ${compiler} ${vector_flags} ${ARGN} -E -P ${asks_for_set}
    OUTPUT_VARIABLE set RESULT_VARIABLE failed ERROR_QUIET)
  if(failed)
    message(STATUS "vector_targets: ${compiler} knows no ${processor}: skipped")
    return()
  endif()
  string(REGEX REPLACE "^.*\n([^\n]+)\n*$" "\\1" set "${set}")
  cmake_path(GET compiler FILENAME name)
  set(key "${name}: ${set}")
  get_property(seen GLOBAL PROPERTY SCARP_VECTOR_SETS)
  if(key IN_LIST seen)
    return()
  endif()
  set_property(GLOBAL APPEND PROPERTY SCARP_VECTOR_SETS ${key})
  set(set_folder ${PROJECT_BINARY_DIR}/vectors/${name}/${processor})
  foreach(file IN LISTS vector_files)
    file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR} ${file})
    set(stamp ${set_folder}/${path}.stamp)
    cmake_path(GET stamp PARENT_PATH folder)
    file(MAKE_DIRECTORY ${folder})
    add_custom_command(OUTPUT ${stamp}
      COMMAND ${compiler} ${vector_flags} ${ARGN} -fsyntax-only -I${PROJECT_SOURCE_DIR} -MD -MF ${stamp}.d -MT ${stamp} ${file}
      COMMAND ${CMAKE_COMMAND} -E touch ${stamp}
      DEPENDS ${file}
      DEPFILE ${stamp}.d
      COMMENT "Checking ${path} with ${name} for ${processor}"
      VERBATIM)
    list(APPEND vector_stamps ${stamp})
  endforeach()
  set(vector_stamps ${vector_stamps} PARENT_SCOPE)
endfunction()

find_program(SCARP_CLANG clang++)
find_program(SCARP_ARM_GXX aarch64-linux-gnu-g++)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  foreach(processor x86-64 x86-64-v2 x86-64-v3 znver3 skylake-avx512 icelake-server)
    vector_target(${CMAKE_CXX_COMPILER} ${processor} -march=${processor})
    if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
      vector_target("${SCARP_CLANG}" ${processor} -march=${processor})
    endif()
  endforeach()
endif()
# Its own headers come before those of this system's libraries.
vector_target("${SCARP_ARM_GXX}" armv8 -march=armv8-a -idirafter /usr/include)
add_custom_target(vector_targets ALL DEPENDS ${vector_stamps})
