#include "server/cli/failure.h"

#include <new>

#include "renderer/errors.h"
#include "server/cli/commands.h"

namespace sheer::cli {

using nlohmann::json;

namespace {

json message(const std::string& kind, const std::string& detail, const json& errors = json::array()) {
    return {{"error", {{"kind", kind}, {"detail", detail}, {"errors", errors}}}};
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
    if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr)
        return {exit_render_failed, message("render", "The renderer ran out of memory."), false};
    return {exit_render_failed, message("render", "An error within the renderer; the log of the service has it."),
            false};
}

}  // namespace sheer::cli
