#include "renderer/report/check_text.h"

#include <fmt/format.h>

#include "renderer/number_text.h"
#include "renderer/spec/sweep.h"

namespace sheer {

using nlohmann::json;

std::string check_outcome(const json& check) {
    // Reports made before checks could stay undecided say only whether they passed.
    return check.value("outcome", check["passed"].get<bool>() ? "passed" : "failed");
}

std::string check_limits(const json& check) {
    std::string text;
    if (!check["min"].is_null()) text += " at least " + full_number_text(check["min"]);
    if (!check["max"].is_null()) text += " at most " + full_number_text(check["max"]);
    return text;
}

std::string check_name(const json& check) {
    const std::string point = describe_point(check["at"]);
    return fmt::format("{} of {}{}{}", check["metric"].get<std::string>(), check["method"].get<std::string>(),
                       check_limits(check), point.empty() ? "" : " at " + point);
}

std::string check_value(const json& check) {
    // PSNR has no value where the pictures are identical, and then passes any minimum.
    if (!check["value"].is_number())
        return check["passed"].get<bool>() ? "infinite, as the pictures are identical" : "not measured";
    const double value = check["value"];
    std::string text = number_text(value);
    for (const char* limit : {"min", "max"}) {
        if (!check[limit].is_number()) continue;
        const std::string beside = number_text_beside(value, check[limit]);
        if (beside.size() > text.size()) text = beside;
    }
    return text;
}

}  // namespace sheer
