#include <nlohmann/json.hpp>

#include "renderer/core/errors.h"
#include "renderer/files/report_document.h"
#include "tests/fuzz/target.h"

namespace sheer::test {

namespace {

/// A report of another version or machine.
void read_document(std::string_view input) {
    const auto document = nlohmann::json::parse(input, nullptr, false);
    if (document.is_discarded()) return;
    try {
        const report::Report report = read_report(document);
        check_comparable(report);
        for (const report::Run& run : report.runs) picture_size_px(report, run.point);
    } catch (const DocumentError& error) {
        require(*error.what() != '\0', "an error without a message");
    }
}

}  // namespace

FuzzTarget fuzz_report() {
    return {"report", read_document};
}

}  // namespace sheer::test
