# The marches over textures keep to GLSL ES 3.0:
#   cmake -D ROOT=<checkout> -D WORK=<folder> -D VALIDATOR=<glslangValidator> -P glsl_es.cmake
cmake_minimum_required(VERSION 3.25)

# check(FILE GOOD): compiles a fragment shader with all that it includes.
function(check file good)
  execute_process(COMMAND ${CMAKE_COMMAND} -D ROOT=${ROOT} -D FILE=${file} -D OUT=${WORK}/flat.frag
                          -P ${ROOT}/cmake/FlattenGlsl.cmake COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${VALIDATOR} -S frag ${WORK}/flat.frag RESULT_VARIABLE failed OUTPUT_VARIABLE said)
  if(good AND failed)
    message(FATAL_ERROR "${file} is not GLSL ES 3.0:\n${said}")
  elseif(NOT good AND NOT failed)
    message(FATAL_ERROR "the check is broken: it takes what GLSL ES 3.0 does not have")
  endif()
endfunction()

check(${ROOT}/test/march/textures_es.frag TRUE)
file(WRITE ${WORK}/bad.frag "#version 300 es\nprecision highp float;\nout vec4 colour;\nvoid main() { precise double x = 1.0; colour = vec4(x); }\n")
check(${WORK}/bad.frag FALSE)
