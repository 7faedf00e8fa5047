// The self-contained page: the viewer's modules as data: URIs in an import map, the report and its pictures as a JSON
// block that the browser does not execute, and a plain report for browsers that run no scripts. Texts from users are in
// that block, and escaped in <title> and in the plain report.

#include <fmt/format.h>

#include <map>
#include <regex>
#include <stdexcept>

#include "embedded_web.h"
#include "renderer/core/sha256.h"
#include "renderer/files/data_uri.h"
#include "renderer/files/html.h"
#include "renderer/report/report.h"
#include "renderer/results/quantity.h"
#include "renderer/spec/spec.h"

namespace sheer {

using nlohmann::json;

namespace {

constexpr const char* entry_module = "standalone.js";
constexpr const char* style_sheets[] = {"base.css",   "controls.css", "answer.css", "viewer.css",
                                        "report.css", "pixel.css",    "chart.css"};

std::string web_file(std::string_view path) {
    for (const EmbeddedFile& file : embedded_web())
        if (file.path == path) return std::string(file.bytes);
    throw std::logic_error(fmt::format("web/{} is not in this program", path));
}

std::string html_text(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        switch (c) {
            case '&':
                escaped += "&amp;";
                break;
            case '<':
                escaped += "&lt;";
                break;
            case '>':
                escaped += "&gt;";
                break;
            case '"':
                escaped += "&quot;";
                break;
            default:
                escaped += c;
        }
    }
    return escaped;
}

/// JSON for a <script> block: without a <, nothing in it can end the block or open a comment.
std::string script_json(const json& value) {
    std::string escaped;
    for (const char c : value.dump(-1, ' ', true, json::error_handler_t::replace)) {
        if (c == '<') {
            escaped += "\\u003c";
        } else {
            escaped += c;
        }
    }
    return escaped;
}

/// Adds the module and those that it imports, under their names in the import map. A module from a data: URI has no
/// address from which "./x.js" could be resolved, so such imports become "sheer/x.js".
void add_module(const std::string& path, std::map<std::string, std::string>& modules) {
    static const std::regex import_line(R"re((from|import) "\./([\w]+\.js)")re");
    const std::string name = "sheer/" + path;
    if (modules.contains(name)) return;
    const std::string source = web_file(path);
    modules[name] = data_uri("text/javascript", std::regex_replace(source, import_line, "$1 \"sheer/$2\""));
    for (std::sregex_iterator found(source.begin(), source.end(), import_line), end; found != end; ++found)
        add_module((*found)[2], modules);
}

void add_pictures(const report::Pictures& images, const report::PictureReader& read_picture, json& pictures) {
    for (const auto& [name, picture] : images)
        if (!pictures.contains(picture.sha256))
            pictures[picture.sha256] = data_uri(picture.media_type, read_picture(picture));
}

json page_data(const report::Report& report, const report::PictureReader& read_picture) {
    json pictures = json::object();
    for (const report::Run& run : report.runs) {
        add_pictures(run.reference.images, read_picture, pictures);
        for (const report::Result& result : run.results) add_pictures(result.images, read_picture, pictures);
    }
    return {{"report", to_document(report)},
            {"pictures", pictures},
            {"methods", describe_methods()},
            {"metrics", describe_metrics()},
            {"columns", to_document(time_and_fragment_columns())}};
}

/// What is shown while scripts are off: the tables as on the terminal, and the pictures of the first point. `pictures`
/// are data: URIs by SHA-256.
std::string plain_report(const report::Report& report, const json& pictures) {
    std::string text = fmt::format("<h1>{}</h1>\n<div class=\"table-box\"><pre>{}</pre></div>\n",
                                   html_text(report.title()), html_text(report_table(report)));
    const auto add = [&](const std::string& label, const report::Pictures& images) {
        const auto color = images.find("color");
        if (color == images.end()) return;
        text += fmt::format("<figure><img src=\"{}\" alt=\"\"><figcaption>{}</figcaption></figure>\n",
                            pictures.at(color->second.sha256).get<std::string>(), html_text(label));
    };
    if (report.runs.empty()) return text;
    text += "<div class=\"plain-pictures\">\n";
    add("Reference", report.runs.front().reference.images);
    for (const report::Result& result : report.runs.front().results) add(result.label, result.images);
    return text + "</div>\n";
}

constexpr const char* page = R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'nonce-{nonce}'; script-src 'nonce-{nonce}'; base-uri 'none'; form-action 'none'">
<title>{title} – Sheer</title>
<link rel="icon" href="{icon}">
<style nonce="{nonce}">
{styles}</style>
<script nonce="{nonce}">
{theme}</script>
<script type="importmap" nonce="{nonce}">{import_map}</script>
</head>
<body>
<header class="site"><span class="brand"><img src="{icon}" alt="" width="22" height="22">Sheer</span>
<span class="site-space"></span><button type="button" id="theme-toggle" class="quiet"></button></header>
<main id="main"></main>
<noscript>{plain}</noscript>
<script type="application/json" id="sheer-report">{data}</script>
<script type="module" nonce="{nonce}">import "sheer/{entry}";</script>
</body>
</html>
)";

}  // namespace

std::string report_html(const report::Report& report, const report::PictureReader& read_picture) {
    std::map<std::string, std::string> modules;
    add_module(entry_module, modules);
    const json shown = page_data(report, read_picture);
    const std::string data = script_json(shown);
    const std::string title = report.title();
    std::string styles;
    for (const char* sheet : style_sheets) styles += web_file(sheet);
    // Only markup with the nonce may run. The nonce depends on the whole report, times and pictures included, so a user
    // who chose a title could not know it.
    return fmt::format(fmt::runtime(page), fmt::arg("nonce", sha256_hex(data).substr(0, 32)),
                       fmt::arg("title", html_text(title.empty() ? "Report" : title)),
                       fmt::arg("icon", data_uri("image/svg+xml", web_file("icon.svg"))), fmt::arg("styles", styles),
                       fmt::arg("plain", plain_report(report, shown.at("pictures"))),
                       fmt::arg("theme", web_file("theme.js")),
                       fmt::arg("import_map", script_json({{"imports", modules}})), fmt::arg("data", data),
                       fmt::arg("entry", entry_module));
}

}  // namespace sheer
