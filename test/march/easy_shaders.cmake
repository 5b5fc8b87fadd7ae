# The easy texts over functions compile, and so do the complete shaders of examples/shaders that contain them:
#   cmake -D ROOT=<checkout> -D WORK=<folder> -D VALIDATOR=<glslangValidator> -D FLAT=<folder of max_mip_easy.glsl, ...>
#         -P easy_shaders.cmake
cmake_minimum_required(VERSION 3.25)

include(${CMAKE_CURRENT_LIST_DIR}/shader_compiles.cmake)

set(texts naive relaxed lipschitz fixed_step)
set(WORK ${WORK}/easy_shaders)
foreach(name IN LISTS texts)
  file(READ ${ROOT}/scarp/march/sampling/${name}_easy.glsl ${name})
endforeach()

# check(NAME TEXT GOOD [OPTION...]): compiles a fragment shader, or the stage that the options name.
function(check name text good)
  file(WRITE ${WORK}/${name}.frag "${text}")
  shader_compiles(${name} ${good} ${ARGN} ${WORK}/${name}.frag)
endfunction()

# Each march alone, called with the numbers that its comment names.
set(ground "float scarp_ground(vec2 p) { return sin(p.x) * sin(p.y); }\n")
set(call_naive "scarp_naive(o, d, 9.0, 0.7, 1.0 / 512.0, 0.001, 1024, t)")
set(call_relaxed "scarp_relaxed(o, d, 9.0, 0.4, 0.0015, 300, t)")
set(call_lipschitz "scarp_lipschitz(o, d, 9.0, 1.0, 0.0005, 1024, t)")
set(call_fixed_step "scarp_fixed_step(o, d, 9.0, 5.0, 16384, t)")
set(begin "precision highp float;\nprecision highp int;\nuniform vec3 o, d;\nout vec4 colour;\n")
set(hlsl_begin "#define vec2 float2\n#define vec3 float3\nfloat3 o, d;\n")
foreach(name IN LISTS texts)
  foreach(version "300 es" "330" "450")
    string(MAKE_C_IDENTIFIER "${name}_${version}" file)
    check(${file} "#version ${version}\n${begin}${ground}${${name}}
void main() { float t; int status = ${call_${name}}; colour = vec4(t, status, 0.0, 0.0); }\n" TRUE)
  endforeach()
  check(${name}_hlsl "${hlsl_begin}${ground}${${name}}
float4 frag() : SV_Target { float t; int status = ${call_${name}}; return float4(t, status, 0.0, 0.0); }\n" TRUE
        -D -V -e frag)
endforeach()

# All marches in one shader, with the other texts for pasting.
file(READ ${FLAT}/max_mip_easy.glsl max_mip)
file(READ ${FLAT}/height_marches.glsl over_heights)
check(all "#version 300 es\n${begin}${ground}
float scarp_sample(int col, int row) { return float(col + row); }
bool scarp_is_nodata(float height) { return height < 0.0; }
float scarp_minimum(int level, int col, int row) { return 0.0; }
${naive}${relaxed}${lipschitz}${fixed_step}${max_mip}${over_heights}
void main() {
  float t;
  int status = ${call_naive} + ${call_relaxed} + ${call_lipschitz} + ${call_fixed_step};
  if (max_mip_easy(o, d, 9.0, true).hit) status += 1;
  colour = vec4(t, status, 0.0, 0.0);
}\n" TRUE)

# The shader of the user document, with the texts pasted as the document says.
file(READ ${ROOT}/doc/user/shaders-easy.md document)
string(REGEX MATCH "\n```glsl\n(#version 300 es\n[^`]*)```\n" ignored "${document}")
set(shader "${CMAKE_MATCH_1}")
string(REGEX MATCH "// here the text of ([a-z_]+)\\.glsl\n" mark "${shader}")
if(NOT mark)
  message(FATAL_ERROR "doc/user/shaders-easy.md does not say what is to be pasted into its shader")
endif()
string(REPLACE "${mark}" "${${CMAKE_MATCH_1}}" shader "${shader}")
check(document "${shader}" TRUE)

# example(FILE MARCH RESULT): the source of an example, which must contain the text of its march.
function(example file march result)
  file(READ ${ROOT}/examples/shaders/${file} text)
  string(FIND "${text}" "${${march}}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "examples/shaders/${file}: paste scarp/march/sampling/${march}_easy.glsl again, it has changed")
  endif()
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

# Shadertoy puts this before a shader, and calls mainImage().
example(shadertoy.glsl relaxed text)
check(shadertoy "#version 300 es
precision highp float;
precision highp int;
uniform vec3 iResolution;
uniform float iTime;
out vec4 shadertoy_out_color;
${text}
void main() { mainImage(shadertoy_out_color, gl_FragCoord.xy); }\n" TRUE)

example(webgl2.html lipschitz text)
foreach(kind vertex fragment)
  string(REGEX MATCH "<script id=\"${kind}\"[^>]*>(#version 300 es\n[^\r]*)" ignored "${text}")
  string(REGEX REPLACE "</script>.*" "" shader "${CMAKE_MATCH_1}")
  if(kind STREQUAL "vertex")
    check(webgl2_vertex "${shader}" TRUE -S vert)
  else()
    check(webgl2_fragment "${shader}" TRUE)
  endif()
endforeach()

# Godot has its own language, close to GLSL: without its first line, and with its built-in variables, this is GLSL.
example(godot.gdshader naive text)
string(REPLACE "shader_type canvas_item;\n" "" shader "${text}")
check(godot "#version 330
in vec2 UV;\nuniform float TIME;\nout vec4 COLOR;\n${shader}\nvoid main() { fragment(); }\n" TRUE)

# This shader uses two names from UnityCG.cginc.
example(unity.shader fixed_step text)
string(REGEX MATCH "HLSLPROGRAM\n(.*)ENDHLSL" ignored "${text}")
string(REPLACE "#include \"UnityCG.cginc\"\n"
       "float4 _Time;\nfloat4x4 matrix_vp;\nfloat4 UnityObjectToClipPos(float4 p) { return mul(matrix_vp, p); }\n"
       shader "${CMAKE_MATCH_1}")
check(unity_frag "${shader}" TRUE -D -V -S frag -e frag)
check(unity_vert "${shader}" TRUE -D -V -S vert -e vert)

check(without_ground "#version 300 es\n${begin}${naive}\nvoid main() { colour = vec4(0.0); }\n" FALSE)
check(without_macros "float3 o, d;\n${naive}\nfloat4 frag() : SV_Target { return 0.0; }\n" FALSE -D -V -e frag)
