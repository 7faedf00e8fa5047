#include "renderer/params/described.h"

#include <fmt/format.h>

#include "renderer/params/param.h"

namespace sheer {

using nlohmann::json;

DocumentError DocumentError::below(const std::string& key) const {
    return DocumentError((json::json_pointer() / key).to_string() + what());
}

json SchemaBook::reference(const std::string& name, const std::function<json(SchemaBook&)>& make) {
    if (m_schemas.emplace(name, nullptr).second) m_schemas[name] = make(*this);
    return reference(name);
}

namespace detail {

void throw_wrong_type(const char* wanted, const json& found) {
    constexpr std::size_t max_shown_bytes = 60;
    throw DocumentError(fmt::format(" must be {}, not {}", wanted, shortened_json(found, max_shown_bytes)));
}

void throw_unknown_word(const std::string& word) {
    throw DocumentError(fmt::format(" has the unknown value \"{}\"", word));
}

json or_null(json schema) {
    if (schema.contains("enum")) {
        schema["enum"].push_back(nullptr);
        return schema;
    }
    if (schema.contains("type") && schema["type"].is_string()) {
        schema["type"] = {schema["type"], "null"};
        return schema;
    }
    return {{"anyOf", {schema, {{"type", "null"}}}}};
}

}  // namespace detail

}  // namespace sheer
