# Debian's libopenigtlink, and the programs whose source openigtlink-examples has: the tests' judges and peers. No
# program of ours links it.
#   find_openigtlink()              makes the target openigtlink
#   bonemill_openigtlink_example(<name> <source below the package's folder>)
macro(find_openigtlink)
  if(NOT TARGET openigtlink)
    find_path(OPENIGTLINK_HEADERS igtlTransformMessage.h PATH_SUFFIXES openigtlink REQUIRED)
    find_library(OPENIGTLINK_LIBRARY OpenIGTLink REQUIRED)
    add_library(openigtlink INTERFACE IMPORTED GLOBAL)
    target_include_directories(openigtlink SYSTEM INTERFACE ${OPENIGTLINK_HEADERS})
    target_link_libraries(openigtlink INTERFACE ${OPENIGTLINK_LIBRARY})
  endif()
endmacro()

function(bonemill_openigtlink_example name source)
  find_openigtlink()
  set(folder /usr/share/doc/openigtlink-examples/examples)
  add_executable(${name} ${folder}/${source})
  target_link_libraries(${name} PRIVATE openigtlink)
  target_compile_options(${name} PRIVATE -w)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests UNITY_BUILD OFF)
endfunction()
