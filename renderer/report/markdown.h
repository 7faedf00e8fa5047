#pragma once
#include <string>

#include "renderer/results/report.h"

namespace sheer {

/// Where a summary finds what it links.
struct MarkdownLinks {
    std::string report;          ///< URL of the report's page; "" for no link
    std::string picture_prefix;  ///< before the URLs of pictures; pictures are left out if `pictures` is not set
    bool pictures = false;
};

/// A summary for people in GitHub's markdown: the verdict, the checks with those that failed first, what would decide
/// the undecided ones, and a row for each method.
std::string report_markdown(const report::Report& report, const MarkdownLinks& links = {});

/// GitHub's workflow commands: an ::error for each check that failed, a ::warning for each that is undecided and each
/// method that failed to render. `file` is the spec's, "" for none.
std::string report_annotations(const report::Report& report, const std::string& file);

}  // namespace sheer
