#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace sheer {

/// A published measurement to repeat: configs/suites/<id>.json. `published` and `trends` are read by suite_report().
struct Suite {
    std::string id;
    std::string title;
    std::string source;        ///< paper and table
    std::string device;        ///< what the published figures were measured on
    nlohmann::json spec;       ///< not normalised
    nlohmann::json published;  ///< [{at, method, metric, value or range}]
    nlohmann::json trends;     ///< [{text, kind, metric, methods, at, range}]
};

/// In the order of their ids.
const std::vector<Suite>& all_suites();
/// Null if there is none of this id; letter case is passed over.
const Suite* find_suite(const std::string& id);

/// The spec of a suite with width and height of the image times `scale`, in (0, 1]: textures and the counts of the
/// scene stay, so overdraw does too. Throws std::invalid_argument for a scale out of range.
nlohmann::json suite_spec(const Suite& suite, double scale);

/// What `GET /suites` answers: id, title, source, device, spec, and how many figures and trends there are.
nlohmann::json describe_suites();

}  // namespace sheer
