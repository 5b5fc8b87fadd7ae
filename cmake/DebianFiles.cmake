# Run by CPack before it packs: each folder of CPACK_TEMPORARY_DIRECTORY is the tree of one package.
file(READ ${CPACK_SCARP_SOURCE}/LICENSE license)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
set(changelog "scarp (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * Version ${CPACK_PACKAGE_VERSION}; CHANGELOG.md of the source lists what it has.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")

# gzip without a name and a time in it, as Debian asks.
function(compress)
  execute_process(COMMAND gzip -9 -n -f ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

string(REGEX MATCH "^[0-9]+\\.[0-9]+" soversion ${CPACK_PACKAGE_VERSION})
foreach(pair app:scarp dev:libscarp-dev clib:libscarp-c${soversion} python:python3-pyscarp)
  string(REPLACE ":" ";" pair ${pair})
  list(GET pair 0 group)
  list(GET pair 1 package)
  if(NOT EXISTS ${CPACK_TEMPORARY_DIRECTORY}/${group})
    continue()
  endif()
  set(share ${CPACK_TEMPORARY_DIRECTORY}/${group}${CPACK_PACKAGING_INSTALL_PREFIX}/share)
  set(doc ${share}/doc/${package})
  file(REMOVE_RECURSE ${share}/doc)
  file(WRITE ${doc}/copyright "${license}")
  file(WRITE ${doc}/changelog "${changelog}")
  compress(${doc}/changelog)
  file(GLOB manuals ${share}/man/man1/*.1)
  if(manuals)
    compress(${manuals})
  endif()
endforeach()
