#pragma once

namespace sheer::http {

// Paths of the service.
inline constexpr const char* trends_path = "/api/v1/trends";
inline constexpr const char* reports_path = "/api/v1/reports";
inline constexpr const char* blobs_path = "/api/v1/blobs";
inline constexpr const char* baselines_path = "/api/v1/baselines";
inline constexpr const char* assets_path = "/api/v1/assets";

}  // namespace sheer::http
