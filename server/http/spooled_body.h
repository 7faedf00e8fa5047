#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace sheer::http {

/// The body of a request on its way, in a file without a name: however many clients send theirs slowly, they take no
/// memory.
class SpooledBody {
  public:
    /// In `folder`, which is made if it is missing. Counts its bytes in `all_bytes`, which must outlive it. Throws
    /// std::system_error.
    SpooledBody(const std::filesystem::path& folder, std::uint64_t& all_bytes);
    ~SpooledBody();
    SpooledBody(const SpooledBody&) = delete;
    SpooledBody& operator=(const SpooledBody&) = delete;

    /// Throws std::system_error.
    void append(std::string_view piece);
    /// All of it. Safe on another thread than the rest. Throws std::system_error.
    std::string text() const;

  private:
    int m_file;
    std::uint64_t m_bytes = 0;
    std::uint64_t& m_all_bytes;
};

}  // namespace sheer::http
