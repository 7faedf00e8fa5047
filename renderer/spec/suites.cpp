#include "renderer/spec/suites.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "embedded_suites.h"
#include "renderer/core/names.h"

namespace sheer {

using nlohmann::json;

namespace {

std::vector<Suite> load_suites() {
    std::vector<Suite> suites;
    for (const EmbeddedFile& file : embedded_suites()) {
        const json document = json::parse(file.bytes);
        suites.push_back({document.at("id"), document.at("title"), document.at("source"), document.at("device"),
                          document.at("spec"), document.at("published"), document.at("trends")});
    }
    std::ranges::sort(suites, {}, &Suite::id);
    return suites;
}

}  // namespace

const std::vector<Suite>& all_suites() {
    static const std::vector<Suite> suites = load_suites();
    return suites;
}

const Suite* find_suite(const std::string& id) {
    return find_by_id(all_suites(), id);
}

json suite_spec(const Suite& suite, double scale) {
    if (!(scale > 0 && scale <= 1)) throw std::invalid_argument("a scale must be over 0 and at most 1");
    json spec = suite.spec, none = json::array();
    const auto shrink = [&](json& side_px) { side_px = std::max(1.0, std::round(side_px.get<double>() * scale)); };
    for (const char* side : {"width", "height"}) {
        shrink(spec["image"][side]);
        const std::string pointer = std::string("/image/") + side;
        for (json& axis : spec["sweep"])
            for (json& point : axis.value("points", json::array()).empty() ? none : axis["points"])
                if (point.contains(pointer)) shrink(point[pointer]);
    }
    return spec;
}

}  // namespace sheer
