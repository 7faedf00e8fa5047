#pragma once
#include <exception>
#include <nlohmann/json.hpp>

namespace sheer::cli {

/// The end of a renderer after an exception.
struct Failure {
    int exit_code = 0;
    nlohmann::json message;     ///< the line sent to its worker: {"error": {"kind", "detail", "errors"}}
    bool is_for_caller = true;  ///< false: `detail` is generic, and the text of the exception must go to the log
};

/// Errors of the disk have the kind "storage", with `full` if it is full: they are not the job's fault. The texts of
/// SpecError, Unsupported and RenderError are meant for the sender of the job. Those of other exceptions may name files
/// and libraries of the host, and are not sent.
Failure describe_failure(const std::exception& error);

}  // namespace sheer::cli
