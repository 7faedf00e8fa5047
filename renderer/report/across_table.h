#pragma once
#include <string>
#include <vector>

#include "renderer/report/text_table.h"
#include "renderer/results/report.h"

namespace sheer {

/// Of a report of several devices: a row for each method and point, after a heading, with columns for each device. The
/// first one has no column for its difference from itself.
std::vector<TableRow> across_rows(const report::Report& report);
/// What they mean.
std::string across_caption(const report::Report& report);
/// Both for the terminal; "" for a report of one device.
std::string across_table(const report::Report& report);

}  // namespace sheer
