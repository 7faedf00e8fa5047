#include "tests/render/method_row.h"

#include <algorithm>
#include <stdexcept>

namespace sheer::test {

std::vector<MethodRow> make_method_rows();

const std::vector<MethodRow>& all_method_rows() {
    static const std::vector<MethodRow> rows = make_method_rows();
    return rows;
}

const MethodRow& method_row(const std::string& id) {
    const auto found = std::ranges::find(all_method_rows(), id, &MethodRow::id);
    if (found == all_method_rows().end())
        throw std::out_of_range(id + " has no row: add tests/render/methods/" + id + ".cpp");
    return *found;
}

nlohmann::json method_json(const MethodRow& row, const nlohmann::json& parameters) {
    nlohmann::json method = parameters;
    method["id"] = row.id;
    return method;
}

}  // namespace sheer::test
