#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace sheer::cli {

/// What Sheer wrote into a folder, as the manifest that it left there says. Only by this does it know what it may
/// replace: a file whose name is in the manifest and whose bytes are still those that were written.
class Manifest {
  public:
    static constexpr const char* file_name = ".sheer-manifest.json";

    struct Entry {
        std::string name;    ///< relative to the folder, such as images/1-b2f.color.png
        std::string sha256;  ///< of what was written
    };

    Manifest() = default;
    /// `main_file` is what the folder is about, such as report.json; `complete` says whether all of it is there.
    Manifest(std::string main_file, bool complete) : m_main_file(std::move(main_file)), m_complete(complete) {}
    /// That of `folder`; empty if it has none. Throws UsageError for a file of this name that is no manifest.
    static Manifest read(const std::filesystem::path& folder);

    bool is_empty() const { return m_entries.empty(); }
    bool is_complete() const { return m_complete; }
    const std::string& main_file() const { return m_main_file; }
    /// A name may stand there twice, while the files of one report take the places of another one's.
    const std::vector<Entry>& entries() const { return m_entries; }
    void add(Entry entry) { m_entries.push_back(std::move(entry)); }
    std::string text() const;

    /// Whether the file of this name in `folder` is one that was written by Sheer and has not been changed since.
    bool owns(const std::filesystem::path& folder, const std::string& name) const;

  private:
    std::string m_main_file;
    bool m_complete = true;
    std::vector<Entry> m_entries;
};

}  // namespace sheer::cli
