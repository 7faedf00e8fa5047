#include "renderer/core/notes.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace sheer {

using nlohmann::json;

json to_json(const std::vector<Note>& notes) {
    json array = json::array();
    for (const Note& note : notes)
        array.push_back(
            {{"code", note.code}, {"text", note.text}, {"where", note.where.empty() ? json() : json(note.where)}});
    return array;
}

void add_note(std::vector<Note>& notes, Note note) {
    if (std::ranges::find(notes, note) == notes.end()) notes.push_back(std::move(note));
}

void add_notes_of(std::vector<Note>& notes, const std::vector<Note>& of_file, const std::string& pointer) {
    for (Note note : of_file) {
        note.where = note.where.empty() ? pointer : pointer + ": " + note.where;
        add_note(notes, std::move(note));
    }
}

}  // namespace sheer
