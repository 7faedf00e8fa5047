# The manual and the completions, which the program prints itself, so that they are always those of its options.
set(manual_folder ${CMAKE_BINARY_DIR}/manual)
add_custom_command(
  OUTPUT ${manual_folder}/sheer.1.gz ${manual_folder}/sheer ${manual_folder}/sheer.fish
  COMMAND ${CMAKE_COMMAND} -E make_directory ${manual_folder}
  COMMAND sheer manual | gzip -9n > ${manual_folder}/sheer.1.gz
  COMMAND sheer completion bash > ${manual_folder}/sheer
  COMMAND sheer completion fish > ${manual_folder}/sheer.fish
  DEPENDS sheer sheer-render
  VERBATIM)
add_custom_target(manual DEPENDS ${manual_folder}/sheer.1.gz)
install(FILES ${manual_folder}/sheer.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT sheer OPTIONAL)
install(FILES ${manual_folder}/sheer DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT sheer
        OPTIONAL)
install(FILES ${manual_folder}/sheer.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT sheer
        OPTIONAL)
