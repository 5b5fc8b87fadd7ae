# The two targets that others link, and their way into an installed tree:
#   scarp::core   base, vk, field, accel, march: needs neither GDAL, libpng nor OpenEXR
#   scarp::scarp  all stations
# find_package(scarp COMPONENTS core) reads scarp-core-targets.cmake alone and asks for nothing that core does not use.
include(CMakePackageConfigHelpers)

set(core_stations scarp_base scarp_field scarp_accel scarp_march)
if(SCARP_VULKAN)
  list(APPEND core_stations scarp_vk)
endif()
get_property(other_stations GLOBAL PROPERTY SCARP_STATIONS)
list(REMOVE_ITEM other_stations ${core_stations})

add_library(scarp_core INTERFACE)
add_library(scarp::core ALIAS scarp_core)
set_target_properties(scarp_core PROPERTIES EXPORT_NAME core)
target_link_libraries(scarp_core INTERFACE ${core_stations})

add_library(scarp_scarp INTERFACE)
add_library(scarp::scarp ALIAS scarp_scarp)
set_target_properties(scarp_scarp PROPERTIES EXPORT_NAME scarp)
target_link_libraries(scarp_scarp INTERFACE scarp_core ${other_stations})

# A project that adds Scarp as a subfolder installs its own things, not ours.
if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/scarp)
install(TARGETS ${core_stations} scarp_core EXPORT scarp-core FILE_SET HEADERS)
install(TARGETS ${other_stations} scarp_scarp EXPORT scarp-scarp FILE_SET HEADERS)
install(EXPORT scarp-core FILE scarp-core-targets.cmake NAMESPACE scarp:: DESTINATION ${package_folder})
install(EXPORT scarp-scarp FILE scarp-scarp-targets.cmake NAMESPACE scarp:: DESTINATION ${package_folder})

configure_package_config_file(cmake/scarp-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/scarp-config.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/scarp-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/scarp-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/scarp-config-version.cmake
        DESTINATION ${package_folder})

# The command line's target comes into being after this file was read.
function(scarp_install_app)
  if(TARGET scarp)
    install(TARGETS scarp)
  endif()
endfunction()
cmake_language(DEFER CALL scarp_install_app)
