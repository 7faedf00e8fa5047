#include <fmt/format.h>
#include <fmt/ranges.h>

#include <atomic>
#include <memory>

#include "renderer/core/sha256.h"
#include "renderer/scene/asset_kinds.h"
#include "server/http/answers.h"
#include "server/http/paths.h"
#include "server/http/problem.h"
#include "server/http/quota.h"
#include "server/http/service.h"
#include "server/http/slot.h"
#include "server/http/text.h"

namespace sheer::http {

namespace {

constexpr std::size_t max_name_bytes = 200;

answer::Asset written(const Asset& asset) {
    answer::Asset body;
    try {
        static_cast<answer::AssetFacts&>(body) = from_document<answer::AssetFacts>(asset.facts);
    } catch (const DocumentError& wrong) {
        body.broken = fmt::format("its description cannot be read: {}", wrong.what());
    }
    if (!asset.broken.empty()) body.broken = asset.broken;
    body.sha256 = asset.sha256;
    body.type = asset.type;
    body.media_type = asset.media_type;
    body.name = asset.name;
    body.bytes = asset.size_bytes;
    body.created_at = utc_text(asset.created_ms);
    body.url = fmt::format("{}/{}", assets_path, asset.sha256);
    return body;
}

Response asset_response(int status, const Asset& asset) {
    Response response = json_response(status, to_document(written(asset)));
    response.headers.add("Location", fmt::format("{}/{}", assets_path, asset.sha256));
    return response;
}

Response known_asset(const Asset& asset, const std::string& media_type) {
    if (asset.media_type != media_type)
        throw Problem(409, fmt::format("The same bytes have already been uploaded as {}.", asset.media_type));
    return asset_response(200, asset);
}

Answer post_asset(Service& service, std::atomic<int>& checks, const Request& request) {
    const std::string media_type = media_type_of(request.headers.find("Content-Type").value_or(""));
    const AssetKind& kind = *find_asset_kind(media_type);
    require_sandbox(service, "An upload");
    Asset asset{.sha256 = sha256_hex(request.body),
                .type = kind.type,
                .media_type = media_type,
                .name = request.query["name"],
                .size_bytes = static_cast<std::int64_t>(request.body.size())};
    if (const auto known = service.store.assets().find(asset.sha256)) {
        // Its bytes may have been damaged in the meantime.
        if (known->media_type == media_type) service.store.assets().add(*known, request.body);
        return known_asset(*known, media_type);
    }
    const auto token = service.access.token_of(request);
    if (token) require_upload_quota(service, *token, asset.size_bytes);
    UploadVerdict verdict;
    {
        const Slot slot(checks, service.limits.max_checks, "Other uploads are being read; try again later.");
        verdict = service.check_upload(request.body, media_type);
    }
    if (token && token->quota.upload_bytes) service.store.usage().add_upload(token->name, asset.size_bytes);
    if (!verdict.refusal.empty())
        throw Problem(422, fmt::format("The file is not accepted as {}: {}{}", media_type, verdict.refusal,
                                       verdict.refusal.ends_with('.') ? "" : "."));
    asset.facts = std::move(verdict.facts);
    service.store.assets().add(asset, request.body);
    const auto added = service.store.assets().find(asset.sha256);
    if (!added) throw Problem(409, "The asset was deleted in the meantime.");
    return asset_response(201, *added);
}

Problem no_such_asset() {
    return {404, "There is no such asset."};
}

std::string asset_etag(const Asset& asset) {
    return fmt::format("\"{}\"", asset.sha256);
}

Answer get_asset(Service& service, const Request& request) {
    const std::string sha256 = request.path_values.at("sha256");
    const auto found = service.store.assets().open(sha256);
    if (!found) throw no_such_asset();
    const Asset& asset = found->asset;
    Response response{.status = 200, .headers = {}, .body = found->content};
    response.headers.add("Content-Type", asset.media_type);
    response.headers.add("ETag", asset_etag(asset));
    // Private and revalidated, since an asset can be deleted.
    response.headers.add("Cache-Control", "private, no-cache");
    return response;
}

Answer list_assets(Service& service, const Request& request) {
    answer::AssetList list{.max_bytes = service.limits.max_asset_bytes};
    for (const AssetKind& kind : asset_kinds()) list.accepts.push_back({kind.media_type, kind.type, kind.suffixes});
    for (const Asset& asset : service.store.assets().list(request.query["limit"]))
        list.assets.push_back(written(asset));
    return json_response(200, to_document(list));
}

std::string current_asset_etag(Service& service, const Request& request) {
    const std::string sha256 = request.path_values.at("sha256");
    const auto found = service.store.assets().find(sha256);
    if (!found) throw no_such_asset();
    return asset_etag(*found);
}

Answer delete_asset(Service& service, const Request& request) {
    switch (service.store.assets().remove(request.path_values.at("sha256"))) {
        case Assets::Removal::removed:
            return Response{.status = 204, .headers = {}, .body = {}};
        case Assets::Removal::in_use:
            throw Problem(409, "A queued or running report needs this asset.");
        case Assets::Removal::not_found:
            break;
    }
    throw no_such_asset();
}

Route post_route(Service& service) {
    std::vector<std::string> media_types;
    for (const AssetKind& kind : asset_kinds()) media_types.push_back(kind.media_type);
    auto checks = std::make_shared<std::atomic<int>>(0);
    return {
        .method = "POST",
        .pattern = assets_path,
        .id = "createAsset",
        .summary = "Upload a file that specs can refer to by its SHA-256",
        .description =
            "The body is the file, and Content-Type says how it is read. It is decoded once, in a process that may "
            "die, before it is kept.",
        .query = {Param::text("name", "a name for the list", "", max_name_bytes)},
        .replies =
            {{201, "It is stored; Location is its address", "application/json", "Asset", {"Location"}},
             {200, "It had already been uploaded", "application/json", "Asset", {"Location"}},
             {409, "The same bytes have already been uploaded with another type", "application/problem+json",
              "Problem"},
             {422, "The file does not match its type; `detail` has the reason", "application/problem+json", "Problem"},
             {507, "There is no room for it", "application/problem+json", "Problem"},
             {429,
              "Other uploads are being read, or the token's quota is used up; Retry-After says when to try again",
              "application/problem+json",
              "Problem",
              {"Retry-After"}}},
        .handle = [&service, checks](const Request& request) { return post_asset(service, *checks, request); },
        .body_types = std::move(media_types),
        .body_bytes = service.limits.max_asset_bytes};
}

Route one_route(std::string method, std::string id, std::string summary, std::vector<Reply> replies, Handler handle) {
    replies.push_back({404, "There is no such asset", "application/problem+json", "Problem"});
    return {.method = std::move(method),
            .pattern = std::string(assets_path) + "/{sha256}",
            .id = std::move(id),
            .summary = std::move(summary),
            .replies = std::move(replies),
            .handle = std::move(handle)};
}

}  // namespace

std::vector<Route> asset_routes(Service& service) {
    Route remove =
        one_route("DELETE", "deleteAsset", "Delete an uploaded file",
                  {{204, "It is deleted", "", ""},
                   {409, "A queued or running report needs it", "application/problem+json", "Problem"},
                   {412, "If-Match or If-None-Match is not satisfied", "application/problem+json", "Problem"}},
                  [&service](const Request& request) { return delete_asset(service, request); });
    remove.etag = [&service](const Request& request) { return current_asset_etag(service, request); };
    return {post_route(service),
            {.method = "GET",
             .pattern = assets_path,
             .id = "listAssets",
             .summary = "The uploaded files, newest first, and the kinds that are accepted",
             .query = {Param::integer("limit", "greatest number of files", "", 100, 1, 1000)},
             .replies = {{200, "The list", "application/json", "AssetList"}},
             .handle = [&service](const Request& request) { return list_assets(service, request); }},
            one_route("GET", "getAsset", "The bytes of an uploaded file", {{200, "The file", "*/*", "", {"ETag"}}},
                      [&service](const Request& request) { return get_asset(service, request); }),
            std::move(remove)};
}

}  // namespace sheer::http
