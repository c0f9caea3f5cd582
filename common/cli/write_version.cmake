# Writes OUT, a header with VERSION, BUILD and the commit of the Git checkout SOURCE; it is touched only when that is another.
find_package(Git QUIET)
set(commit "")
if(GIT_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} -C ${SOURCE} describe --always --tags --dirty
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "#define BONEMILL_VERSION \"${VERSION}\"
#define BONEMILL_BUILD \"${BUILD}\"
#define BONEMILL_COMMIT \"${commit}\"
")
