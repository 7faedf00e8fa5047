# Writes OUTPUT: the bytes of FILES as arrays, and a table of them by path below ROOT.
set(arrays "")
set(rows "")
set(number 0)
foreach(file ${FILES})
  file(RELATIVE_PATH path ${ROOT} ${file})
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
