#include "server/jobs/activity.h"

namespace sheer {

std::string kind_of_stage(const std::string& stage) {
    const std::size_t colon = stage.rfind(": ");
    const std::string what = colon == std::string::npos ? stage : stage.substr(colon + 2);
    return what.substr(0, what.find(' '));
}

}  // namespace sheer
