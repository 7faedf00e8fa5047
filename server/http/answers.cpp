#include "server/http/answers.h"

#include "renderer/results/schemas.h"

namespace sheer {

using nlohmann::json;
namespace answer = http::answer;

namespace {

json tags_schema(SchemaBook& book) {
    return schema_in<std::map<std::string, std::string>>(book);
}

json verdict_schema(SchemaBook& book) {
    return schema_in<std::optional<report::ReportVerdict>>(book);
}

json preview_schema(SchemaBook& book) {
    return schema_in<std::optional<report::Picture>>(book);
}

}  // namespace

template <>
const Description<answer::FieldError>& description_of() {
    using answer::FieldError;
    static const auto description =
        Description<FieldError>("FieldError", "what is wrong with a field")
            .member(&FieldError::pointer, "pointer",
                    "JSON pointer into the body, or / and the name of a field of the query")
            .member(&FieldError::detail, "detail", "what is wrong, to be read after the name of the field");
    return description;
}

template <>
const Description<answer::Problem>& description_of() {
    using answer::Problem;
    static const auto description =
        Description<Problem>("Problem", "an error as problem+json (RFC 9457)")
            .member(&Problem::type, "type", "about:blank")
            .member(&Problem::title, "title", "name of the status, such as Not Found")
            .member(&Problem::status, "status", "HTTP status of the answer")
            .member(&Problem::detail, "detail", "a sentence")
            .maybe(&Problem::errors, "errors", "the wrong fields, at most the first 100")
            .maybe(&Problem::error_count, "error_count", "number of all wrong fields, including those not listed")
            .maybe(&Problem::allow, "allow",
                   "of a diff: what to allow so that the reports can be compared nevertheless");
    return description;
}

template <>
const Description<answer::Health>& description_of() {
    using answer::Health;
    static const auto description =
        Description<Health>("Health", "the service is alive").member(&Health::status, "status", "ok");
    return description;
}

template <>
const Description<answer::Readiness>& description_of() {
    using answer::Readiness;
    static const auto description = Description<Readiness>("Readiness", "the service renders")
                                        .member(&Readiness::status, "status", "ready")
                                        .member(&Readiness::last_rendered_at, "last_rendered_at", "UTC, RFC 3339")
                                        .member(&Readiness::without_sandbox, "without_sandbox",
                                                "why what others send is not read in a sandbox; empty if it is");
    return description;
}

template <>
const Description<answer::Event>& description_of() {
    using answer::Event;
    static const auto description =
        Description<Event>("ReportEvent", "the data of an event: the current state of a report")
            .member(&Event::id, "id", "")
            .member(&Event::status, "status", "")
            .member(&Event::progress, "progress", "fraction that is done, 0..1")
            .member(&Event::error, "error", "null unless the report failed or was cancelled")
            .member(&Event::stage, "stage", "the current stage of the renderer")
            .maybe(&Event::devices, "devices", "absent unless the spec lists several, and of a report that has ended");
    return description;
}

template <>
const Description<answer::ReportLine>& description_of() {
    using answer::ReportLine;
    static const auto description =
        Description<ReportLine>("ReportLine", "a report in the list")
            .member(&ReportLine::id, "id", "")
            .member(&ReportLine::url, "url", "path of the report")
            .member(&ReportLine::status, "status", "")
            .member(&ReportLine::progress, "progress", "fraction that is done, 0..1")
            .member(&ReportLine::error, "error", "null unless the report failed or was cancelled")
            .member(&ReportLine::created_at, "created_at", "UTC, RFC 3339")
            .text_or_null(&ReportLine::finished_at, "finished_at", "UTC, RFC 3339; null until it is finished")
            .member(&ReportLine::title, "title", "")
            .json(&ReportLine::tags, "tags", "texts by name", tags_schema)
            .member(&ReportLine::scene, "scene", "type of the scene")
            .member(&ReportLine::methods, "methods", "ids, in the order of the spec, each once")
            .member(&ReportLine::spec_sha256, "spec_sha256",
                    "SHA-256 of the spec with defaults filled in, keys sorted, no spaces")
            .json(&ReportLine::verdict, "verdict", "null until it is done", verdict_schema)
            .json(&ReportLine::preview, "preview", "a picture that represents it; null until it is done",
                  preview_schema)
            .text_or_null(&ReportLine::device, "device", "the renderer; null until it is done")
            .member(&ReportLine::pinned, "pinned", "whether it is neither deleted nor pruned")
            .maybe(&ReportLine::broken, "broken", "what can no longer be read; absent if everything can");
    return description;
}

template <>
const Description<answer::ReportList>& description_of() {
    using answer::ReportList;
    static const auto description =
        Description<ReportList>("ReportList", "a page of the archive")
            .member(&ReportList::reports, "reports", "newest first")
            .text_or_null(&ReportList::next_cursor, "next_cursor", "`cursor` of the next page; null on the last one")
            .member(&ReportList::count, "count", "how many reports match on all pages together")
            .member(&ReportList::count_is_exact, "count_is_exact", "false: more than `count` match");
    return description;
}

template <>
const Description<answer::AssetFacts>& description_of() {
    using answer::AssetFacts;
    static const auto description =
        Description<AssetFacts>("AssetFacts", "the findings of the check of an uploaded file")
            .maybe(&AssetFacts::width, "width", "of a picture, in pixels")
            .maybe(&AssetFacts::height, "height", "of a picture, in pixels")
            .maybe(&AssetFacts::channels, "channels", "of a picture")
            .maybe(&AssetFacts::triangles, "triangles", "of a model")
            .maybe(&AssetFacts::materials, "materials", "of a model")
            .maybe(&AssetFacts::pictures, "pictures", "of a model")
            .maybe(&AssetFacts::size, "size", "of a volume: voxels along each axis")
            .maybe(&AssetFacts::spacing, "spacing", "of a volume: distance between voxels along each axis")
            .maybe(&AssetFacts::voxel, "voxel", "of a volume: type of its voxels")
            .maybe(&AssetFacts::encoding, "encoding", "of a volume: how the voxels are encoded")
            .maybe(&AssetFacts::range, "range", "of a volume: least and greatest value")
            .maybe(&AssetFacts::notes, "notes", "parts of the file that are ignored or not read as intended");
    return description;
}

template <>
const Description<answer::Asset>& description_of() {
    using answer::Asset;
    static const auto description =
        Description<Asset>("Asset", "an uploaded file and the findings of its check")
            .with(description_of<answer::AssetFacts>())
            .member(&Asset::sha256, "sha256", "SHA-256 of its bytes, by which specs refer to it")
            .member(&Asset::type, "type", "texture, model or volume")
            .member(&Asset::media_type, "media_type", "")
            .member(&Asset::name, "name", "the name given by its sender; may be empty")
            .member(&Asset::bytes, "bytes", "its length")
            .member(&Asset::created_at, "created_at", "UTC, RFC 3339")
            .member(&Asset::url, "url", "path of its bytes")
            .maybe(&Asset::broken, "broken", "what is missing now; absent if everything is there");
    return description;
}

template <>
const Description<answer::AssetKind>& description_of() {
    using answer::AssetKind;
    static const auto description = Description<AssetKind>("AssetKind", "a kind of file that can be uploaded")
                                        .member(&AssetKind::media_type, "media_type", "Content-Type of the upload")
                                        .member(&AssetKind::type, "type", "texture, model or volume")
                                        .member(&AssetKind::suffixes, "suffixes", "file name suffixes, with the dot");
    return description;
}

template <>
const Description<answer::AssetList>& description_of() {
    using answer::AssetList;
    static const auto description =
        Description<AssetList>("AssetList", "the uploaded files, and the kinds that are accepted")
            .member(&AssetList::assets, "assets", "newest first")
            .member(&AssetList::accepts, "accepts", "")
            .member(&AssetList::max_bytes, "max_bytes", "limit for an upload");
    return description;
}

template <>
const Description<answer::AcceptedReport>& description_of() {
    using answer::AcceptedReport;
    static const auto description =
        Description<AcceptedReport>("AcceptedReport", "a report that others may be compared with")
            .member(&AcceptedReport::report, "report", "its id")
            .member(&AcceptedReport::url, "url", "path of the report")
            .member(&AcceptedReport::title, "title", "of its spec")
            .member(&AcceptedReport::spec_sha256, "spec_sha256", "of its spec; \"\" if the report cannot be read")
            .member(&AcceptedReport::device, "device", "renderer and processor; only reports of the same are compared")
            .member(&AcceptedReport::accepted_at, "accepted_at", "UTC, RFC 3339")
            .member(&AcceptedReport::by, "by", "who accepted it; may be empty")
            .member(&AcceptedReport::reason, "reason", "why; may be empty");
    return description;
}

template <>
const Description<answer::EarlyPicture>& description_of() {
    using answer::EarlyPicture;
    static const auto description =
        Description<EarlyPicture>("EarlyPicture", "a picture of a report that is not done")
            .member(&EarlyPicture::label, "label", "of its method, or Reference")
            .member(&EarlyPicture::url, "url", "path of the picture; it is gone when the report has ended");
    return description;
}

template <>
const Description<answer::EarlyPictures>& description_of() {
    using answer::EarlyPictures;
    static const auto description =
        Description<EarlyPictures>("EarlyPictures", "the pictures of a report that is being timed")
            .json(&EarlyPictures::point, "point", "the point of the sweep; {} without one", point_schema)
            .member(&EarlyPictures::pictures, "pictures", "the reference first; empty if there are none");
    return description;
}

template <>
const Description<answer::Pin>& description_of() {
    using answer::Pin;
    static const auto description = Description<Pin>("Pin", "a report that is neither deleted nor pruned")
                                        .member(&Pin::report, "report", "its id")
                                        .member(&Pin::url, "url", "path of the report")
                                        .member(&Pin::pinned_at, "pinned_at", "UTC, RFC 3339")
                                        .member(&Pin::by, "by", "who pinned it; may be empty")
                                        .member(&Pin::reason, "reason", "why; may be empty");
    return description;
}

template <>
const Description<answer::QuotaLine>& description_of() {
    using answer::QuotaLine;
    static const auto description =
        Description<QuotaLine>("QuotaLine", "what the holder of a token may take up")
            .member(&QuotaLine::name, "name", "jobs, seconds or upload_bytes")
            .member(&QuotaLine::what, "what", "what is counted; a day is this hour and the 23 before it")
            .member(&QuotaLine::limit, "limit", "the greatest number")
            .member(&QuotaLine::used, "used", "the number now");
    return description;
}

template <>
const Description<answer::Session>& description_of() {
    using answer::Session;
    static const auto description =
        Description<Session>("Session", "who asks")
            .member(&Session::required, "required", "whether the service asks for a token")
            .member(&Session::name, "name", "of the token that this request brings; null for none")
            .member(&Session::scope, "scope", "what it allows: read, submit or admin; null for nothing")
            .member(&Session::quotas, "quotas", "its limits, if it has some");
    return description;
}

template <>
const Description<answer::Worker>& description_of() {
    using answer::Worker;
    static const auto description =
        Description<Worker>("Worker", "a process that renders reports, on this machine or another one")
            .member(&Worker::name, "name", "unique")
            .member(&Worker::label, "label", "specs ask for it by their `device`")
            .member(&Worker::driver, "driver", "the renderer of its device; empty until it has rendered something")
            .member(&Worker::last_seen_at, "last_seen_at", "its last sign of life, UTC, RFC 3339")
            .text_or_null(&Worker::report, "report", "id of the report that it renders; null for none");
    return description;
}

template <>
const Description<answer::WorkerList>& description_of() {
    using answer::WorkerList;
    static const auto description = Description<WorkerList>("WorkerList", "the workers that were seen lately")
                                        .member(&WorkerList::workers, "workers", "by label and name");
    return description;
}

template <>
const Description<answer::Baseline>& description_of() {
    using answer::Baseline;
    static const auto description = Description<Baseline>("Baseline", "a named set of accepted reports")
                                        .member(&Baseline::name, "name", "as in `against`, after baseline:")
                                        .member(&Baseline::url, "url", "path of the baseline")
                                        .member(&Baseline::reports, "reports", "those accepted last first");
    return description;
}

template <>
const Description<answer::BaselineList>& description_of() {
    using answer::BaselineList;
    static const auto description = Description<BaselineList>("BaselineList", "every baseline")
                                        .member(&BaselineList::baselines, "baselines", "by name");
    return description;
}

}  // namespace sheer
