#include "server/http/openapi_examples.h"

#include <algorithm>
#include <stdexcept>

#include "embedded_api_examples.h"
#include "embedded_specs.h"
#include "renderer/spec/spec.h"

namespace sheer::http {

using nlohmann::json;

std::map<std::string, json> openapi_examples() {
    std::map<std::string, json> examples;
    for (const EmbeddedFile& file : embedded_api_examples()) {
        const std::string name(file.path.substr(0, file.path.find('.')));
        examples[name] = file.path.ends_with(".json") ? json::parse(file.bytes) : json(std::string(file.bytes));
    }
    const auto spec = std::ranges::find(embedded_specs(), std::string_view("quick.json"), &EmbeddedFile::path);
    if (spec == embedded_specs().end()) throw std::logic_error("there is no spec quick.json");
    examples["Spec"] = json::parse(spec->bytes);
    examples["NormalisedSpec"] = json::parse(parse_spec(examples["Spec"]).canonical_text());
    return examples;
}

const std::map<std::string, std::string>& described_headers() {
    static const std::map<std::string, std::string> headers{
        {"Location", "the path of the report or asset"},
        {"Retry-After", "after how many seconds to ask again, from the present speed of the queue"},
        {"ETag", "changes whenever the body does; for If-Match and If-None-Match"},
        {"Preference-Applied", "the wait that was granted, such as wait=60"},
        {"Sheer-Reused", "since when the report is done, if it was reused: UTC, RFC 3339"},
        {"Accept-Ranges", "bytes: parts of it can be asked for"},
        {"Content-Range", "which bytes these are, and of how many"},
        {"Content-Disposition", "a name for the file"},
        {"Accept", "the media types that the body may have"}};
    return headers;
}

}  // namespace sheer::http
