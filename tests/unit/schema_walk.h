#pragma once
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "renderer/params/described.h"

namespace sheer {

/// Checks documents against the schema of a type, member by member, and records which of the described members they
/// have.
class SchemaWalk {
  public:
    template <typename T>
    static SchemaWalk of() {
        SchemaWalk walk;
        walk.m_root = schema_in<T>(walk.m_book);
        return walk;
    }

    void check(const nlohmann::json& document) { check(document, m_root, "", ""); }

    /// "Type.member" of all members of described types that no document had.
    std::set<std::string> missing() const {
        std::set<std::string> names;
        for (const auto& [name, schema] : m_book.schemas())
            if (schema.contains("properties"))
                for (const auto& [member, of_member] : schema["properties"].items())
                    if (!m_seen.contains(name + "." + member)) names.insert(name + "." + member);
        return names;
    }

  private:
    void check(const nlohmann::json& value, const nlohmann::json& schema, const std::string& type,
               const std::string& pointer) {
        if (schema.contains("$ref")) {
            const std::string name = schema["$ref"];
            if (m_book.schemas().contains(name)) check(value, m_book.schemas().at(name), name, pointer);
        } else if (schema.contains("anyOf")) {
            // Either a value of the type, or null.
            if (!value.is_null()) check(value, schema["anyOf"][0], type, pointer);
        } else if (schema.contains("properties")) {
            check_members(value, schema, type, pointer);
        } else if (schema.contains("items") && value.is_array()) {
            for (std::size_t i = 0; i < value.size(); ++i)
                check(value[i], schema["items"], type, pointer + "/" + std::to_string(i));
        }
    }

    void check_members(const nlohmann::json& value, const nlohmann::json& schema, const std::string& type,
                       const std::string& pointer) {
        ASSERT_TRUE(value.is_object()) << pointer;
        for (const nlohmann::json& name : schema["required"])
            EXPECT_TRUE(value.contains(name.get<std::string>())) << pointer << "/" << name << " is missing";
        for (const auto& [name, member] : value.items()) {
            ASSERT_TRUE(schema["properties"].contains(name)) << pointer << "/" << name << " is not described";
            m_seen.insert(type + "." + name);
            check(member, schema["properties"][name], "", pointer + "/" + name);
        }
    }

    SchemaBook m_book{""};
    nlohmann::json m_root;
    std::set<std::string> m_seen;
};

}  // namespace sheer
