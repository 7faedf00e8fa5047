#pragma once
#include <string>

#include "renderer/results/report.h"

namespace sheer {

/// A self-contained HTML file.
std::string report_html(const report::Report& report, const report::PictureReader& read_picture);

}  // namespace sheer
