#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace sheer {

/// Something in an input that is not read or is read differently than intended, or the reason why a comparison is
/// empty.
struct Note {
    std::string code;   ///< for programs: lower-case words joined by dashes, "extension-ignored"
    std::string text;   ///< one sentence for a person, with a full stop
    std::string where;  ///< what it is about: "/scene/model: materials[2]"; "" for the whole

    bool operator==(const Note&) const = default;
};

/// An array of {code, text, where}; `where` is null for the whole.
nlohmann::json to_json(const std::vector<Note>& notes);

/// Appends `note` unless it is there already.
void add_note(std::vector<Note>& notes, Note note);

/// Appends the notes of a file that the field at `pointer` refers to: each `where` then begins with the pointer.
void add_notes_of(std::vector<Note>& notes, const std::vector<Note>& of_file, const std::string& pointer);

}  // namespace sheer
