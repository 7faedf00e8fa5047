#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace sheer {

/// A published measurement to repeat, or a measurement of our own, which has no `published`: configs/suites/<id>.json.
/// `published` and `trends` are read by suite_report().
struct Suite {
    std::string id;
    std::string title;
    std::string source;        ///< paper and table, or what it measures
    std::string device;        ///< the device on which the published figures were measured; "" if there are none
    nlohmann::json spec;       ///< not normalised
    nlohmann::json published;  ///< [{at, method, metric, value or range}]
    nlohmann::json trends;     ///< [{text, kind, metric, methods, at, range}]
};

/// In the order of their ids.
const std::vector<Suite>& all_suites();
/// Null if there is none with this id; letter case is ignored.
const Suite* find_suite(const std::string& id);

/// The spec of a suite with width and height of the image, also those of its sweep, multiplied by `scale`, in (0, 1].
/// Textures and the counts of the scene stay the same, and so does overdraw. Throws std::invalid_argument for a scale
/// out of range.
nlohmann::json suite_spec(const Suite& suite, double scale);

/// What `GET /suites` answers: an array of catalog::Suite.
nlohmann::json describe_suites();

}  // namespace sheer
