# What the packages contain: `sheer`, and `sheer-bench`, which needs no library but EGL. A program is one line here.
# The programs need no other file, since shaders, page, ready-made specs and suites are compiled in. The rest is to read
# and to start from: specs, models, a configuration with every default, schemas, documents.
include(GNUInstallDirs)

install(TARGETS sheer-bench COMPONENT sheer-bench)
if(TARGET sheer)
  install(TARGETS sheer sheer-render COMPONENT sheer)
  include(cmake/package/manual.cmake)
  install(DIRECTORY configs/ DESTINATION ${CMAKE_INSTALL_DATADIR}/sheer/configs COMPONENT sheer)
  install(FILES configs/server.json DESTINATION /etc/sheer COMPONENT sheer)
  install(FILES cmake/package/sheer.service DESTINATION lib/systemd/system COMPONENT sheer)
  install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT sheer)
endif()

# The text of the licence from the distribution.
find_file(APACHE_LICENSE Apache-2.0 PATHS /usr/share/common-licenses NO_DEFAULT_PATH)
foreach(package sheer sheer-bench)
  set(folder ${CMAKE_INSTALL_DATAROOTDIR}/doc/${package})
  install(FILES README.md CHANGELOG.md DESTINATION ${folder} COMPONENT ${package})
  if(APACHE_LICENSE)
    install(FILES ${APACHE_LICENSE} DESTINATION ${folder} COMPONENT ${package} RENAME copyright)
  endif()
endforeach()

include(cmake/package/package.cmake)
