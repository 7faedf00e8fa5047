# sheer_version(TARGET): the generated header version.h with the version and the commit, updated at every build.
function(sheer_version target)
  set(output ${CMAKE_BINARY_DIR}/generated/version.h)
  add_custom_target(sheer_version_header
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DVERSION=${PROJECT_VERSION} -DROOT=${CMAKE_SOURCE_DIR}
            -P ${CMAKE_SOURCE_DIR}/cmake/write_version.cmake
    BYPRODUCTS ${output}
    COMMENT "Looking up the version")
  add_dependencies(${target} sheer_version_header)
endfunction()
