#pragma once
#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <string>

namespace sheer {

/// A text that is not a JSON document (RFC 8259), or one that is not accepted: malformed, nested deeper than 64 levels,
/// with a number out of range, or with anything after its end.
class NotJson : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Reads a JSON document from outside. Throws NotJson with a reason that can follow "is not JSON: ", and SpecError,
/// with the pointer, if an object has a key twice: parsers differ in which of the two values they use.
nlohmann::json read_json(const std::string& text);

/// A document as text on one line. Bytes that are not UTF-8 become U+FFFD.
std::string json_line(const nlohmann::json& document);
/// The same, indented, for files that people read; ends with a line break.
std::string json_page(const nlohmann::json& document);

}  // namespace sheer
