#include "server/cli/rendering/failure.h"

#include <new>
#include <system_error>

#include "renderer/core/errors.h"
#include "server/cli/rendering/commands.h"
#include "server/jobs/store_errors.h"

namespace sheer::cli {

using nlohmann::json;

namespace {

json message(const std::string& kind, const std::string& detail, const json& errors = json::array()) {
    return {{"error", {{"kind", kind}, {"detail", detail}, {"errors", errors}}}};
}

bool is_of_the_disk(const std::error_code& code) {
    return means_full_disk(code) || code == std::errc::io_error || code == std::errc::read_only_file_system;
}

}  // namespace

Failure describe_failure(const std::exception& error) {
    if (const auto* wrong = dynamic_cast<const SpecError*>(&error)) {
        json errors = json::array();
        for (const FieldError& field : wrong->errors())
            errors.push_back({{"pointer", field.pointer}, {"detail", field.detail}});
        return {exit_bad_spec, message("spec", error.what(), errors)};
    }
    if (dynamic_cast<const Unsupported*>(&error) != nullptr)
        return {exit_render_failed, message("unsupported", error.what())};
    if (dynamic_cast<const RenderError*>(&error) != nullptr)
        return {exit_render_failed, message("render", error.what())};
    if (const auto* system = dynamic_cast<const std::system_error*>(&error); system && is_of_the_disk(system->code())) {
        json line = message("storage", system->code().message());
        line["error"]["full"] = means_full_disk(system->code());
        return {exit_render_failed, std::move(line), false};
    }
    if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr)
        return {exit_render_failed, message("render", "The renderer ran out of memory."), false};
    return {exit_render_failed, message("render", "An error within the renderer; the service's log has the details."),
            false};
}

}  // namespace sheer::cli
