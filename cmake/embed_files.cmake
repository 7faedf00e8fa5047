# Writes OUTPUT: the bytes of FILES as arrays, and a table of them by path relative to the one of ROOTS that contains them.
set(arrays "")
set(rows "")
set(number 0)
foreach(file ${FILES})
  foreach(root ${ROOTS})
    string(FIND "${file}" "${root}/" found)
    if(found EQUAL 0)
      file(RELATIVE_PATH path ${root} ${file})
    endif()
  endforeach()
  file(READ ${file} bytes HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  string(APPEND arrays "constexpr unsigned char ${NAME}_${number}[] = {${bytes}0};\n")
  string(APPEND rows
         "    {\"${path}\", {reinterpret_cast<const char*>(${NAME}_${number}), sizeof(${NAME}_${number}) - 1}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUTPUT}
"#include \"embedded_${NAME}.h\"

namespace sheer {
namespace {
${arrays}
}  // namespace

std::span<const EmbeddedFile> embedded_${NAME}() {
    static const EmbeddedFile files[] = {
${rows}    };
    return files;
}
}  // namespace sheer
")
