#include "renderer/report/report.h"

#include <openssl/evp.h>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "renderer/report/picture_file.h"
#include "renderer/report/timing.h"
#include "version.h"

namespace sheer {

using nlohmann::json;

namespace {

std::string cpu_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    }
    return "unknown";
}

/// A name for files: what is neither letter nor digit becomes a dash.
std::string file_name(const std::string& label) {
    std::string name;
    for (const char c : label) name += std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_' ? c : '-';
    return name;
}

class ReportMaker {
  public:
    ReportMaker(const Spec& spec, const Comparison& comparison, BlobSink& sink)
        : m_spec(spec), m_comparison(comparison), m_sink(sink), m_timings(comparison, spec.baseline) {}

    json make(const std::string& created_at) {
        json report = {{"status", "done"},          {"progress", 1.0},
                       {"error", nullptr},          {"created_at", created_at},
                       {"spec", m_spec.normalised}, {"spec_sha256", sha256_hex(m_spec.canonical_text())},
                       {"device", device()},        {"provenance", provenance()}};
        report["runs"] = json::array();
        for (const Run& run : m_comparison.runs) report["runs"].push_back(run_json(run));
        report["checks"] = checks(report["runs"]);
        report["verdict"] = verdict(report["checks"]);
        report["finished_at"] = utc_now();
        return report;
    }

  private:
    json device() const {
        json device = gl::to_json(m_comparison.device);
        device["cpu"] = cpu_name();
        device["workarounds"] = m_comparison.workarounds;
        return device;
    }

    static json provenance() {
        return {{"version", version}, {"commit", commit}, {"rerun", "sheer compare SPEC.json"}};
    }

    json put(const std::string& bytes, const std::string& name, const std::string& media_type) const {
        const std::string sha256 = sha256_hex(bytes);
        return {{"sha256", sha256}, {"url", m_sink.put(sha256, bytes, name, media_type)}, {"media_type", media_type}};
    }

    json pictures(const Image& image, const std::string& label, bool linear) const {
        const std::string name = file_name(label);
        json all = {{"color", put(encode_png(quantize(image)), name + ".color.png", "image/png")}};
        if (linear) all["linear"] = put(encode_exr(image), name + ".linear.exr", "image/x-exr");
        return all;
    }

    json run_json(const Run& run) const {
        json reference = {{"method", run.reference.id},
                          {"parameters", run.reference.parameters},
                          {"images", pictures(run.reference_image, "reference-" + run.reference.id, true)},
                          {"residual", {{"depth_peeling", run.residual ? json(*run.residual) : json()}}}};
        if (!run.residual) reference["residual_reason"] = run.no_residual_reason;
        json results = json::array();
        for (std::size_t i = 0; i < run.results.size(); ++i) {
            const MethodResult& result = run.results[i];
            results.push_back(result_json(run, result, fmt::format("{}-{}", i + 1, result.method.label)));
        }
        return {{"point", run.point},
                {"reference", reference},
                {"rounds", {{"asked", m_spec.timing.rounds}, {"done", run.rounds_done}}},
                {"noise_floor", m_timings.noise(run)},
                {"results", results}};
    }

    json result_json(const Run& run, const MethodResult& result, const std::string& name) const {
        json object = {{"method", result.method.id},
                       {"label", result.method.label},
                       {"parameters", result.method.parameters},
                       {"status", result.status},
                       {"reason", result.reason.empty() ? json() : json(result.reason)},
                       {"images", json::object()},
                       {"timing", nullptr},
                       {"speedup", m_timings.speedup(run, result)},
                       {"fragments", nullptr},
                       {"metrics", nullptr},
                       {"memory_bytes", nullptr}};
        if (result.status != "ok") return object;
        object["images"] = pictures(result.image, name, m_spec.image.format != PixelFormat::rgba8);
        object["images"].update(count_pictures(run, result, name));
        object["timing"] = m_timings.timing(result.samples);
        object["fragments"] = fragments(run, result);
        object["memory_bytes"] = result.memory_bytes;
        if (result.metrics) {
            object["metrics"] = result.metrics->values;
            for (const auto& [key, picture] : result.metrics->pictures)
                object["images"][key] =
                    put(encode_png(picture), fmt::format("{}.{}.png", file_name(name), key), "image/png");
        } else {
            object["metrics_reason"] = result.no_metrics_reason;
        }
        return object;
    }

    /// The ideal time, that of f2b for the fragments that are needed, over the method's own.
    json efficiency(const Run& run, const MethodResult& result, std::string& reason) const {
        const auto f2b = std::ranges::find_if(
            run.results, [](const MethodResult& other) { return other.method.id == "f2b" && other.status == "ok"; });
        const double own_ms = m_timings.median_ms(result);
        if (f2b == run.results.end()) {
            reason = "f2b is not among the methods that ran";
        } else if (!result.fragments.needed) {
            reason = result.fragments.no_needed_reason;
        } else if (run.overdraw.total() == 0) {
            reason = "no fragment is submitted";
        } else if (own_ms <= 0) {
            reason = "the method took no time";
        } else {
            return m_timings.median_ms(*f2b) * static_cast<double>(result.fragments.needed->total()) /
                   static_cast<double>(run.overdraw.total()) / own_ms;
        }
        return nullptr;
    }

