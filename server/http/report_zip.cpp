#include "server/http/report_zip.h"

#include <fmt/format.h>

#include <iterator>
#include <map>

#include "renderer/files/html.h"
#include "renderer/report/markdown.h"
#include "renderer/report/report.h"
#include "server/http/report_view.h"
#include "server/http/zip.h"

namespace sheer::http {

namespace {

/// The pictures of a report as files of the ZIP, each once; from now on the report refers to these files.
std::vector<ZipEntry> picture_entries(Store& store, report::Report& report) {
    std::map<std::string, std::string> names;  // by SHA-256
    for (const report::Picture& picture : report.pictures())
        names[picture.sha256] =
            fmt::format("images/{}.{}", picture.sha256, picture.media_type == "image/png" ? "png" : "exr");
    const auto relink = [&](report::Pictures& pictures) {
        for (auto& [key, picture] : pictures) picture.url = names.at(picture.sha256);
    };
    for (report::Run& run : report.runs) {
        relink(run.reference.images);
        for (report::Result& result : run.results) relink(result.images);
    }
    std::vector<ZipEntry> entries;
    for (const auto& [sha256, name] : names) {
        const auto blob = store.blobs().open(sha256);
        if (!blob) throw DamagedData(fmt::format("the picture {} is missing", sha256));
        entries.push_back({name, blob->content});
    }
    return entries;
}

}  // namespace

ContentPtr report_zip(Store& store, const std::string& id) {
    report::Report report = done_report(store, id);
    const auto read_picture = [&store](const report::Picture& picture) { return picture_bytes(store, picture); };
    std::vector<ZipEntry> entries = {{"report.html", content_of(report_html(report, read_picture))},
                                     {"junit.xml", content_of(report_junit(report))},
                                     {"summary.md", content_of(report_markdown(report))}};
    std::ranges::move(picture_entries(store, report), std::back_inserter(entries));
    entries.push_back({"report.json", content_of(to_document(report).dump(2) + "\n")});
    return zip_of(std::move(entries));
}

}  // namespace sheer::http
