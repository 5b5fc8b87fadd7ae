# scarp_link_soon(target): links with LLVM's linker, where the compiler finds it, in a third to a half of the time. For what nobody is given to
# use. `-D SCARP_LLD=OFF`: the system's. LLVM's does not read what g++ leaves for optimisation at link time.
include(CheckLinkerFlag)
check_linker_flag(CXX -fuse-ld=lld SCARP_LLD)
function(scarp_link_soon target)
  if(SCARP_LLD AND NOT CMAKE_INTERPROCEDURAL_OPTIMIZATION)
    target_link_options(${target} PRIVATE -fuse-ld=lld)
  endif()
endfunction()

# scarp_compile_options(target): warnings, sanitizers and strict floating point for what is built here.
# Private on purpose: nobody who links Scarp inherits them.
function(scarp_compile_options target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  # No contraction to fused multiply-add: the same text must give the same bits on every machine.
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                                           -ffp-contract=off)
  if(SCARP_WERROR)
    # Not where g++ follows an optional through functions that it has put into one another.
    target_compile_options(${target} PRIVATE -Werror $<$<CXX_COMPILER_ID:GNU>:-Wno-error=maybe-uninitialized>)
  endif()
  if(SCARP_SANITIZE)
    # What is found ends the program: undefined behaviour that is only printed fails no test.
    target_compile_options(${target} PRIVATE -fsanitize=${SCARP_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${SCARP_SANITIZE})
    scarp_link_soon(${target})
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      # Checks of every pointer for null and alignment take a third of the time to compile; the address sanitizer reports
      # null pointers as well. Its checks are what g++ takes for reading values that were never set.
      target_compile_options(${target} PRIVATE -fno-sanitize=null,alignment -Wno-maybe-uninitialized)
    endif()
  endif()
endfunction()

# scarp_unity(target [MOST FILES] [ALONE FILE...]): compiles that many files of the target (12) as one: headers take most of the
# time. Files for Vulkan, whose headers are the largest, are batches of their own. Call it when the target has all its files.
# `-D SCARP_UNITY=OFF` compiles file by file and finds missing includes; ./dev test --long does so.
# ALONE: files whose local names clash with others'. Files with options of their own are compiled alone, too.
function(scarp_unity target)
  cmake_parse_arguments(arg "" "MOST" "ALONE" ${ARGN})
  if(NOT SCARP_UNITY)
    return()
  endif()
  if(NOT arg_MOST)
    set(arg_MOST 12)
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(all ${target} SOURCES)
  list(FILTER all INCLUDE REGEX "\\.cpp$")
  list(FILTER all EXCLUDE REGEX "_simd\\.cpp$")
  list(REMOVE_ITEM all ${arg_ALONE})
  set(vulkan ${all})
  list(FILTER vulkan INCLUDE REGEX "_vk\\.cpp$")
  list(FILTER all EXCLUDE REGEX "_vk\\.cpp$")
  foreach(kind all vulkan)
    set(count 0)
    foreach(source IN LISTS ${kind})
      math(EXPR batch "${count} / ${arg_MOST} + 1")
      math(EXPR count "${count} + 1")
      set_property(SOURCE ${source} PROPERTY UNITY_GROUP ${kind}_${batch})
    endforeach()
  endforeach()
  # To g++, what a file has in its anonymous namespace is in a header then.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
endfunction()

# scarp_quick(FILE or TARGET...): compiles these without optimisation in the debug build with sanitizers, where that takes a half to a
# tenth of the time. For what no test waits for.
function(scarp_quick)
  if(NOT CMAKE_BUILD_TYPE STREQUAL "Debug" OR NOT SCARP_SANITIZE)
    return()
  endif()
  foreach(item ${ARGN})
    if(TARGET ${item})
      target_compile_options(${item} PRIVATE -O0)
    else()
      set_source_files_properties(${item} PROPERTIES COMPILE_OPTIONS -O0)
    endif()
  endforeach()
endfunction()

# scarp_station(NAME SOURCES ... HEADERS ... APP_HEADERS ... STATIONS ... PUBLIC_LIBRARIES ... LIBRARIES ...)
# One library per station of the data's way: target scarp_NAME, exported as scarp::NAME. STATIONS are the stations it may see.
# HEADERS are public: they are installed, and doc/library/versions.md applies. APP_HEADERS are not; app/, bench/ and
# python/ include them all the same. Headers in neither list are for stations and tests (test/house/public_headers.cmake).
function(scarp_station name)
  cmake_parse_arguments(arg "" "" "SOURCES;HEADERS;APP_HEADERS;STATIONS;PUBLIC_LIBRARIES;LIBRARIES" ${ARGN})
  add_library(scarp_${name} ${arg_SOURCES})
  add_library(scarp::${name} ALIAS scarp_${name})
  set_target_properties(scarp_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON
                        VISIBILITY_INLINES_HIDDEN ON VERSION ${PROJECT_VERSION}
                        SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  if(NOT BUILD_SHARED_LIBS)
    # A plug-in that links the archives exports none of their symbols.
    set_target_properties(scarp_${name} PROPERTIES CXX_VISIBILITY_PRESET hidden)
  endif()
  target_sources(scarp_${name} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${arg_HEADERS})
  list(TRANSFORM arg_APP_HEADERS PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  set_property(GLOBAL APPEND PROPERTY SCARP_APP_HEADERS ${arg_APP_HEADERS})
  list(TRANSFORM arg_STATIONS PREPEND scarp_)
  target_link_libraries(scarp_${name} PUBLIC ${arg_STATIONS} ${arg_PUBLIC_LIBRARIES} PRIVATE ${arg_LIBRARIES})
  scarp_compile_options(scarp_${name})
  # Vectors are compiled for each set of instructions.
  set(vectors ${arg_SOURCES})
  list(FILTER vectors INCLUDE REGEX "_simd\\.cpp$")
  scarp_quick(${vectors})
  if(SCARP_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    # Where there are no vectors Highway converts lane by lane with C++'s casts, which vectors do for any number.
    set_property(SOURCE ${vectors} APPEND PROPERTY COMPILE_OPTIONS -fno-sanitize=float-cast-overflow)
  endif()
  # Highway includes each of them again for every set.
  set_property(SOURCE ${vectors} PROPERTY SKIP_UNITY_BUILD_INCLUSION ON)
  set_property(GLOBAL APPEND PROPERTY SCARP_STATIONS scarp_${name})
endfunction()
