# scarp_compile_options(target): warnings, sanitizers and strict floating point for what is built here.
# Private on purpose: nobody who links Scarp inherits them.
function(scarp_compile_options target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  # No contraction to fused multiply-add: the same text must give the same bits on every machine.
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                                           -ffp-contract=off)
  if(SCARP_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(SCARP_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${SCARP_SANITIZE} -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${SCARP_SANITIZE})
  endif()
endfunction()

# scarp_station(NAME SOURCES ... HEADERS ... STATIONS ... PUBLIC_LIBRARIES ... LIBRARIES ...)
# One library per station of the data's way: target scarp_NAME, exported as scarp::NAME. STATIONS are the stations it may see.
function(scarp_station name)
  cmake_parse_arguments(arg "" "" "SOURCES;HEADERS;STATIONS;PUBLIC_LIBRARIES;LIBRARIES" ${ARGN})
  add_library(scarp_${name} STATIC ${arg_SOURCES})
  add_library(scarp::${name} ALIAS scarp_${name})
  set_target_properties(scarp_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_sources(scarp_${name} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${arg_HEADERS})
  list(TRANSFORM arg_STATIONS PREPEND scarp_)
  target_link_libraries(scarp_${name} PUBLIC ${arg_STATIONS} ${arg_PUBLIC_LIBRARIES} PRIVATE ${arg_LIBRARIES})
  scarp_compile_options(scarp_${name})
  set_property(GLOBAL APPEND PROPERTY SCARP_STATIONS scarp_${name})
endfunction()
