# Writes OUTPUT: the names of the functions of LOADER, a header made by glad, that SOURCES call or take the address of,
# as in `gl.Clear(...)`, `m_gl->Clear(...)` and `&Functions::Clear`.
cmake_minimum_required(VERSION 3.25)
file(READ ${LOADER} header)
string(REGEX MATCHALL "PFNGL[A-Z0-9_]+PROC [A-Za-z0-9_]+" functions "${header}")
list(TRANSFORM functions REPLACE ".* " "")

set(members "")
foreach(source ${SOURCES})
  file(READ ${source} text)
  string(REGEX REPLACE "//[^\n]*" "" text "${text}")
  string(REGEX MATCHALL "(\\.|->|::)[A-Z][A-Za-z0-9_]*" found "${text}")
  list(APPEND members ${found})
endforeach()
list(TRANSFORM members REPLACE "^(\\.|->|::)" "")
list(REMOVE_DUPLICATES members)
list(SORT members)

set(names "")
foreach(member ${members})
  if(member IN_LIST functions)
    string(APPEND names "    \"gl${member}\",\n")
  endif()
endforeach()
set(text "#pragma once
namespace sheer::gl {
inline constexpr const char* used_functions[] = {
${names}};
}  // namespace sheer::gl
")
# Written only if it changes, so that not every edit of a source recompiles the files that include it.
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} old)
endif()
if(NOT "${old}" STREQUAL "${text}")
  file(WRITE ${OUTPUT} "${text}")
endif()
