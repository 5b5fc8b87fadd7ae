# pkg-config files: scarp-core.pc, with SCARP_FILES scarp.pc, and with SCARP_C scarp-c.pc, for the same parts as the targets. Archives do not name
# what they need, so their libraries are not private here.
set(pc_core_libraries "")
foreach(station IN LISTS core_stations)
  list(PREPEND pc_core_libraries -l${station})
endforeach()
set(pc_files_libraries "")
foreach(station IN LISTS other_stations)
  list(PREPEND pc_files_libraries -l${station})
endforeach()
# Dependents come first on a linker's command line; the order of the stations is that of the data.
set(pc_files_requires libpng)
if(SCARP_GDAL)
  list(APPEND pc_files_requires gdal proj)
endif()
if(SCARP_OPENEXR)
  list(APPEND pc_files_requires OpenEXR)
endif()
if(SCARP_CAIRO)
  list(APPEND pc_files_requires cairo)
endif()
if(SCARP_ERFA)
  list(APPEND pc_files_requires erfa)
endif()
if(SCARP_MESH)
  list(APPEND pc_files_requires tinyobjloader tinygltf)
endif()
if(SCARP_EMBREE)
  list(APPEND pc_files_libraries -lembree3)
endif()

# pc_file(NAME DESCRIPTION REQUIRES LIBRARIES COMPONENT)
function(pc_file name description requires libraries component)
  list(JOIN requires ", " requires)
  list(JOIN libraries " " libraries)
  file(WRITE ${PROJECT_BINARY_DIR}/${name}.pc "\
prefix=\${pcfiledir}/${up}
Name: ${name}
Description: ${description}
Version: ${PROJECT_VERSION}
Requires: ${requires}
Libs: -L\${prefix}/${CMAKE_INSTALL_LIBDIR} ${libraries}
Cflags: -I\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}
")
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT ${component})
endfunction()

# From <prefix>/<libdir>/pkgconfig back to the prefix, which is two folders up for lib and three for lib/<triplet>.
set(up "")
string(REGEX REPLACE "[^/]+" ".." up "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
set(pc_core_requires fmt glm libhwy)
if(SCARP_TBB)
  list(APPEND pc_core_requires tbb)
endif()
pc_file(scarp-core "Rays over height fields and voxel grids" "${pc_core_requires}" "${pc_core_libraries}" core)
if(SCARP_FILES)
  pc_file(scarp "Rays over height fields and voxel grids: files and pictures" "scarp-core = ${PROJECT_VERSION};${pc_files_requires}"
          "${pc_files_libraries}" files)
endif()
if(SCARP_C)
  pc_file(scarp-c "Rays over height fields and voxel grids: C interface" "" -lscarp_c c_dev)
endif()
