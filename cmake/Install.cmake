# The targets that others link, and their way into an installed tree:
#   scarp::core   base, vk, field, accel, march, scene: needs neither GDAL, libpng nor OpenEXR
#   scarp::scarp  all stations
#   scarp::c      the C interface, a shared library that contains what it needs of core
# find_package(scarp COMPONENTS core) reads scarp-core-targets.cmake alone and asks for nothing that core does not use.
include(CMakePackageConfigHelpers)

set(core_stations scarp_base scarp_field scarp_accel scarp_march scarp_scene)
if(SCARP_VULKAN)
  list(INSERT core_stations 1 scarp_vk)  # before those that see it
endif()
get_property(other_stations GLOBAL PROPERTY SCARP_STATIONS)
list(REMOVE_ITEM other_stations ${core_stations})

add_library(scarp_core INTERFACE)
add_library(scarp::core ALIAS scarp_core)
set_target_properties(scarp_core PROPERTIES EXPORT_NAME core)
target_link_libraries(scarp_core INTERFACE ${core_stations})

if(SCARP_FILES)
  add_library(scarp_scarp INTERFACE)
  add_library(scarp::scarp ALIAS scarp_scarp)
  set_target_properties(scarp_scarp PROPERTIES EXPORT_NAME scarp)
  target_link_libraries(scarp_scarp INTERFACE scarp_core ${other_stations})
endif()

# A project that adds Scarp as a subfolder installs its own things, not ours.
if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/scarp)
# Components, each installed by itself with cmake --install BUILD --component NAME once its targets are built: core,
# files (the rest of the library), app (the command line), c (the C interface as programs load it) and c_dev (what they are
# built with). A component without a file is installed with core.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME core)
install(TARGETS ${core_stations} scarp_core EXPORT scarp-core FILE_SET HEADERS FILE_SET version)
install(EXPORT scarp-core FILE scarp-core-targets.cmake NAMESPACE scarp:: DESTINATION ${package_folder})
if(SCARP_FILES)
  install(TARGETS ${other_stations} scarp_scarp EXPORT scarp-scarp FILE_SET HEADERS COMPONENT files
          ARCHIVE COMPONENT files LIBRARY COMPONENT files)
  install(EXPORT scarp-scarp FILE scarp-scarp-targets.cmake NAMESPACE scarp:: DESTINATION ${package_folder} COMPONENT files)
endif()
if(SCARP_C)
  install(TARGETS scarp_c EXPORT scarp-c FILE_SET HEADERS COMPONENT c_dev RUNTIME COMPONENT c ARCHIVE COMPONENT c_dev
          LIBRARY COMPONENT c NAMELINK_COMPONENT c_dev)
  install(EXPORT scarp-c FILE scarp-c-targets.cmake NAMESPACE scarp:: DESTINATION ${package_folder} COMPONENT c_dev)
endif()
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
include(PkgConfig)

configure_package_config_file(cmake/scarp-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/scarp-config.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/scarp-config-version.cmake COMPATIBILITY SameMinorVersion)
set(package_files ${CMAKE_CURRENT_BINARY_DIR}/scarp-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/scarp-config-version.cmake)
install(FILES ${package_files} DESTINATION ${package_folder})
if(SCARP_C)
  install(FILES ${package_files} DESTINATION ${package_folder} COMPONENT c_dev)
endif()

# The shader texts: as they are, for hosts with #include, under the paths that they include one another by; and each
# march, and the ground in textures, with all that it needs in one file, for pasting.
set(shader_folder ${CMAKE_INSTALL_DATADIR}/scarp/glsl)
set(marches_as_text height/max_mip height/height_marches)
set(function_marches_as_text function/function_marches function/lipschitz_local shape/sphere_trace)
set(shader_texts scarp/vk/glsl_cpp.h scarp/accel/voxel_marks.glsl.h scarp/accel/ground_buffers.glsl.h scarp/accel/function_buffers.glsl.h
    scarp/accel/shape_buffers.glsl.h)
