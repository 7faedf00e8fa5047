#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/core/notes.h"
#include "renderer/gl/context.h"
#include "renderer/params/described.h"

namespace sheer::report {

// A report as types. The descriptions say what each member means, its unit and when it is null; docs/report.md and the
// schemas are made from them.

using Interval = std::array<double, 2>;
/// Values of a point of the sweep by JSON pointer into the spec.
using Point = nlohmann::json;

enum class Status { queued, running, done, failed, cancelled };
enum class ResultStatus { ok, unsupported, failed };
enum class CheckOutcome { passed, failed, undecided };
enum class ReportVerdict { passed, failed, undecided, none };
enum class SpeedVerdict { faster, slower, not_resolved };
enum class Clock { gpu, wall };
enum class TrendVerdict { holds, fails, not_resolved };

struct Error {
    std::string title, detail;
};

struct File {
    std::string pointer, name, of, sha256;
    std::int64_t bytes = 0;

    bool operator==(const File&) const = default;
};

struct Picture {
    std::string sha256, url, media_type;
    std::optional<std::int64_t> greatest, full_scale;
};
using Pictures = std::map<std::string, Picture>;

struct PassTime {
    std::string name;
    double median = 0;
};

struct TimeSummary {
    std::vector<double> samples;
    std::vector<std::size_t> outliers;
    double median = 0, mad = 0, min = 0, p95 = 0;
    std::optional<Interval> ci95;
    std::string unit = "ms";
    Clock clock = Clock::wall;
};

struct Timing : TimeSummary {
    double initialization = 0, finalization = 0;
    std::vector<PassTime> passes;
    std::vector<double> gpu_samples, wall_samples;
    std::size_t disagreeing_samples = 0;
    OrReason<std::vector<unsigned>> gpu_clock_mhz;
    int retaken_samples = 0;
    std::vector<std::string> clock_lowered_by;
    OrReason<TimeSummary> sort;
};

struct Speedup {
    double value = 1;
    std::optional<Interval> ci95;
    SpeedVerdict verdict = SpeedVerdict::not_resolved;
    std::string reason;
    std::size_t compared = 1;
};

struct NoiseFloor {
    std::string method;
    double value = 1;
    std::optional<Interval> ci95;
    std::optional<double> factor;  ///< without a value: infinite
    std::vector<double> samples;
};

struct Fragments {
    std::int64_t submitted = 0;
    OrReason<std::int64_t> shaded, visible, needed;
    std::string shaded_by;
    OrReason<std::int64_t> quads, live_quads, warps, live_warps;
    OrReason<double> model_speedup;
    OrReason<double> efficiency;
};

/// The values of the metrics by their ids, as each MetricInfo describes them.
struct Metrics {
    nlohmann::json values = nlohmann::json::object();
};

/// A method with its own look, compared with the same method in another one.
struct Change {
    std::string from;
    bool is_identical = false;
    Metrics metrics;
    OrReason<Speedup> speedup;
};

struct Result {
    std::string method, label;
    nlohmann::json parameters = nlohmann::json::object();
    ResultStatus status = ResultStatus::ok;
    std::string reason;
    Pictures images;
    std::optional<Timing> timing;
    OrReason<Speedup> speedup, speedup_with_sort;
    std::optional<Fragments> fragments;
    OrReason<Metrics> metrics;
    OrReason<Change> change;
    std::optional<std::int64_t> memory_bytes;
    nlohmann::json findings = nlohmann::json::object();
    std::vector<Note> notes;
};

struct Rounded {
    std::string label, format;
    Metrics metrics;
};

struct Residual {
    std::optional<double> depth_peeling;
};

struct Reference {
    std::string method;
    nlohmann::json parameters = nlohmann::json::object();
    ResultStatus status = ResultStatus::ok;
    std::string reason;
    Pictures images;
    nlohmann::json findings = nlohmann::json::object();
    Residual residual;
    std::string residual_reason;
    std::optional<Rounded> rounded;
};

struct Rounds {
    std::size_t asked = 0, done = 0, needed = 0, looks = 0;
};

struct Dominated {
    std::string method, by, reason;
};

/// A method and those with which it ties.
struct Winner {
    std::optional<std::string> method;
    std::vector<std::string> tied;

    bool operator==(const Winner&) const = default;
};
struct FastestUnder : Winner {
    double error = 0;
};
struct ClosestWithin : Winner {
    double speed = 1;
};
struct LeastMemoryUnder : Winner {
    double error = 0;
    std::int64_t memory_bytes = 0;

