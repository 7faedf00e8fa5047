#include "renderer/params/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "renderer/core/errors.h"
#include "renderer/params/param.h"

namespace sheer {

using nlohmann::json;

namespace {

constexpr std::size_t max_json_depth = 64;

/// Follows the parser through a document and reports every duplicate key of an object.
class KeyWatch : public nlohmann::json_sax<json> {
  public:
    const std::vector<FieldError>& errors() const { return m_errors; }

    bool null() override { return value(); }
    bool boolean(bool) override { return value(); }
    bool number_integer(number_integer_t) override { return value(); }
    bool number_unsigned(number_unsigned_t) override { return value(); }
    bool number_float(number_float_t, const string_t&) override { return value(); }
    bool string(string_t&) override { return value(); }
    bool binary(binary_t&) override { return value(); }
    bool start_object(std::size_t) override { return open(false); }
    bool start_array(std::size_t) override { return open(true); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }

    bool key(string_t& name) override {
        Level& level = m_levels.back();
        level.key = name;
        if (!level.keys.insert(name).second) add_error(m_errors, pointer(), [] { return "is given twice"; });
        return true;
    }

    bool parse_error(std::size_t byte, const std::string&, const json::exception& error) override {
        // 406 is the library's code for a number that is out of the range of a double.
        if (error.id == 406) throw NotJson(fmt::format("a number is out of range at byte {}", byte));
        // The library's text begins with the name of its exception in brackets.
        const std::string message = error.what();
        throw NotJson(message.substr(std::min(message.find("] ") + 2, message.size())));
    }

  private:
    struct Level {
        bool is_array = false;
        std::size_t next_index = 0;
        std::string key;
        std::set<std::string> keys;
    };

    bool value() {
        if (!m_levels.empty() && m_levels.back().is_array) ++m_levels.back().next_index;
        return true;
    }

    bool open(bool is_array) {
        if (m_levels.size() == max_json_depth)
            throw NotJson(fmt::format("it is nested deeper than {} levels", max_json_depth));
        m_levels.push_back({.is_array = is_array, .next_index = 0, .key = {}, .keys = {}});
        return true;
    }

    bool close() {
        m_levels.pop_back();
        return value();
    }

    std::string pointer() const {
        json::json_pointer pointer;
        for (const Level& level : m_levels) {
            if (level.is_array) {
                pointer /= level.next_index;
            } else {
                pointer /= level.key;
            }
        }
        return pointer.to_string();
    }

    std::vector<Level> m_levels;
    std::vector<FieldError> m_errors;
};

}  // namespace

json read_json(const std::string& text) {
    KeyWatch watch;
    json::sax_parse(text, &watch);
    // The library takes a NUL for the end of the text, and a JSON document cannot contain one.
    if (const std::size_t nul = text.find('\0'); nul != std::string::npos)
        throw NotJson(fmt::format("there is a NUL at byte {}", nul + 1));
    if (!watch.errors().empty()) throw SpecError(watch.errors());
    return json::parse(text);
}

std::string json_line(const json& document) {
    return document.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string json_page(const json& document) {
    return document.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace sheer
