# sheer_embed(TARGET NAME FOLDER...): compiles the files of the folders into the program, so that it runs from any folder.
# Declared in the generated header embedded_<NAME>.h as
# `std::span<const sheer::EmbeddedFile> sheer::embedded_<NAME>()`.
# Like a registry it is a separate object, which a program with more folders replaces.
function(sheer_embed target name)
  set(roots ${ARGN})
  list(TRANSFORM roots PREPEND ${CMAKE_SOURCE_DIR}/)
  set(patterns ${roots})
  list(TRANSFORM patterns APPEND /*)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${patterns})
  list(FILTER files EXCLUDE REGEX "\\.(cpp|h)$")
  set(output ${CMAKE_BINARY_DIR}/generated/${target}/embedded_${name}.cpp)
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/embedded_${name}.h CONTENT
"#pragma once
#include \"renderer/core/embedded_file.h\"
namespace sheer {
/// By path below the folder that cmake/embed.cmake was given.
std::span<const EmbeddedFile> embedded_${name}();
}  // namespace sheer
" @ONLY)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DNAME=${name} "-DROOTS=${roots}" "-DFILES=${files}"
            -P ${CMAKE_SOURCE_DIR}/cmake/embed_files.cmake
    DEPENDS ${files} ${CMAKE_SOURCE_DIR}/cmake/embed_files.cmake
    VERBATIM)
  set_source_files_properties(${output} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  target_sources(${target} PRIVATE ${output})
  target_include_directories(${target} PUBLIC ${CMAKE_BINARY_DIR}/generated)
endfunction()
