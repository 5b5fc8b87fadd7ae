# shader_compiles(NAME GOOD OPTION...): runs the GLSL validator with these options. Fails if a shader that is GOOD does
# not compile, or if another one does: then the check itself is broken.
function(shader_compiles name good)
  execute_process(COMMAND ${VALIDATOR} ${ARGN} RESULT_VARIABLE failed OUTPUT_VARIABLE said)
  if(good AND failed)
    message(FATAL_ERROR "${name} does not compile:\n${said}")
  elseif(NOT good AND NOT failed)
    message(FATAL_ERROR "the check is broken: ${name} compiles")
  endif()
endfunction()
