#pragma once
#include <exception>
#include <nlohmann/json.hpp>

namespace sheer::cli {

/// How a renderer ends after an exception.
struct Failure {
    int exit_code = 0;
    nlohmann::json message;     ///< the line for its worker: {"error": {"kind", "detail", "errors"}}
    bool is_for_caller = true;  ///< false: `detail` is a general one, and the log must have the text of the exception
};

/// What the disk refused is of the kind "storage", with `full` for a lack of room: it is not the job's fault.
/// SpecError, Unsupported and RenderError are written for whoever sent the job. What other exceptions say may name
/// files and libraries of the host, and stays here.
Failure describe_failure(const std::exception& error);

}  // namespace sheer::cli
