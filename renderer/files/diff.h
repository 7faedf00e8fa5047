#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "renderer/files/blob_sink.h"
#include "renderer/report/report.h"

namespace sheer {

/// One of two reports that are held against each other.
struct DiffSide {
    const nlohmann::json& report;
    /// The bytes of a picture by its image object; throws std::exception if they cannot be had.
    std::function<std::string(const nlohmann::json& image)> read_picture;
};

struct DiffOptions {
    BlobSink* pictures = nullptr;    ///< takes the FLIP maps; null: there are none
    std::optional<std::size_t> run;  ///< only this one of the runs that both have, from 0
    /// Pixels of pictures that are decoded; those beyond are "not examined".
    std::uint64_t max_pixels = std::numeric_limits<std::uint64_t>::max();
};

/// What changed from report `a` to report `b` of one spec, in pictures and in time; docs/measuring.md says how times
/// are judged, docs/service.md what the fields are. Runs are matched by their points, methods by their labels.
/// Throws SpecError that names every field by JSON pointer where a report is not done or the two specs describe
/// different pictures, and if there is no such run; nlohmann's exceptions if one is no report.
nlohmann::json diff_reports(const DiffSide& a, const DiffSide& b, const DiffOptions& options = {});

/// Whether something got worse: a picture or a status that changed, or a method that is slower.
bool is_worse(const nlohmann::json& diff);

/// A table for the terminal: a line a method.
std::string diff_table(const nlohmann::json& diff);

}  // namespace sheer
