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
#include "renderer/report/statistics.h"
#include "version.h"

namespace sheer {

using nlohmann::json;

namespace {

json pair_json(const std::optional<std::pair<double, double>>& interval) {
    return interval ? json{interval->first, interval->second} : json();
}

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
        : m_spec(spec), m_comparison(comparison), m_sink(sink) {}

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
            results.push_back(result_json(result, fmt::format("{}-{}", i + 1, result.method.label)));
        }
        for (std::size_t i = 0; i < run.results.size(); ++i) results[i]["speedup"] = speedup(run, run.results[i]);
        return {{"point", run.point}, {"reference", reference}, {"results", results}};
    }

    json result_json(const MethodResult& result, const std::string& name) const {
        json object = {{"method", result.method.id},
                       {"label", result.method.label},
                       {"parameters", result.method.parameters},
                       {"status", result.status},
                       {"reason", result.reason.empty() ? json() : json(result.reason)},
                       {"images", json::object()},
                       {"timing", nullptr},
                       {"metrics", nullptr},
                       {"memory_bytes", nullptr}};
        if (result.status != "ok") return object;
        object["images"] = pictures(result.image, name, m_spec.image.format != PixelFormat::rgba8);
        object["timing"] = timing(result.samples);
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

    static bool gpu_clock_holds(const std::vector<gl::FrameSample>& samples) {
        return std::ranges::all_of(samples, &gl::FrameSample::valid);
    }

    /// The GPU's clock leaves out what the CPU does between draws; a software rasteriser is the CPU, so there, and
    /// wherever the two clocks disagree, the fenced wall clock is what counts.
    bool use_gpu_clock() const {
        if (m_comparison.device.software) return false;
        for (const Run& run : m_comparison.runs)
            for (const MethodResult& result : run.results)
                if (!gpu_clock_holds(result.samples)) return false;
        return true;
    }

    std::vector<double> times(const std::vector<gl::FrameSample>& samples) const {
        const bool gpu = use_gpu_clock();
        std::vector<double> all;
        for (const gl::FrameSample& sample : samples) all.push_back(gpu ? sample.gpu_ms : sample.wall_ms);
        return all;
    }

    static double phase_median(const std::vector<gl::FrameSample>& samples, gl::Phase phase) {
        std::vector<double> sums;
        for (const gl::FrameSample& sample : samples) {
            double sum = 0;
            for (const gl::PassSample& pass : sample.passes)
                if (pass.phase == phase) sum += pass.gpu_ms;
            sums.push_back(sum);
        }
        return median(sums);
    }

    /// Times of passes that bear the same name, such as the tiles of a reference, are added up.
    static json passes(const std::vector<gl::FrameSample>& samples) {
        json all = json::array();
        std::vector<std::string> names;
        for (const gl::PassSample& pass : samples.front().passes)
            if (std::ranges::find(names, pass.name) == names.end()) names.push_back(pass.name);
        for (const std::string& name : names) {
            std::vector<double> sums;
            for (const gl::FrameSample& sample : samples) {
                double sum = 0;
                for (const gl::PassSample& pass : sample.passes)
                    if (pass.name == name) sum += pass.gpu_ms;
                sums.push_back(sum);
            }
            all.push_back({{"name", name}, {"median", median(sums)}});
        }
        return all;
    }

    json timing(const std::vector<gl::FrameSample>& samples) const {
        const std::vector<double> chosen = times(samples);
        const Summary summary = summarize(chosen);
        std::vector<double> gpu, wall;
        std::size_t disagreeing = 0;
        for (const gl::FrameSample& sample : samples) {
            gpu.push_back(sample.gpu_ms);
            wall.push_back(sample.wall_ms);
            disagreeing += sample.valid ? 0 : 1;
        }
        return {{"unit", "ms"},
                {"clock", use_gpu_clock() ? "gpu" : "wall"},
                {"samples", chosen},
                {"median", summary.median},
                {"mad", summary.mad},
                {"min", summary.min},
                {"p95", summary.p95},
                {"ci95", pair_json(summary.ci95)},
                {"initialization", phase_median(samples, gl::Phase::initialization)},
                {"finalization", phase_median(samples, gl::Phase::finalization)},
                {"passes", passes(samples)},
                {"gpu_samples", gpu},
                {"wall_samples", wall},
                {"disagreeing_samples", disagreeing}};
    }

    /// Time of the baseline over time of the method, round by round; the rounds are what is paired.
    json speedup(const Run& run, const MethodResult& result) const {
        const auto baseline = std::ranges::find_if(
            run.results, [&](const MethodResult& other) { return other.method.label == m_spec.baseline; });
        if (result.status != "ok" || baseline->status != "ok") return nullptr;
        const std::vector<double> ours = times(result.samples), theirs = times(baseline->samples);
        std::vector<double> ratios;
        for (std::size_t i = 0; i < std::min(ours.size(), theirs.size()); ++i)
            if (ours[i] > 0) ratios.push_back(theirs[i] / ours[i]);
        if (ratios.empty()) return nullptr;
        const auto interval = median_interval(ratios, 0.05);
        std::string resolved = "not resolved";
        if (interval && interval->first > 1) resolved = "faster";
        if (interval && interval->second < 1) resolved = "slower";
        return {{"value", median(ratios)}, {"ci95", pair_json(interval)}, {"verdict", resolved}};
    }

    /// The number that a check names, or null.
    static json measured(const json& result, const std::string& metric) {
        if (metric == "speedup") return result["speedup"].is_null() ? json() : result["speedup"]["value"];
        json value = metric.starts_with("timing.") ? result : result["metrics"];
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
