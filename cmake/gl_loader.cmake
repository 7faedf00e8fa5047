# sheer_gl_loader(TARGET): the OpenGL loader <glad/gl.h> that Debian's glad generates from its own copy of the
# specification, and the generated header used_gl_functions.h with the names of the functions that the sources call.
function(sheer_gl_loader target)
  find_program(GLAD glad REQUIRED DOC "The generator of Debian's python3-glad")
  set(folder ${CMAKE_BINARY_DIR}/generated/glad)
  set(loader ${folder}/include/glad/gl.h)
  set(loader_source ${folder}/src/gl.c)
  # With --header-only it would hide parts of <KHR/khrplatform.h> that EGL's headers need.
  add_custom_command(
    OUTPUT ${loader} ${loader_source}
    COMMAND ${GLAD} --quiet --reproducible --api gl:core=4.5 --extensions= --out-path ${folder} c --mx
    COMMENT "Generating the OpenGL loader"
    VERBATIM)

  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/renderer/*.cpp ${CMAKE_SOURCE_DIR}/renderer/*.h
       ${CMAKE_SOURCE_DIR}/server/*.cpp ${CMAKE_SOURCE_DIR}/server/*.h)
  set(used ${CMAKE_BINARY_DIR}/generated/used_gl_functions.h)
  set(script ${CMAKE_SOURCE_DIR}/cmake/write_used_gl_functions.cmake)
  add_custom_command(
    OUTPUT ${used}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${used} -DLOADER=${loader} "-DSOURCES=${sources}" -P ${script}
    DEPENDS ${loader} ${sources} ${script}
    COMMENT "Looking up the OpenGL functions in use"
    VERBATIM)

  add_custom_target(sheer_gl_loader DEPENDS ${loader} ${used})
  add_dependencies(${target} sheer_gl_loader)
  target_include_directories(${target} SYSTEM PUBLIC ${folder}/include)
  # Compiled as C++ like the rest; it is valid C and C++.
  set_source_files_properties(${loader_source} PROPERTIES LANGUAGE CXX SKIP_UNITY_BUILD_INCLUSION ON)
  target_sources(${target} PRIVATE ${loader_source})
endfunction()
