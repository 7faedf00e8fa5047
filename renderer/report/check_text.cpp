#include "renderer/report/check_text.h"

#include <fmt/format.h>

#include "renderer/core/number_text.h"
#include "renderer/spec/sweep.h"

namespace sheer {

using report::Check;

std::string check_limits(const Check& check) {
    std::string text;
    if (check.min) text += " at least " + full_number_text(*check.min);
    if (check.max) text += " at most " + full_number_text(*check.max);
    return text;
}

std::string check_name(const Check& check) {
    const std::string point = describe_point(check.at);
    return fmt::format("{} of {}{}", check.metric, check.method, point.empty() ? "" : " at " + point);
}

std::string check_value(const Check& check) {
    // PSNR has no value if the pictures are identical, and then passes any minimum.
    if (!check.value) return check.passed ? "infinite, as the pictures are identical" : "not measured";
    std::string text = number_text(*check.value);
    for (const std::optional<double>& limit : {check.min, check.max}) {
        if (!limit) continue;
        const std::string beside = number_text_beside(*check.value, *limit);
        if (beside.size() > text.size()) text = beside;
    }
    return text;
}

}  // namespace sheer
