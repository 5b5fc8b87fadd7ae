# A project that adds Scarp as a subfolder gets scarp::core and needs no library for files, pictures or devices:
#   cmake -D ROOT=<checkout> -D WORK=<scratch folder> -D GENERATOR=... -D CXX=<compiler> -P core_only.cmake
cmake_minimum_required(VERSION 3.25)

file(REMOVE_RECURSE ${WORK})
file(WRITE ${WORK}/CMakeLists.txt "\
cmake_minimum_required(VERSION 3.25)
project(game LANGUAGES CXX)
foreach(package PNG nlohmann_json GDAL PROJ valijson OpenEXR PkgConfig tinyobjloader TinyGLTF embree Vulkan CLI11 GTest)
  set(CMAKE_DISABLE_FIND_PACKAGE_\${package} ON)
endforeach()
add_subdirectory(${ROOT} scarp)
add_executable(game ${ROOT}/test/house/outside/core.cpp)
target_link_libraries(game PRIVATE scarp::core)
get_property(stations GLOBAL PROPERTY SCARP_STATIONS)
message(STATUS \"stations: \${stations}\")
")
execute_process(COMMAND ${CMAKE_COMMAND} -S ${WORK} -B ${WORK}/build -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX}
                OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "scarp::core alone does not configure (${status}):\n${output}")
endif()
if(NOT output MATCHES "stations: scarp_base;scarp_field;scarp_accel;scarp_march;scarp_scene\n")
  message(FATAL_ERROR "not only the stations of scarp::core are built:\n${output}")
endif()
