# scarp_shaders(STATION FILE.comp ...): compiles compute shaders of the current folder to SPIR-V and lets the station's
# C++ files include the words: scarp/STATION/FILE.comp becomes #include "scarp/STATION/FILE.comp.inc", numbers with commas
# between. A shader is compiled again when a file that it includes has changed, and so is the C++ that embeds it.
function(scarp_shaders station)
  set(folder ${PROJECT_BINARY_DIR}/shaders)
  set(results "")
  foreach(file IN LISTS ARGN)
    file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/${file})
    set(out ${folder}/${path}.inc)
    cmake_path(GET out PARENT_PATH out_folder)
    file(MAKE_DIRECTORY ${out_folder})
    add_custom_command(OUTPUT ${out}
      COMMAND Vulkan::glslc --target-env=vulkan1.2 -O -Werror -mfmt=num -I ${PROJECT_SOURCE_DIR} -MD -MF ${out}.d -MT ${out}
              -o ${out} ${CMAKE_CURRENT_SOURCE_DIR}/${file}
      DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${file}
      DEPFILE ${out}.d
      COMMENT "Compiling shader ${path}"
      VERBATIM)
    list(APPEND results ${out})
  endforeach()
  target_sources(scarp_${station} PRIVATE ${results})
  target_include_directories(scarp_${station} PRIVATE ${folder})
endfunction()
