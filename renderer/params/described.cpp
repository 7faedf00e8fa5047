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

void MemberList::add(std::string_view name, std::string_view text, std::size_t offset_bytes, const AnyCodec& codec,
                     bool (*absent)(const void* member)) {
    m_members.push_back({std::string(name), std::string(text), offset_bytes, codec, absent, codec.schema});
}

void MemberList::add(std::string_view name, std::string_view text, std::size_t offset_bytes,
                     const std::function<json(SchemaBook&)>& schema) {
    const AnyCodec codec = {[](const void* from) { return *static_cast<const json*>(from); },
                            [](const json& from, void* to) { *static_cast<json*>(to) = from; }, nullptr};
    m_members.push_back({std::string(name), std::string(text), offset_bytes, codec, nullptr, schema});
}

void MemberList::add(const MemberList& base, std::size_t offset_bytes) {
    for (Member member : base.m_members) {
        member.offset_bytes += offset_bytes;
        m_members.push_back(std::move(member));
    }
}

json MemberList::write(const void* object) const {
    json to = json::object();
    for (const Member& member : m_members) {
        const void* from = static_cast<const char*>(object) + member.offset_bytes;
        if (!member.absent || !member.absent(from)) to[member.name] = member.codec.write(from);
    }
    return to;
}

void MemberList::read(const json& from, void* object) const {
    if (!from.is_object()) throw_wrong_type("an object", from);
    for (const Member& member : m_members)
        if (const auto found = from.find(member.name); found != from.end())
            read_below(member.name,
                       [&] { member.codec.read(*found, static_cast<char*>(object) + member.offset_bytes); });
}

json MemberList::schema(SchemaBook& book, const std::string& text) const {
    json schema = {{"type", "object"},
                   {"description", text},
                   {"properties", json::object()},
                   {"required", json::array()},
                   {"additionalProperties", false}};
    for (const Member& member : m_members) {
        json property = member.schema(book);
        if (!member.text.empty()) property["description"] = member.text;
        schema["properties"][member.name] = std::move(property);
        if (!member.absent) schema["required"].push_back(member.name);
    }
    return schema;
}

}  // namespace detail

}  // namespace sheer
