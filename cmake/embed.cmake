# sheer_embed(TARGET NAME FOLDER): the files of FOLDER inside the program, so that it runs from any folder.
# Declared in the generated header embedded_<NAME>.h as
# `std::span<const sheer::EmbeddedFile> sheer::embedded_<NAME>()`.
function(sheer_embed target name folder)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*)
  list(FILTER files EXCLUDE REGEX "\\.(cpp|h)$")
  set(output ${CMAKE_BINARY_DIR}/generated/embedded_${name}.cpp)
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/embedded_${name}.h CONTENT
"#pragma once
#include \"renderer/embedded_file.h\"
namespace sheer {
/// The files of ${folder}/, by path below it.
std::span<const EmbeddedFile> embedded_${name}();
}  // namespace sheer
" @ONLY)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DNAME=${name} -DROOT=${CMAKE_SOURCE_DIR}/${folder}
            "-DFILES=${files}" -P ${CMAKE_SOURCE_DIR}/cmake/embed_files.cmake
    DEPENDS ${files} ${CMAKE_SOURCE_DIR}/cmake/embed_files.cmake
    VERBATIM)
  target_sources(${target} PRIVATE ${output})
  target_include_directories(${target} PUBLIC ${CMAKE_BINARY_DIR}/generated)
endfunction()
