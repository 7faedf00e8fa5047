#include "renderer/report/across_table.h"

#include <fmt/format.h>

#include "renderer/core/number_text.h"
#include "renderer/spec/sweep.h"

namespace sheer {

using report::AcrossDevice, report::Report;

namespace {

std::string method_at(const report::AcrossRow& row) {
    const std::string point = describe_point(row.at);
    return point.empty() ? row.method : row.method + " at " + point;
}

std::string time_text(const AcrossDevice& device) {
    if (!device.median) return "-";
    const std::string median = number_text(*device.median, 3);
    if (!device.ci95) return median;
    return fmt::format("{} [{}, {}]", median, number_text((*device.ci95)[0], 3), number_text((*device.ci95)[1], 3));
}

std::string flip_text(const AcrossDevice& device) {
    return device.flip ? fmt::format("{:.4f}", *device.flip) : "-";
}

}  // namespace

std::vector<TableRow> across_rows(const Report& report) {
    std::vector<TableRow> rows = {{"method"}};
    for (const report::DevicePart& part : report.devices) {
        rows[0].push_back(part.label + " ms [95 %]");
        if (&part != &report.devices.front()) rows[0].push_back("FLIP");
    }
    for (const report::AcrossRow& row : report.across_devices) {
        rows.push_back({method_at(row)});
        for (const AcrossDevice& device : row.devices) {
            rows.back().push_back(time_text(device));
            if (&device != &row.devices.front()) rows.back().push_back(flip_text(device));
        }
    }
    return rows;
}

std::string across_caption(const Report& report) {
    return fmt::format("FLIP: mean error of the picture beside that of {}.\n", report.devices.front().label);
}

std::string across_table(const Report& report) {
    if (report.across_devices.empty()) return "";
    return "\n" + aligned(across_rows(report)) + across_caption(report);
}

}  // namespace sheer
