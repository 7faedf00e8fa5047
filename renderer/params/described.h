#pragma once
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace sheer {

/// A JSON document is not what its type says. The message begins with the JSON pointer of the value that is wrong.
class DocumentError : public std::runtime_error {
  public:
    explicit DocumentError(const std::string& what) : std::runtime_error(what) {}
    /// The same error, seen from the object or array that holds the value as `key`.
    DocumentError below(const std::string& key) const;
};

/// JSON schemas (draft 2020-12) of named types, which refer to each other by `prefix` and name.
class SchemaBook {
  public:
    explicit SchemaBook(std::string prefix) : m_prefix(std::move(prefix)) {}

    /// A reference to the schema of this name; the caller has to add that schema.
    nlohmann::json reference(const std::string& name) const { return {{"$ref", m_prefix + name}}; }
    /// The same; makes the schema if the book does not have it yet.
    nlohmann::json reference(const std::string& name, const std::function<nlohmann::json(SchemaBook&)>& make);
    const std::map<std::string, nlohmann::json>& schemas() const { return m_schemas; }

  private:
    std::string m_prefix;
    std::map<std::string, nlohmann::json> m_schemas;
};

/// A value, or the reason why there is none. Then the JSON value is null, and `<name>_reason` beside it gives the
/// reason, if there is one.
template <typename T>
struct OrReason {
    std::optional<T> value;
    std::string reason;

    explicit operator bool() const { return value.has_value(); }
    const T& operator*() const { return *value; }
    const T* operator->() const { return &*value; }
};

/// How an enum is written: specialise it with `static constexpr std::pair<E, const char*> all[]`.
template <typename E>
struct Words;

/// The word for an enumerator.
template <typename E>
std::string word_of(E value) {
    for (const auto& [one, word] : Words<E>::all)
        if (one == value) return word;
    throw std::logic_error("an enumerator has no word");
}

template <typename T>
class Description;

/// The members of a struct's JSON object. Each described struct declares its own after its definition:
///
///     template <>
///     const Description<Mine>& description_of();
template <typename T>
const Description<T>& description_of() = delete;

template <typename T>
concept Described = requires {
    description_of<T>();
};

namespace detail {

[[noreturn]] void throw_wrong_type(const char* wanted, const nlohmann::json& found);
[[noreturn]] void throw_unknown_word(const std::string& word);
nlohmann::json or_null(nlohmann::json schema);

/// Reads the value at `key`; errors name the key.
template <typename Read>
void read_below(const std::string& key, const Read& read) {
    try {
        read();
    } catch (const DocumentError& error) {
        throw error.below(key);
    }
}

/// How a type is written, read, and described by a JSON schema.
template <typename T>
struct Codec;

template <>
struct Codec<bool> {
    static nlohmann::json write(bool value) { return value; }
    static void read(const nlohmann::json& from, bool& to) {
        if (!from.is_boolean()) throw_wrong_type("true or false", from);
        to = from.get<bool>();
    }
    static nlohmann::json schema(SchemaBook&) { return {{"type", "boolean"}}; }
};

template <std::integral T>
struct Codec<T> {
    static nlohmann::json write(T value) { return value; }
    static void read(const nlohmann::json& from, T& to) {
        if (!from.is_number_integer()) throw_wrong_type("a whole number", from);
        to = from.get<T>();
    }
    static nlohmann::json schema(SchemaBook&) { return {{"type", "integer"}}; }
};

template <>
struct Codec<double> {
    static nlohmann::json write(double value) { return value; }
    static void read(const nlohmann::json& from, double& to) {
        if (!from.is_number()) throw_wrong_type("a number", from);
        to = from.get<double>();
    }
    static nlohmann::json schema(SchemaBook&) { return {{"type", "number"}}; }
};

template <>
struct Codec<std::string> {
    static nlohmann::json write(const std::string& value) { return value; }
    static void read(const nlohmann::json& from, std::string& to) {
        if (!from.is_string()) throw_wrong_type("a string", from);
        to = from.get<std::string>();
    }
    static nlohmann::json schema(SchemaBook&) { return {{"type", "string"}}; }
};

template <typename T>
struct Codec<std::optional<T>> {
    static nlohmann::json write(const std::optional<T>& value) {
        return value ? Codec<T>::write(*value) : nlohmann::json();
    }
    static void read(const nlohmann::json& from, std::optional<T>& to) {
        to.reset();
        if (!from.is_null()) Codec<T>::read(from, to.emplace());
    }
    static nlohmann::json schema(SchemaBook& book) { return or_null(Codec<T>::schema(book)); }
};

template <typename T>
struct Codec<std::vector<T>> {
    static nlohmann::json write(const std::vector<T>& values) {
        nlohmann::json array = nlohmann::json::array();
        for (const T& value : values) array.push_back(Codec<T>::write(value));
        return array;
    }
    static void read(const nlohmann::json& from, std::vector<T>& to) {
        if (!from.is_array()) throw_wrong_type("an array", from);
        to.clear();
        for (const nlohmann::json& one : from) {
            T value{};
            read_below(std::to_string(to.size()), [&] { Codec<T>::read(one, value); });
            to.push_back(std::move(value));
        }
    }
    static nlohmann::json schema(SchemaBook& book) { return {{"type", "array"}, {"items", Codec<T>::schema(book)}}; }
};

template <typename T, std::size_t count>
struct Codec<std::array<T, count>> {
    static nlohmann::json write(const std::array<T, count>& values) {
        return Codec<std::vector<T>>::write({values.begin(), values.end()});
    }
    static void read(const nlohmann::json& from, std::array<T, count>& to) {
        std::vector<T> values;
        Codec<std::vector<T>>::read(from, values);
        if (values.size() != count) throw_wrong_type(("an array of " + std::to_string(count)).c_str(), from);
        std::copy(values.begin(), values.end(), to.begin());
    }
    static nlohmann::json schema(SchemaBook& book) {
        nlohmann::json schema = Codec<std::vector<T>>::schema(book);
        schema["minItems"] = schema["maxItems"] = count;
        return schema;
    }
};

template <typename T>
struct Codec<std::map<std::string, T>> {
    static nlohmann::json write(const std::map<std::string, T>& values) {
        nlohmann::json object = nlohmann::json::object();
        for (const auto& [key, value] : values) object[key] = Codec<T>::write(value);
        return object;
    }
    static void read(const nlohmann::json& from, std::map<std::string, T>& to) {
        if (!from.is_object()) throw_wrong_type("an object", from);
        to.clear();
        for (const auto& item : from.items())
            read_below(item.key(), [&] { Codec<T>::read(item.value(), to[item.key()]); });
    }
    static nlohmann::json schema(SchemaBook& book) {
        return {{"type", "object"}, {"additionalProperties", Codec<T>::schema(book)}};
    }
};

template <typename E>
requires std::is_enum_v<E>
struct Codec<E> {
    static nlohmann::json write(E value) { return word_of(value); }
    static void read(const nlohmann::json& from, E& to) {
        std::string found;
        Codec<std::string>::read(from, found);
        for (const auto& [one, word] : Words<E>::all)
            if (found == word) {
                to = one;
                return;
            }
        throw_unknown_word(found);
    }
    static nlohmann::json schema(SchemaBook&) {
        nlohmann::json words = nlohmann::json::array();
        for (const auto& [one, word] : Words<E>::all) words.push_back(word);
        return {{"enum", words}};
    }
};

template <Described T>
struct Codec<T> {
    static nlohmann::json write(const T& value) { return description_of<T>().write(value); }
    static void read(const nlohmann::json& from, T& to) { description_of<T>().read(from, to); }
    static nlohmann::json schema(SchemaBook& book) {
        return book.reference(description_of<T>().name(),
                              [](SchemaBook& to) { return description_of<T>().schema(to); });
    }
};

/// Text in which "" stands for null.
struct TextOrNull {
    static nlohmann::json write(const std::string& value) {
        return value.empty() ? nlohmann::json() : nlohmann::json(value);
    }
    static void read(const nlohmann::json& from, std::string& to) {
        to.clear();
        if (!from.is_null()) Codec<std::string>::read(from, to);
    }
    static nlohmann::json schema(SchemaBook&) { return {{"type", {"string", "null"}}}; }
};

/// A value that is there, and never null.
template <typename M>
struct Present {
    static nlohmann::json write(const std::optional<M>& value) { return Codec<M>::write(*value); }
    static void read(const nlohmann::json& from, std::optional<M>& to) { Codec<std::optional<M>>::read(from, to); }
    static nlohmann::json schema(SchemaBook& book) { return Codec<M>::schema(book); }
};

template <typename M>
struct ValueOf {
    static nlohmann::json write(const OrReason<M>& from) { return Codec<std::optional<M>>::write(from.value); }
    static void read(const nlohmann::json& from, OrReason<M>& to) { Codec<std::optional<M>>::read(from, to.value); }
    static nlohmann::json schema(SchemaBook& book) { return Codec<std::optional<M>>::schema(book); }
};

template <typename M>
struct ReasonOf {
    static nlohmann::json write(const OrReason<M>& from) { return from.reason; }
    static void read(const nlohmann::json& from, OrReason<M>& to) { TextOrNull::read(from, to.reason); }
    static nlohmann::json schema(SchemaBook&) { return {{"type", "string"}}; }
};

/// How a member of a struct is written, read, and described, for code that does not know its type.
struct AnyCodec {
    nlohmann::json (*write)(const void* member);
    void (*read)(const nlohmann::json& from, void* member);
    nlohmann::json (*schema)(SchemaBook& book);
};

template <typename M, typename Codec>
constexpr AnyCodec any_codec = {
    [](const void* from) -> nlohmann::json { return Codec::write(*static_cast<const M*>(from)); },
    [](const nlohmann::json& from, void* to) { Codec::read(from, *static_cast<M*>(to)); }, &Codec::schema};

/// The members of a struct, for code that does not know it. Not a template, since one that is made for each member of
/// each struct takes minutes to compile.
class MemberList {
  public:
    /// A member that is `offset_bytes` within the struct, and left out where `absent` says so.
    void add(std::string_view name, std::string_view text, std::size_t offset_bytes, const AnyCodec& codec,
             bool (*absent)(const void* member) = nullptr);
    /// A member that is JSON.
    void add(std::string_view name, std::string_view text, std::size_t offset_bytes,
             const std::function<nlohmann::json(SchemaBook&)>& schema);
    /// The members of a base struct.
    void add(const MemberList& base, std::size_t offset_bytes);

    nlohmann::json write(const void* object) const;
    /// Throws DocumentError.
    void read(const nlohmann::json& from, void* object) const;
    nlohmann::json schema(SchemaBook& book, const std::string& text) const;

  private:
    struct Member {
        std::string name, text;
        std::size_t offset_bytes;
        AnyCodec codec;
        bool (*absent)(const void* member);  ///< null: never
        std::function<nlohmann::json(SchemaBook&)> schema;
    };
    std::vector<Member> m_members;
};

}  // namespace detail

/// The members of a struct `T` in its JSON object: the writer, the reader, the JSON schema and the docs are made from
/// this. When reading, members that the object lacks keep the struct's default, since older programs wrote fewer of
/// them, and unknown members are ignored. The schema describes what this program writes, so it allows neither.
template <typename T>
class Description {
  public:
    /// `name` is the schema's name, `text` says what the object is.
    Description(std::string_view name, std::string_view text) : m_name(name), m_text(text) {}

    /// Always present. An std::optional without a value is null.
    template <typename M, typename Base>
    requires std::derived_from<T, Base> Description& member(M Base::*member, std::string_view name,
                                                            std::string_view text) {
        return add<M, detail::Codec<M>>(offset_of(member), name, text);
    }
    /// Absent if it equals `M{}`: "", 0, [].
    template <typename M>
    Description& maybe(M T::*member, std::string_view name, std::string_view text) {
        return add<M, detail::Codec<M>>(offset_of(member), name, text,
                                        [](const void* of) { return is_nothing(*static_cast<const M*>(of)); });
    }
    /// Absent if there is no value, and never null.
    template <typename M>
    Description& maybe(std::optional<M> T::*member, std::string_view name, std::string_view text) {
        return add<std::optional<M>, detail::Present<M>>(
            offset_of(member), name, text, [](const void* of) { return !*static_cast<const std::optional<M>*>(of); });
    }
    /// "" is null.
    Description& text_or_null(std::string T::*member, std::string_view name, std::string_view text) {
        return add<std::string, detail::TextOrNull>(offset_of(member), name, text);
    }
    /// `<name>` and `<name>_reason`.
    template <typename M>
    Description& member(OrReason<M> T::*member, std::string_view name, std::string_view text) {
        add<OrReason<M>, detail::ValueOf<M>>(offset_of(member), name, text);
        return add<OrReason<M>, detail::ReasonOf<M>>(offset_of(member), std::string(name) + "_reason",
                                                     "why " + std::string(name) + " is null", [](const void* of) {
                                                         const auto& either = *static_cast<const OrReason<M>*>(of);
                                                         return either || either.reason.empty();
                                                     });
    }
    /// Arbitrary JSON; `schema` describes it.
    Description& json(nlohmann::json T::*member, std::string_view name, std::string_view text,
                      const std::function<nlohmann::json(SchemaBook&)>& schema) {
        m_members.add(name, text, offset_of(member), schema);
        return *this;
    }
    /// All members of a base struct of `T`.
    template <typename Base>
    requires std::derived_from<T, Base> Description& with(const Description<Base>& base) {
        m_members.add(base.m_members, bytes_between(&m_sample, static_cast<const Base*>(&m_sample)));
        return *this;
    }

    const std::string& name() const { return m_name; }

    nlohmann::json write(const T& value) const { return m_members.write(&value); }
    /// Throws DocumentError.
    void read(const nlohmann::json& from, T& to) const { m_members.read(from, &to); }
    nlohmann::json schema(SchemaBook& book) const { return m_members.schema(book, m_text); }

  private:
    template <typename Other>
    friend class Description;

    /// Items of a list need not be comparable.
    template <typename M>
    static bool is_nothing(const M& value) {
        if constexpr (requires { value.empty(); })
            return value.empty();
        else
            return value == M{};
    }

    static std::size_t bytes_between(const void* begin, const void* end) {
        return static_cast<std::size_t>(static_cast<const char*>(end) - static_cast<const char*>(begin));
    }
    template <typename M, typename Base>
    std::size_t offset_of(M Base::*member) const {
        return bytes_between(&m_sample, &(m_sample.*member));
    }
    template <typename M, typename Codec>
    Description& add(std::size_t offset_bytes, std::string_view name, std::string_view text,
                     bool (*absent)(const void*) = nullptr) {
        m_members.add(name, text, offset_bytes, detail::any_codec<M, Codec>, absent);
        return *this;
    }

    std::string m_name, m_text;
    T m_sample{};  ///< shows where the members are in a `T`
    detail::MemberList m_members;
};

template <typename T>
nlohmann::json to_document(const T& value) {
    return detail::Codec<T>::write(value);
}

/// Throws DocumentError.
template <typename T>
T from_document(const nlohmann::json& document) {
    T value{};
    detail::Codec<T>::read(document, value);
    return value;
}

/// Adds the schemas of `T` and of everything in it to `book`; returns a reference to the schema of `T`.
template <typename T>
nlohmann::json schema_in(SchemaBook& book) {
    return detail::Codec<T>::schema(book);
}

}  // namespace sheer