    json fragments(const Run& run, const MethodResult& result) const {
        std::string reason;
        json object = {{"submitted", run.overdraw.total()},
                       {"shaded", nullptr},
                       {"needed", nullptr},
                       {"efficiency", efficiency(run, result, reason)}};
        if (!reason.empty()) object["efficiency_reason"] = reason;
        const auto set = [&](const std::string& key, const std::optional<PixelCounts>& counts,
                             const std::string& why_not) {
            if (counts) {
                object[key] = counts->total();
            } else {
                object[key + "_reason"] = why_not;
            }
        };
        set("shaded", result.fragments.shaded, result.fragments.no_shaded_reason);
        set("needed", result.fragments.needed, result.fragments.no_needed_reason);
        return object;
    }

    /// All of a run share one scale, so that equal colours are equal numbers from picture to picture.
    static std::uint32_t count_scale(const Run& run) {
        std::uint32_t scale = run.overdraw.greatest();
        for (const MethodResult& result : run.results)
            if (result.fragments.shaded) scale = std::max(scale, result.fragments.shaded->greatest());
        return scale;
    }

    json count_pictures(const Run& run, const MethodResult& result, const std::string& name) const {
        const std::uint32_t scale = count_scale(run);
        json images = json::object();
        const auto add = [&](const std::string& key, const PixelCounts& counts) {
            images[key] = put(encode_png(count_picture(counts, scale)), fmt::format("{}.{}.png", file_name(name), key),
                              "image/png");
            images[key]["greatest"] = counts.greatest();
            images[key]["full_scale"] = scale;
        };
        if (!run.overdraw.counts.empty()) add("overdraw", run.overdraw);
        if (result.fragments.shaded) add("shaded", *result.fragments.shaded);
        if (result.fragments.saturation) add("saturation", *result.fragments.saturation);
        return images;
    }

    /// The number that a check names, or null.
    static json measured(const json& result, const std::string& metric) {
        if (metric == "speedup") return result["speedup"].is_null() ? json() : result["speedup"]["value"];
        const bool of_the_result =
            metric.starts_with("timing.") || metric.starts_with("fragments.") || metric == "memory_bytes";
        json value = of_the_result ? result : result["metrics"];
        for (std::size_t begin = 0; begin <= metric.size() && !value.is_null();) {
            const std::size_t end = std::min(metric.find('.', begin), metric.size());
            value = value.is_object() ? value.value(metric.substr(begin, end - begin), json()) : json();
            begin = end + 1;
        }
        return value;
    }

    json checks(const json& runs) const {
        json all = json::array();
        for (const CheckSpec& check : m_spec.checks) {
            for (const json& run : runs) {
                for (const json& result : run["results"]) {
                    if (result["label"] != check.method) continue;
                    const json value = measured(result, check.metric);
                    // PSNR is null where the pictures are identical, which passes any minimum.
                    const bool identical = check.metric == "psnr" && value.is_null() && result["metrics"].is_object();
                    const bool passed = identical ? check.max.is_null()
                                                  : value.is_number() && (check.min.is_null() || value >= check.min) &&
                                                        (check.max.is_null() || value <= check.max);
                    all.push_back({{"metric", check.metric},
                                   {"method", check.method},
                                   {"at", run["point"]},
                                   {"min", check.min},
                                   {"max", check.max},
                                   {"value", value},
                                   {"passed", passed}});
                }
            }
        }
        return all;
    }

    static std::string verdict(const json& checks) {
        if (checks.empty()) return "none";
        return std::ranges::all_of(checks, [](const json& check) { return check["passed"].get<bool>(); }) ? "passed"
                                                                                                          : "failed";
    }

    const Spec& m_spec;
    const Comparison& m_comparison;
    BlobSink& m_sink;
    Timings m_timings;
};

void write_file(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream file(path, std::ios::binary);
    file << bytes;
    file.close();
    if (!file) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace

FolderSink::FolderSink(std::filesystem::path folder) : m_folder(std::move(folder)) {
    std::filesystem::create_directories(m_folder / "images");
}

std::string FolderSink::put(const std::string&, const std::string& bytes, const std::string& name, const std::string&) {
    write_file(m_folder / "images" / name, bytes);
    return "images/" + name;
}

ContentSink::ContentSink(std::filesystem::path folder) : m_folder(std::move(folder)) {
    std::filesystem::create_directories(m_folder);
}

std::string ContentSink::put(const std::string& sha256, const std::string& bytes, const std::string&,
                             const std::string&) {
    write_file(m_folder / sha256, bytes);
    return "/api/v1/blobs/" + sha256;
}

json make_report(const Spec& spec, const Comparison& comparison, BlobSink& sink, const std::string& created_at) {
    return ReportMaker(spec, comparison, sink).make(created_at);
}

std::string sha256_hex(const std::string& bytes) {
    std::array<unsigned char, 32> digest;
    if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), nullptr, EVP_sha256(), nullptr) != 1)
        throw std::runtime_error("SHA-256 failed");
    std::string text;
    for (const unsigned char byte : digest) text += fmt::format("{:02x}", byte);
    return text;
}

std::string utc_now() {
    const auto now = std::chrono::system_clock::now();
    const auto milliseconds =
        std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count() % 1000;
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(std::chrono::system_clock::to_time_t(now)),
                       milliseconds);
}

}  // namespace sheer
