// The self-contained page: the viewer's modules as data: URIs in an import map, the report and its pictures as a JSON
// block that the browser does not run. Texts from users appear in that block and in <title> only.

#include <fmt/format.h>

#include <map>
#include <regex>
#include <stdexcept>

#include "embedded_web.h"
#include "renderer/files/data_uri.h"
#include "renderer/files/html.h"

namespace sheer {

using nlohmann::json;

namespace {

constexpr const char* entry_module = "standalone.js";

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

/// JSON for a <script> block: with no < in it, nothing can end the block or open a comment.
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

/// Adds the module and those that it imports, by the name that the import map gives them. A module from a data: URI has
/// no address to resolve "./x.js" from, so such imports become "sheer/x.js".
void add_module(const std::string& path, std::map<std::string, std::string>& modules) {
    static const std::regex import_line(R"re((from|import) "\./([\w]+\.js)")re");
    const std::string name = "sheer/" + path;
    if (modules.contains(name)) return;
    const std::string source = web_file(path);
    modules[name] = data_uri("text/javascript", std::regex_replace(source, import_line, "$1 \"sheer/$2\""));
    for (std::sregex_iterator found(source.begin(), source.end(), import_line), end; found != end; ++found)
        add_module((*found)[2], modules);
}

void add_pictures(const json& images, const std::function<std::string(const json&)>& read_picture, json& pictures) {
    for (const json& image : images) {
        if (image.value("media_type", "") != "image/png") continue;
        const std::string sha256 = image.at("sha256");
        if (!pictures.contains(sha256)) pictures[sha256] = data_uri("image/png", read_picture(image));
    }
}

json page_data(const json& report, const std::function<std::string(const json&)>& read_picture) {
    json pictures = json::object();
    for (const json& run : report.at("runs")) {
        add_pictures(run.at("reference").at("images"), read_picture, pictures);
        for (const json& result : run.at("results")) add_pictures(result.at("images"), read_picture, pictures);
    }
    return {
        {"report", report}, {"pictures", pictures}, {"methods", describe_methods()}, {"metrics", describe_metrics()}};
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
<noscript><p class="notice error">This report needs JavaScript.</p></noscript>
<script type="application/json" id="sheer-report">{data}</script>
<script type="module" nonce="{nonce}">import "sheer/{entry}";</script>
</body>
</html>
)";

}  // namespace

std::string report_html(const json& report, const std::function<std::string(const json& image)>& read_picture) {
    std::map<std::string, std::string> modules;
    add_module(entry_module, modules);
    const std::string data = script_json(page_data(report, read_picture));
    const std::string title = report.at("spec").value("title", "");
    // Only markup that knows the nonce may run. It hangs on everything in the report, times and pictures included, so
    // whoever chose a title in it could not know it.
    return fmt::format(fmt::runtime(page), fmt::arg("nonce", sha256_hex(data).substr(0, 32)),
                       fmt::arg("title", html_text(title.empty() ? "Report" : title)),
                       fmt::arg("icon", data_uri("image/svg+xml", web_file("icon.svg"))),
                       fmt::arg("styles", web_file("base.css") + web_file("viewer.css") + web_file("report.css") +
                                              web_file("chart.css")),
                       fmt::arg("theme", web_file("theme.js")),
                       fmt::arg("import_map", script_json({{"imports", modules}})), fmt::arg("data", data),
                       fmt::arg("entry", entry_module));
}

}  // namespace sheer
