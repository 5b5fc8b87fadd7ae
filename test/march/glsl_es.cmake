# The marches over textures keep to GLSL ES 3.0:
#   cmake -D ROOT=<checkout> -D WORK=<folder> -D VALIDATOR=<glslangValidator> -D FLAT=<folder of max_mip.glsl, ...> -P glsl_es.cmake
cmake_minimum_required(VERSION 3.25)

include(${CMAKE_CURRENT_LIST_DIR}/shader_compiles.cmake)

# check(FILE GOOD): compiles a fragment shader with everything that it includes.
function(check file good)
  execute_process(COMMAND ${CMAKE_COMMAND} -D ROOT=${ROOT} -D FILES=${file} -D OUT=${WORK}/flat.frag
                          -P ${ROOT}/cmake/FlattenGlsl.cmake COMMAND_ERROR_IS_FATAL ANY)
  shader_compiles(${file} ${good} -S frag ${WORK}/flat.frag)
endfunction()

check(${ROOT}/test/march/height/textures_es.frag TRUE)

# paste(TEXT MARK NAMES OUT): TEXT with MARK replaced by the installed texts of these names, one after another.
function(paste text mark names out)
  string(FIND "${text}" "${mark}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "the shader has no line '${mark}' to paste ${names} at")
  endif()
  set(pasted "")
  foreach(name IN LISTS names)
    file(READ ${FLAT}/${name} installed)
    string(APPEND pasted "${installed}")
  endforeach()
  string(REPLACE "${mark}" "${pasted}" whole "${text}")
  file(WRITE ${out} "${whole}")
endfunction()

# The shader of the user document, with the texts pasted as the document says, in its order.
file(READ ${ROOT}/doc/user/glsl.md document)
string(REGEX MATCH "\n```glsl\n(.*\n)```\n" ignored "${document}")
set(shader "${CMAKE_MATCH_1}")
string(REGEX MATCH "// here the text of ([a-z_.]+), then that of ([a-z_.]+)\n" mark "${shader}")
if(NOT mark)
  message(FATAL_ERROR "doc/user/glsl.md does not say what is to be pasted into its shader")
endif()
paste("${shader}" "${mark}" "${CMAKE_MATCH_1};${CMAKE_MATCH_2}" ${WORK}/pasted.frag)
check(${WORK}/pasted.frag TRUE)
# The library document: the easy text in its shader, for WebGL 2 and for desktops.
file(READ ${ROOT}/doc/library/glsl.md document)
string(REGEX MATCH "\n```glsl\n(#version 300 es\n[^`]*)```\n" ignored "${document}")
set(shader "${CMAKE_MATCH_1}")
string(REGEX MATCH "// here the text of ([a-z_.]+)\n" mark "${shader}")
if(NOT mark)
  message(FATAL_ERROR "doc/library/glsl.md does not say what is to be pasted into its shader")
endif()
foreach(version "300 es" "330" "450")
  string(REPLACE "#version 300 es" "#version ${version}" of_version "${shader}")
  paste("${of_version}" "${mark}" ${CMAKE_MATCH_1} ${WORK}/pasted.frag)
  check(${WORK}/pasted.frag TRUE)
endforeach()
# All marches pasted after one another, over the same textures.
file(READ ${ROOT}/test/march/height/textures_es.frag shader)
string(REPLACE "#include \"scarp/march/height/textures.glsl.h\"\n" "MARCHES" shader "${shader}")
string(REGEX REPLACE "\n#include [^\n]*" "" shader "${shader}")
paste("${shader}" "MARCHES" "textures.glsl;max_mip.glsl;height_marches.glsl;max_mip_easy.glsl" ${WORK}/pasted.frag)
check(${WORK}/pasted.frag TRUE)

# The voxel marches, as the library's document shows them.
string(REGEX MATCH "\n```glsl\n(#version 300 es\n[^`]*// here the text of (voxel_[a-z_.]+), then that of (voxel_[a-z_.]+)\n[^`]*)```\n"
       ignored "${document}")
if(NOT CMAKE_MATCH_1)
  message(FATAL_ERROR "doc/library/glsl.md does not show a shader of voxels")
endif()
paste("${CMAKE_MATCH_1}" "// here the text of ${CMAKE_MATCH_2}, then that of ${CMAKE_MATCH_3}\n" "${CMAKE_MATCH_2};${CMAKE_MATCH_3}"
      ${WORK}/pasted.frag)
check(${WORK}/pasted.frag TRUE)

# The march over a function, here of one instruction.
file(READ ${FLAT}/lipschitz_local.glsl march)
file(WRITE ${WORK}/pasted.frag "#version 300 es
precision highp float;
precision highp int;
out vec4 colour;
${march}
ScarpInstruction scarp_instruction(uint i) {
  return ScarpInstruction(kScarpNoiseOp, kScarpPerlinNoise, 2u, 2u, 2u, 0u, 1u, 7u, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
}
bool scarp_uses(uint part) { return part == kScarpNoiseOp || part == kScarpNoiseBit + kScarpPerlinNoise; }
uniform ScarpFunctionRay ray;
void main() {
  colour = vec4(scarp_lipschitz_local(ScarpProgram(1u, 2u), ray, ScarpLipschitzLocal(1.0e-6, 1024, 1024), true).time);
}
")
check(${WORK}/pasted.frag TRUE)
# The sampling marches over both kinds of field in one shader.
file(READ ${FLAT}/height_marches.glsl over_heights)
file(READ ${FLAT}/function_marches.glsl over_functions)
file(WRITE ${WORK}/pasted.frag "#version 300 es
precision highp float;
precision highp int;
out vec4 colour;
float scarp_sample(int col, int row) { return float(col + row); }
bool scarp_is_nodata(float height) { return height < 0.0; }
float scarp_minimum(int level, int col, int row) { return 0.0; }
${over_heights}${over_functions}
ScarpInstruction scarp_instruction(uint i) {
  return ScarpInstruction(kScarpNoiseOp, kScarpPerlinNoise, 2u, 2u, 2u, 0u, 1u, 7u, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
}
bool scarp_uses(uint part) { return true; }
uniform ScarpField field;
uniform ScarpRay ray;
uniform ScarpFunctionRay function_ray;
void main() {
  ScarpSampling settings = scarp_naive(0.7, 0.002, 0.001, 1024);
  colour = vec4(scarp_sampled(field, ray, settings).time,
                scarp_function_march(ScarpProgram(1u, 2u), function_ray, settings, 1024).time, 0.0, 0.0);
}
")
check(${WORK}/pasted.frag TRUE)
file(READ ${FLAT}/sphere_trace.glsl march)
file(WRITE ${WORK}/pasted.frag "#version 300 es
precision highp float;
precision highp int;
out vec4 colour;
${march}
ScarpShapeInstruction scarp_shape_instruction(uint i) {
  return ScarpShapeInstruction(kScarpShapeSphere, 0u, 0u, 0u, 0u, 0u, 0u, 0u);
}
float scarp_shape_number(uint i) { return i == 3u ? 1.0 : 0.0; }
bool scarp_shape_uses(uint op) { return op == kScarpShapeSphere; }
float scarp_shape_function(uint index, float x, float y) { return 0.0; }
float scarp_shape_field(uint index, vec3 q, float shrink) { return 0.0; }
uniform ScarpFunctionRay ray;
void main() { colour = vec4(scarp_sphere_trace(1u, ray, ScarpSphereTrace(1.0e-6, 1024, 1024, 1.0e-6), true).time); }
")
check(${WORK}/pasted.frag TRUE)
# Height fields among shapes, by include.
file(WRITE ${WORK}/grounds.frag "#version 300 es
precision highp float;
precision highp int;
out vec4 colour;
#include \"scarp/march/shape/shape_grounds.glsl.h\"
ScarpShapeInstruction scarp_shape_instruction(uint i) {
  return ScarpShapeInstruction(kScarpShapeFieldGround, 0u, 0u, 0u, 0u, 0u, 0u, 0u);
}
float scarp_shape_number(uint i) { return i >= 3u ? 1.0 : 0.0; }
bool scarp_shape_uses(uint op) { return op == kScarpShapeFieldGround; }
float scarp_shape_function(uint index, float x, float y) { return 0.0; }
float scarp_field_sample(int col, int row) { return float(col + row); }
bool scarp_field_hole(int col, int row) { return col == row; }
float scarp_shape_field(uint index, vec3 q, float shrink) {
  return scarp_field_ground(
      ScarpSolidField(ivec2(7, 5), ivec2(8, 6), 1.0, 1.0, 1.0, 0.0, false, false, true), q, shrink);
}
void main() { colour = vec4(scarp_shape_distance(1u, vec3(gl_FragCoord.xy, 1.0))); }
")
check(${WORK}/grounds.frag TRUE)
file(WRITE ${WORK}/bad.frag "#version 300 es\nprecision highp float;\nout vec4 colour;\nvoid main() { precise double x = 1.0; colour = vec4(x); }\n")
check(${WORK}/bad.frag FALSE)
