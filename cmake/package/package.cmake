# Debian packages, one for each component: ./dev package.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "Sheer")
set(CPACK_PACKAGE_CONTACT "Sheer's authors <sheer@localhost>")
set(CPACK_INSTALL_PREFIX /usr)
# The configuration is in /etc.
set(CPACK_SET_DESTDIR ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
if(TARGET sheer)
  set(CPACK_COMPONENTS_ALL sheer)
else()
  set(CPACK_COMPONENTS_ALL sheer-bench)
endif()

set(CPACK_DEBIAN_SHEER_PACKAGE_NAME sheer)
set(CPACK_COMPONENT_SHEER_DESCRIPTION "compares ways to draw transparency
 Renders a scene with many methods of transparency, times them, compares each
 picture with an exact reference and keeps a report, on the command line or as
 a service.")
# A driver that renders on the processor, for hosts without a GPU.
set(CPACK_DEBIAN_SHEER_PACKAGE_DEPENDS libgl1-mesa-dri)
set(CPACK_DEBIAN_SHEER_PACKAGE_CONTROL_EXTRA
    "${CMAKE_SOURCE_DIR}/cmake/package/postinst;${CMAKE_SOURCE_DIR}/cmake/package/prerm;${CMAKE_SOURCE_DIR}/cmake/package/postrm;${CMAKE_SOURCE_DIR}/cmake/package/conffiles")

set(CPACK_DEBIAN_SHEER-BENCH_PACKAGE_NAME sheer-bench)
set(CPACK_COMPONENT_SHEER-BENCH_DESCRIPTION "measures ways to draw transparency, with EGL alone
 The measurements of sheer as numbers, for hosts that have a GPU and little else.")
include(CPack)
