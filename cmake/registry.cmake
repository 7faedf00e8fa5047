# sheer_registry(TARGET NAME TYPE PREFIX HEADER FOLDER... [NAMESPACE NAMESPACE]): one table of the descriptions at the ends
# of the files of the folders. <id>.cpp must define `TYPE PREFIX_<id>()` in NAMESPACE, sheer by default, whose `id` is
# <id>. The table is `std::vector<TYPE> make_<name>()` there, in the order of the file names; nothing else lists the files.
#
# The table is a separate object. A program that has a table of more folders (tests/CMakeLists.txt) is linked with that
# instead of the library's.
function(sheer_registry target name type prefix header)
  cmake_parse_arguments(PARSE_ARGV 5 arg "" "NAMESPACE" "")
  set(namespace sheer)
  if(arg_NAMESPACE)
    set(namespace ${arg_NAMESPACE})
  endif()
  string(TOLOWER ${name} lower)
  set(declarations "")
  set(calls "")
  foreach(folder ${arg_UNPARSED_ARGUMENTS})
    file(GLOB files CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/${folder}/*.cpp)
    list(SORT files)
    foreach(file ${files})
      get_filename_component(id ${file} NAME_WE)
      file(STRINGS ${CMAKE_SOURCE_DIR}/${file} definition REGEX "${type} ${prefix}_${id}\\(\\)")
      if(NOT definition)
        message(FATAL_ERROR "${file} must define `${type} ${prefix}_${id}()`, named like the file")
      endif()
      string(APPEND declarations "${type} ${prefix}_${id}();\n")
      string(APPEND calls "    all.push_back(described(\"${file}\", \"${id}\", ${prefix}_${id}()));\n")
    endforeach()
  endforeach()
  set(output ${CMAKE_BINARY_DIR}/generated/${target}/registry_${lower}.cpp)
  file(CONFIGURE OUTPUT ${output} CONTENT
"#include \"${header}\"

#include <stdexcept>

namespace ${namespace} {
${declarations}
namespace {

${type} described(const char* file, const char* id, ${type} info) {
    if (info.id != id)
        throw std::logic_error(std::string(file) + \" describes \" + info.id + \": the id must be the name of the file\");
    return info;
}

}  // namespace

std::vector<${type}> make_${lower}() {
    std::vector<${type}> all;
${calls}    return all;
}
}  // namespace ${namespace}
" @ONLY)
  set_source_files_properties(${output} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  target_sources(${target} PRIVATE ${output})
endfunction()
