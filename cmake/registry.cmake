# sheer_registry(TARGET NAME TYPE PREFIX FOLDER HEADER): one table of the descriptions that the files of FOLDER end with.
# FOLDER/<id>.cpp must define `TYPE sheer::PREFIX_<id>()`. The table is `std::vector<TYPE> sheer::make_<name>()`, in the
# order of the file names; nothing else lists the files.
function(sheer_registry target name type prefix folder header)
  file(GLOB files CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.cpp)
  list(SORT files)
  string(TOLOWER ${name} lower)
  set(declarations "")
  set(calls "")
  foreach(file ${files})
    get_filename_component(id ${file} NAME_WE)
    string(APPEND declarations "${type} ${prefix}_${id}();\n")
    string(APPEND calls "    all.push_back(${prefix}_${id}());\n")
  endforeach()
  set(output ${CMAKE_BINARY_DIR}/generated/registry_${lower}.cpp)
  file(CONFIGURE OUTPUT ${output} CONTENT
"#include \"${header}\"

namespace sheer {
${declarations}
std::vector<${type}> make_${lower}() {
    std::vector<${type}> all;
${calls}    return all;
}
}  // namespace sheer
" @ONLY)
  target_sources(${target} PRIVATE ${output})
endfunction()
