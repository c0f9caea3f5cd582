# The Debian packages that deploy/package has CPack make of the components of CMakeLists.txt.
set(CPACK_GENERATOR DEB)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_PACKAGE_NAME bonemill)
set(CPACK_PACKAGE_VENDOR "The bonemill authors")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL session viewer library dev doc)
if(TARGET bonemill_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "The bonemill authors <bonemill@example.org>")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# Both packages come of one build: the session's launcher and scenes are those of its viewer.
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_COMPONENT_SESSION_DEPENDS viewer)

set(CPACK_DEBIAN_SESSION_PACKAGE_NAME bonemill)
set(CPACK_DEBIAN_SESSION_DESCRIPTION "haptic bone-milling simulator
A trainee holds a six-degree-of-freedom handle and mills bone from a CT scan,
feels it at 1000 Hz, and everyone else watches. This package has the server,
the device daemon with the emulator of ARES, the bridges to haptic arms, the
tools for cases, phantoms and studies, and the scenes.
.
Whoever is in the group haptics runs the loops in real time.")
set(CPACK_DEBIAN_SESSION_PACKAGE_DEPENDS "passwd")
set(CPACK_DEBIAN_SESSION_PACKAGE_RECOMMENDS "gnuplot-nox, python3")
set(CPACK_DEBIAN_SESSION_PACKAGE_SUGGESTS "bonemill-doc, invesalius-examples, spacenavd")
set(CPACK_DEBIAN_SESSION_PACKAGE_CONTROL_EXTRA
  "${CMAKE_CURRENT_LIST_DIR}/debian/conffiles;${CMAKE_CURRENT_LIST_DIR}/debian/postinst;${CMAKE_CURRENT_LIST_DIR}/debian/postrm")

# libgl1 is loaded by name; `bonemill watch` asks ip for its way, and invitations are made by openssl.
set(CPACK_DEBIAN_VIEWER_PACKAGE_NAME bonemill-viewer)
set(CPACK_DEBIAN_VIEWER_DESCRIPTION "viewer of haptic bone-milling sessions
Watches a session of another PC, in a window or as pictures, over DDS or
through a gateway; is that gateway, and its relay; says it to ROS 2. It is
what the PC of a pupil needs: bonemill watch HOST.")
set(CPACK_DEBIAN_VIEWER_PACKAGE_DEPENDS "fonts-dejavu-core, iproute2, libgl1, openssl")
set(CPACK_DEBIAN_VIEWER_PACKAGE_RECOMMENDS "xdg-utils")
set(CPACK_DEBIAN_VIEWER_PACKAGE_SUGGESTS "ffmpeg, qrencode")

set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libbonemill${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "haptic bone milling for programs (library)
The tick of a bone-milling session, one call a tick: a hand goes in, force,
contact and removed bone come out. It needs no device and no other process.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA "${CMAKE_CURRENT_LIST_DIR}/debian/library/triggers")
set(CPACK_COMPONENT_DEV_DEPENDS library)
set(CPACK_DEBIAN_DEV_PACKAGE_NAME bonemill-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEV_DESCRIPTION "haptic bone milling for programs (header)
What compiles against libbonemill: one header, find_package(bonemill), and an
example.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-bonemill)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
get_property(python GLOBAL PROPERTY BONEMILL_PYTHON)
string(REGEX REPLACE "^3\\." "" python_minor "${python}")
math(EXPR next_minor "0${python_minor} + 1")
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.${python_minor}), python3 (<< 3.${next_minor}), python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "bonemill, gnuplot-nox")
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "haptic bone milling for Python
The tick of a bone-milling session, one call a tick or whole arrays at once;
recorded sessions, run again to the bit or on with another hand; a learning
environment with Gymnasium's interface.")

set(CPACK_DEBIAN_DOC_PACKAGE_NAME bonemill-doc)
set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOC_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOC_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DOC_DESCRIPTION "handbook of the haptic bone-milling simulator
Tutorials, how to, reference and explanation for who teaches with bonemill,
runs its laboratory, does research on it, or changes it, to be read in a
browser without a net: bonemill handbook.")

# Each package says under which licence it is, and what has changed. deploy/package writes what depends on the version.
foreach(component ${CPACK_COMPONENTS_ALL})
  string(TOUPPER ${component} upper)
  set(folder share/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${folder} RENAME copyright COMPONENT ${component})
  install(FILES ${CMAKE_BINARY_DIR}/changelog.gz DESTINATION ${folder} COMPONENT ${component} OPTIONAL)
endforeach()
include(CPack)
