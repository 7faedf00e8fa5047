#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "server/jobs/facets.h"
#include "server/jobs/report_archive.h"

namespace sheer {

/// The words of a text in lower case, each once: runs of ASCII letters and digits, and of all other characters that are
/// not ASCII.
std::vector<std::string> words_of(std::string_view text);

/// The words by which a report is found: those of its title and of the values of its tags.
std::vector<std::string> search_words(const Facets& facets);

/// What a report has in common with others, as texts: its scene, methods, tags and spec.
std::vector<std::string> facet_texts(const Facets& facets, const std::string& spec_sha256);
/// What is known of it when it is done: its verdict, its device and each word of the device's name.
std::vector<std::string> outcome_facet_texts(const std::string& verdict, const std::string& device);
std::string status_facet_text(Status status);
/// Those that a filter asks for, without its words and times.
std::vector<std::string> wanted_facet_texts(const ListFilter& filter);

}  // namespace sheer
