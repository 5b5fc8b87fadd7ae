# Builds examples/glsl against only the shader texts of an installed tree, and runs it:
#   cmake -D ROOT=<checkout> -D PREFIX=<installed tree> -D WORK=<scratch folder> -D GENERATOR=... -D CXX=<compiler>
#         -P glsl_example.cmake
cmake_minimum_required(VERSION 3.25)

# Counted in doubles, with 500 steps per unit of time for each ray: SHADOWS rays are in shadow, and GRAZING of these dip
# into the ground by less than single precision resolves for a ray from the surface (scarp_rounding() of
# ray_frame.glsl.h: at most 0.0005 here).
set(SHADOWS 42428)
set(GRAZING 64)

function(run)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${status}): ${command}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} -S ${ROOT}/examples/glsl -B ${WORK}/build -G ${GENERATOR} -D CMAKE_PREFIX_PATH=${PREFIX}
    -D CMAKE_CXX_COMPILER=${CXX} -D CMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${WORK}/build)
# It has read the installed texts, not those in the checkout.
file(STRINGS ${WORK}/build/CMakeCache.txt found REGEX "^SCARP_GLSL:")
if(NOT found MATCHES "=${PREFIX}/")
  message(FATAL_ERROR "the example reads other shader texts than those just installed: ${found}")
endif()
run(${WORK}/build/shadow_map ${WORK}/build/shadow_map.spv ${WORK}/shadows.pgm)
message("${output}")
if(output MATCHES "^no Vulkan device")
  return()
endif()
if(NOT output MATCHES "^([0-9]+) of 65536 cells are in shadow\n$")
  message(FATAL_ERROR "expected '... of 65536 cells are in shadow'")
endif()
math(EXPR least "${SHADOWS} - ${GRAZING}")
if(CMAKE_MATCH_1 LESS least OR CMAKE_MATCH_1 GREATER SHADOWS)
  message(FATAL_ERROR "expected ${least} to ${SHADOWS} cells")
endif()
