#pragma once
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace sheer {

/// A text that is no JSON document (RFC 8259), or none that is read: broken, nested deeper than 64 levels, with a
/// number out of range, or with anything after its end.
class NotJson : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Reads a JSON document that somebody else wrote. Throws NotJson with a reason that can follow "is not JSON: ", and
/// SpecError for objects that have a key twice, at its pointer: readers differ in which of the two values they take.
nlohmann::json read_json(const std::string& text);

}  // namespace sheer
