# The shader texts that are installed say what they are, function by function, and every number that a march is given has its
# unit:
#   cmake -D ROOT=<checkout> -D TEXTS=<a,b,...> -P shader_texts.cmake
cmake_minimum_required(VERSION 3.25)

# What hosts fill in, and read.
set(spoken_structs ScarpField ScarpRay ScarpHit ScarpNaive ScarpFixedStep ScarpRelaxed ScarpLipschitz ScarpFunctionMarch
    ScarpLipschitzLocal ScarpSphereTrace)

# check(FILE NAME out SILENT out FUNCTIONS): what has no comment, and how many functions there are.
function(check file name silent count)
  file(READ ${file} text)
  # Semicolons and brackets are list syntax to CMake.
  string(REPLACE "[" "(" text "${text}")
  string(REPLACE "]" ")" text "${text}")
  string(REPLACE ";" "@" text "${text}")
  string(REPLACE "\n" ";" lines "${text}")
  set(before "")
  set(struct "")
  set(found ${${silent}})
  set(functions ${${count}})
  foreach(line IN LISTS lines)
    if(NOT line MATCHES "\\)@$" AND
       line MATCHES "^(SCARP_FN )?(void|bool|int|uint|float|u?vec[234]|ivec[234]|Scarp[A-Za-z]+|Ground[A-Za-z]*) ([a-z_0-9]+)\\(")
      set(function ${CMAKE_MATCH_3})
      math(EXPR functions "${functions} + 1")
      if(NOT before MATCHES "^//")
        list(APPEND found "${name}: ${function}() has no comment above it")
      endif()
    elseif(line MATCHES "^struct ([A-Za-z]+) {")
      set(struct ${CMAKE_MATCH_1})
    elseif(line STREQUAL "}@")
      set(struct "")
    elseif(struct IN_LIST spoken_structs AND NOT line MATCHES "///< " AND line MATCHES "^  [A-Za-z0-9]+ ([a-z_]+)@")
      list(APPEND found "${name}: ${struct}::${CMAKE_MATCH_1} does not say what it is")
    endif()
    set(before "${line}")
  endforeach()
  set(${silent} "${found}" PARENT_SCOPE)
  set(${count} ${functions} PARENT_SCOPE)
endfunction()

set(proof ${CMAKE_CURRENT_BINARY_DIR}/shader-texts-proof.glsl.h)
file(WRITE ${proof} "/// Told.\nSCARP_FN float told(int i) { return a[i]; }\nSCARP_FN ScarpHit silent(int i) {\n}\nfloat asked(int i);\n
struct ScarpNaive {\n  float good;  ///< unit\n  float bad;\n};\nstruct ScarpInner {\n  float silent;\n};\n")
set(breaches "")
set(functions 0)
check(${proof} proof breaches functions)
file(REMOVE ${proof})
if(NOT functions EQUAL 2 OR NOT breaches STREQUAL "proof: silent() has no comment above it;proof: ScarpNaive::bad does not say what it is")
  message(FATAL_ERROR "the check is broken: it found ${functions} functions and\n  ${breaches}")
endif()

set(breaches "")
set(functions 0)
string(REPLACE "," ";" TEXTS "${TEXTS}")
foreach(text IN LISTS TEXTS)
  check(${ROOT}/${text} ${text} breaches functions)
endforeach()
if(breaches)
  list(JOIN breaches "\n  " said)
  message(FATAL_ERROR "of ${functions} functions:\n  ${said}")
endif()
if(functions LESS 150)
  message(FATAL_ERROR "only ${functions} functions: is TEXTS all of them?")
endif()