    bool operator==(const LeastMemoryUnder&) const = default;
};

struct Frontier {
    std::string error;
    std::vector<std::string> fastest, methods;
    std::vector<Dominated> dominated;
    std::vector<FastestUnder> fastest_under;
    std::vector<ClosestWithin> closest_within;
    std::vector<LeastMemoryUnder> least_memory_under;
    std::vector<std::string> sentences;
};

struct Run {
    Point point = nlohmann::json::object();
    Reference reference;
    Rounds rounds;
    std::optional<NoiseFloor> noise_floor;
    std::string nothing_drawn;
    std::vector<Note> notes;
    std::vector<File> files;
    std::vector<Result> results;
    std::optional<Frontier> frontier;

    /// Null if there is none with this label.
    const Result* find(const std::string& label) const;
};

struct Growth {
    std::string metric = "timing.median";  ///< older reports do not say it
    std::string pointer;
    Point at = nlohmann::json::object();
    std::string method;
    double exponent = 0;
    Interval ci95{0, 0};
    std::size_t points = 0;
};

struct Check {
    std::string metric, method;
    Point at = nlohmann::json::object();
    std::optional<double> min, max, value;
    std::optional<CheckOutcome> outcome;  ///< missing in older reports
    bool passed = false;
    std::string reason;

    CheckOutcome came_out() const;
};

struct Device : gl::DeviceInfo {
    OrReason<std::string> driver;
    std::string cpu;
    std::vector<std::string> workarounds;
};

struct ColorSpace {
    std::string values, blending, quantised_metrics, float_metrics;
};

using LoadAverage = std::array<double, 3>;
struct Load {
    std::optional<LoadAverage> start, end;
    std::string reason;
};

struct Provenance {
    std::string version, commit, rerun, spec;
    unsigned cores = 0;
    Load load;
    OrReason<std::string> governor;
};

/// How often a slowdown of a known size was found.
struct QualifiedSlowdown {
    double more_work = 0, slowdown = 1, found = 0;
    int comparisons = 0;
};

/// See renderer/report/qualification.h.
struct Qualification {
    std::string at, renderer, cpu;
    int comparisons = 0, false_changes = 0;
    double false_change_rate = 0;
    Interval false_change_ci95{0, 1};
    std::vector<QualifiedSlowdown> slowdowns;
    std::optional<double> found_from;
};

struct Points {
    std::size_t asked = 0, done = 0;
};

struct Figure {
    Point at = nlohmann::json::object();
    std::string method, metric;
    nlohmann::json published;
    std::optional<double> measured;
    std::optional<Interval> ci95;
};

struct Trend {
    std::string text, detail;
    TrendVerdict verdict = TrendVerdict::not_resolved;
};

struct Suite {
    std::string id, title, source, device;
    std::vector<Figure> figures;
    std::vector<Trend> trends;
};

/// An accepted report with which this one could not be compared.
struct NotAgainst {
    std::string report, reason;
    std::vector<std::string> differing;
};

/// The report with which this one was compared, and why with that one.
struct Against {
    std::string asked;
    std::optional<std::string> report;  ///< none if there was none to compare with
    std::string accepted_at, text;
    std::vector<NotAgainst> refused;
};

/// One of several devices of a report.
struct DevicePart {
    std::string label;
    Status status = Status::queued;
    std::string reason;
    std::optional<Device> device;
    std::optional<Provenance> provenance;
    std::optional<Qualification> qualification;
};

/// A method on one of several devices, at a point of the sweep.
struct AcrossDevice {
    std::string device;  ///< its label
    OrReason<double> median;
    std::optional<Interval> ci95;
    OrReason<double> flip;
    std::optional<std::uint64_t> differing_pixels;
};

/// A method on each of several devices.
struct AcrossRow {
    Point at = nlohmann::json::object();
    std::string method;
    std::vector<AcrossDevice> devices;
};

/// A report before it is done, or one that ended without being done.
struct Head {
    std::string id;
    Status status = Status::done;
    double progress = 1;
    std::optional<Error> error;
    std::string created_at, finished_at, spec_sha256;
    nlohmann::json spec = nlohmann::json::object();
};

struct UnfinishedReport : Head {
    std::string stage;
    std::vector<DevicePart> devices;
    std::vector<Note> notes;
};

struct Report : Head {
    std::optional<Device> device;
    std::vector<DevicePart> devices;
    std::vector<AcrossRow> across_devices;
    ColorSpace color_space;
    Provenance provenance;
    std::optional<Qualification> qualification;
    std::vector<Run> runs;
    std::vector<Growth> growth;
    std::optional<Suite> suite;
    std::optional<Against> against;
    std::vector<Check> checks;
    ReportVerdict verdict = ReportVerdict::none;
    std::string verdict_reason;
    std::vector<Note> notes;
    std::vector<File> files;
    Points points;

