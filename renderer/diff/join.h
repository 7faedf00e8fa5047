#pragma once
#include <optional>
#include <string>
#include <vector>

#include "renderer/results/report.h"

namespace sheer {

/// What one of several devices rendered, or why it did not.
struct RenderedPart {
    std::string label;
    std::optional<report::Report> report;  ///< of spec_of_device()
    std::string reason;                    ///< without a report
};

/// One report of the parts of a spec that lists several devices, with a run for each device and point, and with the
/// pictures of each device compared with those of the first one. The runs of a device that failed hold the reason.
/// `spec` is normalised, and `parts` are in the order of its labels, at least one with a report. Throws what
/// `read_picture` throws, and SpecError if the spec is none.
report::Report join_parts(const nlohmann::json& spec, const std::vector<RenderedPart>& parts,
                          const report::PictureReader& read_picture);

}  // namespace sheer
