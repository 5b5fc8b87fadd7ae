# Debian packages, made by ./dev package: `scarp`, the command line, `libscarp-dev`, the library with its headers,
# `libscarp-c0.1`, the C interface as programs load it, and `python3-pyscarp`, the Python package.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The Scarp authors <scarp@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "ray engine for height fields and voxel grids")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
# What Debian asks of every package beside the files: copyright, changelog, compressed manuals.
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/DebianFiles.cmake)
set(CPACK_SCARP_SOURCE ${PROJECT_SOURCE_DIR})

set(CPACK_DEBIAN_APP_PACKAGE_NAME scarp)
set(CPACK_DEBIAN_APP_PACKAGE_SECTION science)
set(CPACK_DEBIAN_APP_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_APP_PACKAGE_RECOMMENDS libvulkan1)
set(CPACK_DEBIAN_APP_DESCRIPTION "The command line: renders pictures of elevation models, procedural terrain,
voxel models and scenes of them, and traces rays from files.")

if(SCARP_C)
  set(CPACK_DEBIAN_CLIB_PACKAGE_NAME libscarp-c${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  set(CPACK_DEBIAN_CLIB_PACKAGE_SECTION libs)
  set(CPACK_DEBIAN_CLIB_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_CLIB_PACKAGE_GENERATE_SHLIBS ON)
  set(CPACK_DEBIAN_CLIB_DESCRIPTION "The C interface as programs load it: exact ray queries on height fields and
voxel grids, for programs in any language.")
endif()

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libscarp-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(dev_depends libfmt-dev libglm-dev libtbb-dev libhwy-dev libpng-dev)
foreach(pair SCARP_GDAL:libgdal-dev SCARP_GDAL:libproj-dev SCARP_OPENEXR:libopenexr-dev SCARP_CAIRO:libcairo2-dev
             SCARP_CAIRO:pkg-config SCARP_ERFA:liberfa-dev SCARP_ERFA:pkg-config SCARP_MESH:libtinyobjloader-dev SCARP_MESH:libtinygltf-dev SCARP_EMBREE:libembree-dev)
  string(REPLACE ":" ";" pair ${pair})
  list(GET pair 0 option)
  if(${option})
    list(GET pair 1 package)
    list(APPEND dev_depends ${package})
  endif()
endforeach()
if(SCARP_C)
  list(APPEND dev_depends "${CPACK_DEBIAN_CLIB_PACKAGE_NAME} (= ${PROJECT_VERSION})")
endif()
list(JOIN dev_depends ", " CPACK_DEBIAN_DEV_PACKAGE_DEPENDS)
set(CPACK_DEBIAN_DEV_DESCRIPTION "The C++ library: exact ray queries on height fields, terrain functions and
voxel grids, alone or in scenes, as single rays and in batches, on processors
and Vulkan devices. With CMake and pkg-config files, and the marches as GLSL.")

# Named here: the command line is installed by a deferred call, after this file.
set(CPACK_COMPONENTS_ALL app core files)
if(SCARP_C)
  list(APPEND CPACK_COMPONENTS_ALL c c_dev)
endif()
if(SCARP_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  # The module works in this release of Python only.
  string(REGEX MATCH "^([0-9]+)[.]([0-9]+)" release ${SCARP_PYTHON_RELEASE})
  math(EXPR next "${CMAKE_MATCH_2} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-pyscarp)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "python3 (>= ${release}~), python3 (<< ${CMAKE_MATCH_1}.${next}), python3-numpy (>= 1:1.20)")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "scarp, python3-xarray, python3-rioxarray, python3-tqdm")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_LIST_DIR}/debian/postinst
      ${CMAKE_CURRENT_LIST_DIR}/debian/prerm)
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "The Python package: ray queries, viewsheds, shadows, horizons and pictures of
elevation models and voxels, on NumPy arrays and DataArrays without copies.")
endif()
include(CPack)
cpack_add_component_group(app)
cpack_add_component_group(dev)
cpack_add_component(app GROUP app)
cpack_add_component(core GROUP dev)
cpack_add_component(files GROUP dev)
if(SCARP_C)
  cpack_add_component_group(clib)
  cpack_add_component(c GROUP clib)
  cpack_add_component(c_dev GROUP dev)
endif()
if(SCARP_PYTHON)
  cpack_add_component_group(python)
  cpack_add_component(python GROUP python)
endif()