    std::string title() const;
    /// The label of the method with which times are compared.
    std::string baseline() const;
    /// Every picture in the report; one that several results share is repeated.
    std::vector<Picture> pictures() const;
};

/// Returns the bytes of a picture. Throws std::exception if they are not available.
using PictureReader = std::function<std::string(const Picture&)>;

}  // namespace sheer::report

namespace sheer {

template <>
struct Words<report::Status> {
    using enum report::Status;
    static constexpr std::pair<report::Status, const char*> all[] = {
        {queued, "queued"}, {running, "running"}, {done, "done"}, {failed, "failed"}, {cancelled, "cancelled"}};
};
template <>
struct Words<report::ResultStatus> {
    using enum report::ResultStatus;
    static constexpr std::pair<report::ResultStatus, const char*> all[] = {
        {ok, "ok"}, {unsupported, "unsupported"}, {failed, "failed"}};
};
template <>
struct Words<report::CheckOutcome> {
    using enum report::CheckOutcome;
    static constexpr std::pair<report::CheckOutcome, const char*> all[] = {
        {passed, "passed"}, {failed, "failed"}, {undecided, "undecided"}};
};
template <>
struct Words<report::ReportVerdict> {
    using enum report::ReportVerdict;
    static constexpr std::pair<report::ReportVerdict, const char*> all[] = {
        {passed, "passed"}, {failed, "failed"}, {undecided, "undecided"}, {none, "none"}};
};
template <>
struct Words<report::SpeedVerdict> {
    using enum report::SpeedVerdict;
    static constexpr std::pair<report::SpeedVerdict, const char*> all[] = {
        {faster, "faster"}, {slower, "slower"}, {not_resolved, "not resolved"}};
};
template <>
struct Words<report::Clock> {
    using enum report::Clock;
    static constexpr std::pair<report::Clock, const char*> all[] = {{gpu, "gpu"}, {wall, "wall"}};
};
template <>
struct Words<report::TrendVerdict> {
    using enum report::TrendVerdict;
    static constexpr std::pair<report::TrendVerdict, const char*> all[] = {
        {holds, "holds"}, {fails, "fails"}, {not_resolved, "not resolved"}};
};

template <>
const Description<Note>& description_of();
template <>
const Description<report::Error>& description_of();
template <>
const Description<report::File>& description_of();
template <>
const Description<report::Picture>& description_of();
template <>
const Description<report::PassTime>& description_of();
template <>
const Description<report::TimeSummary>& description_of();
template <>
const Description<report::Timing>& description_of();
template <>
const Description<report::Speedup>& description_of();
template <>
const Description<report::NoiseFloor>& description_of();
template <>
const Description<report::Fragments>& description_of();
template <>
const Description<report::Change>& description_of();
template <>
const Description<report::Result>& description_of();
template <>
const Description<report::Rounded>& description_of();
template <>
const Description<report::Residual>& description_of();
template <>
const Description<report::Reference>& description_of();
template <>
const Description<report::Rounds>& description_of();
template <>
const Description<report::Dominated>& description_of();
template <>
const Description<report::Winner>& description_of();
template <>
const Description<report::FastestUnder>& description_of();
template <>
const Description<report::ClosestWithin>& description_of();
template <>
const Description<report::LeastMemoryUnder>& description_of();
template <>
const Description<report::Frontier>& description_of();
template <>
const Description<report::Run>& description_of();
template <>
const Description<report::Check>& description_of();
template <>
const Description<report::Device>& description_of();
template <>
const Description<report::ColorSpace>& description_of();
template <>
const Description<report::Load>& description_of();
template <>
const Description<report::Provenance>& description_of();
template <>
const Description<report::Points>& description_of();
template <>
const Description<report::QualifiedSlowdown>& description_of();
template <>
const Description<report::Qualification>& description_of();
template <>
const Description<report::Figure>& description_of();
template <>
const Description<report::Trend>& description_of();
template <>
const Description<report::Suite>& description_of();
template <>
const Description<report::NotAgainst>& description_of();
template <>
const Description<report::Against>& description_of();
template <>
const Description<report::DevicePart>& description_of();
template <>
const Description<report::AcrossDevice>& description_of();
template <>
const Description<report::AcrossRow>& description_of();
template <>
const Description<report::Head>& description_of();
template <>
const Description<report::UnfinishedReport>& description_of();
template <>
const Description<report::Report>& description_of();

namespace detail {

/// The metrics themselves describe it.
template <>
struct Codec<report::Metrics> {
    static nlohmann::json write(const report::Metrics& metrics) { return metrics.values; }
    static void read(const nlohmann::json& from, report::Metrics& to);
    static nlohmann::json schema(SchemaBook& book);
};

}  // namespace detail

}  // namespace sheer
