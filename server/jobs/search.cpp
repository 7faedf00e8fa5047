#include "server/jobs/search.h"

#include <algorithm>
#include <cctype>

namespace sheer {

namespace {

constexpr char separator = '\x1f';

std::string lowered_ascii(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return text;
}

bool is_of_word(char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 0x80 || (byte >= '0' && byte <= '9') || (byte >= 'a' && byte <= 'z') || (byte >= 'A' && byte <= 'Z');
}

std::string facet(const std::string& kind, const std::string& value) {
    return kind + separator + value;
}

void add_once(std::vector<std::string>& texts, const std::vector<std::string>& more) {
    for (const std::string& text : more)
        if (std::ranges::find(texts, text) == texts.end()) texts.push_back(text);
}

/// "name" or "name:value".
std::string tag_facet(const std::string& tag) {
    const std::size_t colon = tag.find(':');
    if (colon == std::string::npos) return facet("tag", tag);
    return facet("tag", tag.substr(0, colon)) + separator + tag.substr(colon + 1);
}

}  // namespace

std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t end = at;
        while (end < text.size() && is_of_word(text[end])) ++end;
        if (end > at) add_once(words, {lowered_ascii(std::string(text.substr(at, end - at)))});
        at = std::max(end, at + 1);
    }
    return words;
}

std::vector<std::string> search_words(const Facets& facets) {
    std::vector<std::string> words = words_of(facets.title);
    for (const auto& [name, value] : facets.tags.items()) add_once(words, words_of(value.get<std::string>()));
    return words;
}

std::vector<std::string> facet_texts(const Facets& facets, const std::string& spec_sha256) {
    std::vector<std::string> texts = {facet("scene", facets.scene), facet("spec", spec_sha256)};
    for (const std::string& method : facets.methods) add_once(texts, {facet("method", lowered_ascii(method))});
    for (const auto& [name, value] : facets.tags.items())
        add_once(texts, {facet("tag", name), facet("tag", name) + separator + value.get<std::string>()});
    return texts;
}

std::vector<std::string> outcome_facet_texts(const std::string& verdict, const std::string& device) {
    std::vector<std::string> texts;
    if (!verdict.empty()) texts.push_back(facet("verdict", verdict));
    if (device.empty()) return texts;
    add_once(texts, {facet("device", lowered_ascii(device))});
    for (const std::string& word : words_of(device)) add_once(texts, {facet("device", word)});
    return texts;
}

std::string status_facet_text(Status status) {
    return facet("status", std::string(status_text(status)));
}

std::vector<std::string> wanted_facet_texts(const ListFilter& filter) {
    std::vector<std::string> texts;
    if (filter.status) texts.push_back(status_facet_text(*filter.status));
    if (!filter.scene.empty()) texts.push_back(facet("scene", filter.scene));
    if (!filter.verdict.empty()) texts.push_back(facet("verdict", filter.verdict));
    if (!filter.device.empty()) texts.push_back(facet("device", lowered_ascii(filter.device)));
    if (!filter.spec_sha256.empty()) texts.push_back(facet("spec", filter.spec_sha256));
    for (const std::string& method : filter.methods) add_once(texts, {facet("method", lowered_ascii(method))});
    for (const std::string& tag : filter.tags) add_once(texts, {tag_facet(tag)});
    return texts;
}

}  // namespace sheer
