#pragma once
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace sheer {

/// An object in the JSON of a glTF file, which outlives it. Fields are checked when they are read, so that a file is
/// never refused because of fields that are not read. All functions throw AssetError naming the object and the field.
class GltfObject {
  public:
    /// `what` is its name in errors ("material 2"), `where` in notes ("materials[2]").
    /// Throws AssetError if it is not an object.
    GltfObject(const nlohmann::json& object, std::string what, std::string where);

    const nlohmann::json& fields() const { return *m_object; }
    const std::string& what() const { return m_what; }
    const std::string& where() const { return m_where; }
    /// Whether there is such a field, and it is not null.
    bool has(const char* name) const { return find(name) != nullptr; }

    /// A whole number of at least 0, also if it is written as 1.0.
    std::optional<std::uint64_t> whole_number(const char* name) const;
    std::uint64_t needed_number(const char* name) const;
    double number(const char* name, double otherwise) const;
    bool flag(const char* name) const;
    std::string text(const char* name, const std::string& otherwise = "") const;
    /// `count` numbers, or none if the field is missing.
    std::vector<double> numbers(const char* name, std::size_t count) const;
    /// Whole numbers of at least 0; none if the field is missing.
    std::vector<std::uint64_t> whole_numbers(const char* name) const;

    std::optional<GltfObject> object(const char* name) const;
    std::optional<GltfObject> extension(const char* name) const;
    /// The objects of a list, each called `one` in errors; none if the field is missing.
    std::vector<GltfObject> objects(const char* name, const char* one) const;

    [[noreturn]] void fail(const std::string& why) const;

  private:
    const nlohmann::json* find(const char* name) const;
    const nlohmann::json* find_list(const char* name) const;

    const nlohmann::json* m_object;
    std::string m_what, m_where;
};

}  // namespace sheer
