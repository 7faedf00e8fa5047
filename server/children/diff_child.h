#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "renderer/core/errors.h"
#include "server/process/ask_child.h"

namespace sheer {

/// What changed between two reports, or why they cannot be compared.
struct DiffAnswer {
    std::string json;  ///< a diff::Diff; "" if they cannot be compared
    std::string detail;
    std::vector<FieldError> errors;
    std::vector<std::string> allowable;  ///< pointers that would have to be allowed
    bool too_slow = false;
};

struct DiffQuestion {
    const nlohmann::json& a;  ///< two done reports
    const nlohmann::json& b;
    std::optional<std::size_t> run;  ///< only this run, with its FLIP maps as data: URIs
    std::vector<std::string> allow;
};

/// Compares two reports of the archive in `data` in a child that may die, as it decodes their pictures. Throws
/// std::runtime_error if the child dies or has an internal error, std::system_error if it cannot be started.
DiffAnswer run_diff_child(const DiffQuestion& question, const std::filesystem::path& data, const ChildLimits& limits);

}  // namespace sheer
