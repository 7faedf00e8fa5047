#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace sheer::cli {

/// The list of files that Sheer wrote into a folder, stored there. It determines what Sheer may replace: only a file
/// whose name is in the manifest and whose bytes have not changed.
class Manifest {
  public:
    static constexpr const char* file_name = ".sheer-manifest.json";

    struct Entry {
        std::string name;    ///< relative to the folder, such as images/1-b2f.color.png
        std::string sha256;  ///< of the written bytes
    };

    Manifest() = default;
    /// `main_file` is the folder's main file, such as report.json; `complete` says whether the output is complete.
    Manifest(std::string main_file, bool complete) : m_main_file(std::move(main_file)), m_complete(complete) {}
    /// The manifest of `folder`; empty if it has none. Throws UsageError if the file with this name is not a manifest.
    static Manifest read(const std::filesystem::path& folder);

    bool is_empty() const { return m_entries.empty(); }
    bool is_complete() const { return m_complete; }
    const std::string& main_file() const { return m_main_file; }
    /// A name may occur twice, while the files of one report replace those of another one.
    const std::vector<Entry>& entries() const { return m_entries; }
    void add(Entry entry) { m_entries.push_back(std::move(entry)); }
    std::string text() const;

    /// Whether Sheer wrote the file with this name in `folder` and it has not been changed since.
    bool owns(const std::filesystem::path& folder, const std::string& name) const;

  private:
    std::string m_main_file;
    bool m_complete = true;
    std::vector<Entry> m_entries;
};

}  // namespace sheer::cli
