#pragma once
#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "renderer/results/report.h"

namespace sheer {

/// A done report that was written earlier, perhaps by an older version of Sheer. Throws DocumentError if the document
/// is not one: a value has the wrong type, or a member that every version wrote, and that comparing needs, is missing.
report::Report read_report(const nlohmann::json& document);

/// Throws DocumentError if the spec of a report lacks what is needed to match reports and their pictures: labels of
/// methods, sizes of pictures.
void check_comparable(const report::Report& report);

/// Width and height in pixels of the pictures at a point of the report's sweep. Throws DocumentError if its spec does
/// not give them.
std::array<int, 2> picture_size_px(const report::Report& report, const report::Point& point);

/// Null if there is none with this name.
const report::Picture* find_picture(const report::Pictures& pictures, const std::string& name);

}  // namespace sheer
