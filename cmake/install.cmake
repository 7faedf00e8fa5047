# What a package of Sheer contains besides its programs, which need none of it: shaders, page, ready-made specs and suites
# are compiled in. These files are to read and to start from: specs, models, a configuration with every default, schemas,
# documents.
include(GNUInstallDirs)

install(TARGETS sheer-bench)
install(DIRECTORY configs/ DESTINATION ${CMAKE_INSTALL_DATADIR}/sheer/configs)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
# The text of the licence from the distribution.
find_file(APACHE_LICENSE Apache-2.0 PATHS /usr/share/common-licenses NO_DEFAULT_PATH)
if(APACHE_LICENSE)
  install(FILES ${APACHE_LICENSE} DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME LICENSE)
endif()
