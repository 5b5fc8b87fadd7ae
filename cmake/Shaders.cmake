# scarp_shaders(TARGET FILE.comp ...): compiles compute shaders of the current folder to SPIR-V and lets the target's C++
# files include the words: scarp/accel/FILE.comp becomes #include "scarp/accel/FILE.comp.inc", numbers with commas between. A shader is compiled again when a file that it includes has changed, and so is the C++ that embeds it.
function(scarp_shaders target)
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
  target_sources(${target} PRIVATE ${results})
  target_include_directories(${target} PRIVATE ${folder})
endfunction()
