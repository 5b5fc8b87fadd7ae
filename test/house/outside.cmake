# Installs the built tree and builds a project outside the checkout against it:
#   cmake -D ROOT=<checkout> -D BUILD=<build folder> -D WORK=<scratch folder>
#         -D GENERATOR=... -D CXX=<compiler> -D TYPE=<build type> -P outside.cmake
# With -D PREFIX=<tree> instead of BUILD, uses the tree that is already installed there.
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${status}): ${command}\n${output}")
  endif()
endfunction()

# outside(COMPONENT options...): configures, builds and runs the program that links scarp::COMPONENT.
function(outside component)
  set(folder ${WORK}/${component})
  run(${CMAKE_COMMAND} -S ${ROOT}/test/house/outside -B ${folder} -G ${GENERATOR} -D CMAKE_PREFIX_PATH=${PREFIX}
      -D CMAKE_CXX_COMPILER=${CXX} -D CMAKE_BUILD_TYPE=${TYPE} -D COMPONENT=${component} ${ARGN})
  run(${CMAKE_COMMAND} --build ${folder})
  execute_process(COMMAND ${folder}/outside_${component} WORKING_DIRECTORY ${folder} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
if(NOT DEFINED PREFIX)
  set(PREFIX ${WORK}/prefix)
  run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX})
endif()
outside(core -D CMAKE_DISABLE_FIND_PACKAGE_GDAL=ON -D CMAKE_DISABLE_FIND_PACKAGE_PROJ=ON -D CMAKE_DISABLE_FIND_PACKAGE_PNG=ON
        -D CMAKE_DISABLE_FIND_PACKAGE_OpenEXR=ON -D CMAKE_DISABLE_FIND_PACKAGE_Vulkan=ON)
outside(scarp)
# The example in C, without a compiler for C++.
outside(c -D CMAKE_DISABLE_FIND_PACKAGE_fmt=ON -D CMAKE_DISABLE_FIND_PACKAGE_glm=ON -D CMAKE_DISABLE_FIND_PACKAGE_TBB=ON
        -D CMAKE_DISABLE_FIND_PACKAGE_hwy=ON)

# The same programs, built with pkg-config.
find_program(PKG_CONFIG pkg-config)
if(PKG_CONFIG)
  file(GLOB_RECURSE pc_file ${PREFIX}/lib/*scarp-core.pc)
  cmake_path(GET pc_file PARENT_PATH pc_folder)
  foreach(pair core:scarp-core scarp:scarp)
    string(REGEX REPLACE ":.*" "" program ${pair})
    string(REGEX REPLACE ".*:" "" package ${pair})
    execute_process(COMMAND ${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${pc_folder} ${PKG_CONFIG} --cflags --libs ${package}
                    OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    separate_arguments(flags)
    run(${CXX} -std=c++20 ${ROOT}/test/house/outside/${program}.cpp -o ${WORK}/by_pkg_config_${program} ${flags})
  endforeach()
  execute_process(COMMAND ${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${pc_folder} ${PKG_CONFIG} --cflags --libs scarp-c
                  OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags)
  run(cc -std=c11 -pedantic -Werror ${ROOT}/examples/c/hello.c -o ${WORK}/by_pkg_config_c ${flags} -lm)
endif()

# Every installed header, and the templates that the programs instantiate, compiled with strict warnings by every available
# compiler. clang's -Wconversion includes sign changes, g++'s does not.
file(GLOB_RECURSE installed RELATIVE ${PREFIX}/include ${PREFIX}/include/*.h)
list(FILTER installed EXCLUDE REGEX "\\.glsl\\.h$|glsl_cpp\\.h$")
set(every_header "")
foreach(header IN LISTS installed)
  string(APPEND every_header "#include \"${header}\"\n")
endforeach()
file(WRITE ${WORK}/every_header.cpp "${every_header}")
foreach(compiler g++ clang++)
  find_program(${compiler}_PATH ${compiler})
  if(${compiler}_PATH)
    run(${${compiler}_PATH} -std=c++20 -fsyntax-only -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror -I ${PREFIX}/include
        ${WORK}/every_header.cpp ${ROOT}/test/house/outside/core.cpp ${ROOT}/test/house/outside/scarp.cpp)
  endif()
endforeach()

# The short shader texts and their examples.
foreach(file naive.glsl relaxed.glsl lipschitz.glsl fixed_step.glsl max_mip.glsl examples/shadertoy.glsl examples/webgl2.html
        examples/godot.gdshader examples/unity.shader)
  if(NOT EXISTS ${PREFIX}/share/scarp/glsl/easy/${file})
    message(FATAL_ERROR "share/scarp/glsl/easy/${file} is not installed")
  endif()
endforeach()

# The linker names what scarp.h declares and scarp::core lacks.
execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/core --target outside_door OUTPUT_VARIABLE output ERROR_VARIABLE output
                RESULT_VARIABLE status)
if(status EQUAL 0 OR NOT output MATCHES "undefined (reference|symbol).*scarp::render\\(")
  message(FATAL_ERROR "linking render() with scarp::core alone should fail and name it: ${status}\n${output}")
endif()

# The core program is linked with nothing of GDAL's; the installed command line runs from where it is.
file(GET_RUNTIME_DEPENDENCIES EXECUTABLES ${WORK}/core/outside_core RESOLVED_DEPENDENCIES_VAR libraries
     UNRESOLVED_DEPENDENCIES_VAR unresolved CONFLICTING_DEPENDENCIES_PREFIX conflicting)
if(libraries MATCHES "libgdal|libproj|libpng|libOpenEXR|libvulkan")
  message(FATAL_ERROR "a program that links scarp::core needs ${libraries}")
endif()
if(EXISTS ${PREFIX}/bin/scarp)
  run(${PREFIX}/bin/scarp --help)
  foreach(file bash-completion/completions/scarp zsh/site-functions/_scarp fish/vendor_completions.d/scarp.fish man/man1/scarp-render.1)
    file(GLOB found ${PREFIX}/share/${file}*)  # manuals may be compressed
    if(NOT found)
      message(FATAL_ERROR "share/${file} is not installed")
    endif()
  endforeach()
endif()
