#pragma once
#include <string>

namespace sheer {

/// A file that is only in memory, to be a child's standard input.
class MemoryFile {
  public:
    /// Throws std::system_error.
    MemoryFile(const char* name, const std::string& bytes);
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    ~MemoryFile();

    int descriptor() const { return m_descriptor; }

  private:
    int m_descriptor;
};

}  // namespace sheer