foreach(name ${marches_as_text} ${function_marches_as_text} sampling/naive sampling/fixed_step sampling/relaxed
        sampling/lipschitz sampling/sampling sampling/sampling_marches march_state two_float ray_states height/ray_frame height/float_ray height/two_float_ray
        height/cell_surface height/surface_normal height/height_probe height/max_mip_easy height/textures function/noise function/function_heights
        voxel/voxel_wide voxel/voxel_walk voxel/voxel_planes voxel/voxel_spheres voxel/voxel_cubes voxel/voxel_bricks
        voxel/voxel_marches voxel/voxel_double voxel/voxel_quantise voxel/voxel_float_ray voxel/voxel_textures
        function/function_bounds function/function_frame shape/shape_distance shape/shape_grounds)
  list(APPEND shader_texts scarp/march/${name}.glsl.h)
endforeach()
foreach(text IN LISTS shader_texts)
  cmake_path(GET text PARENT_PATH folder)
  install(FILES ${text} DESTINATION ${shader_folder}/${folder})
endforeach()
set(flat_texts "")
list(TRANSFORM shader_texts PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE all_texts)
foreach(name IN LISTS marches_as_text function_marches_as_text ITEMS height/max_mip_easy height/textures
        voxel/voxel_marches voxel/voxel_textures)
  set(files ${PROJECT_SOURCE_DIR}/scarp/march/${name}.glsl.h)
  if(name IN_LIST marches_as_text)
    string(PREPEND files ${PROJECT_SOURCE_DIR}/scarp/march/height/float_ray.glsl.h,)
  endif()
  if(name STREQUAL voxel/voxel_marches)
    set(files ${PROJECT_SOURCE_DIR}/scarp/march/voxel/voxel_float_ray.glsl.h)
  endif()
  cmake_path(GET name FILENAME flat_name)
  set(flat ${PROJECT_BINARY_DIR}/glsl/${flat_name}.glsl)
  set(flatten ${CMAKE_CURRENT_SOURCE_DIR}/cmake/FlattenGlsl.cmake)
  add_custom_command(OUTPUT ${flat}
    COMMAND ${CMAKE_COMMAND} -D ROOT=${PROJECT_SOURCE_DIR} -D OUT=${flat}
            -D FILES=${files} -P ${flatten}
    DEPENDS ${all_texts} ${flatten} VERBATIM)
  list(APPEND flat_texts ${flat})
endforeach()
add_custom_target(scarp_flat_texts ALL DEPENDS ${flat_texts})
install(FILES ${flat_texts} DESTINATION ${shader_folder})
# The short ones, as they are: marches over a function of the shader's own, max-mip, and complete shaders that use them.
set(easy_texts "")
foreach(name naive relaxed lipschitz fixed_step)
  list(APPEND easy_texts scarp/march/sampling/${name}_easy.glsl)
  install(FILES scarp/march/sampling/${name}_easy.glsl DESTINATION ${shader_folder}/easy RENAME ${name}.glsl)
endforeach()
install(FILES ${PROJECT_BINARY_DIR}/glsl/max_mip_easy.glsl DESTINATION ${shader_folder}/easy RENAME max_mip.glsl)
install(DIRECTORY examples/shaders/ DESTINATION ${shader_folder}/easy/examples)

# For editors that complete scene files by their schema.
install(FILES scarp/scene/file/scene.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/scarp)

# The command line's target comes into being after this file was read.
function(scarp_install_app)
  if(TARGET scarp)
    install(TARGETS scarp COMPONENT app)
  endif()
  if(TARGET scarp-view)
    install(TARGETS scarp-view COMPONENT app)
  endif()
  if(TARGET scarp_share)
    install(DIRECTORY ${PROJECT_BINARY_DIR}/app/cli/share/ DESTINATION ${CMAKE_INSTALL_DATADIR} COMPONENT app)
  endif()
endfunction()
cmake_language(DEFER CALL scarp_install_app)
