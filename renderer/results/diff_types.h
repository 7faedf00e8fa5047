#pragma once
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "renderer/params/described.h"
#include "renderer/results/report.h"

namespace sheer::diff {

// The changes between two reports, as types. The descriptions say what each member means; docs/measuring.md says how
// times are judged.

enum class PictureVerdict { identical, different, not_examined };
enum class Floats { identical, different };

/// A value for each of the two reports.
template <typename T>
struct Both {
    T a{}, b{};
};

struct Side {
    std::string id;
    std::optional<std::string> title;
    std::string created_at, version, commit, renderer;
    std::optional<std::string> baseline;
};

struct Difference {
    std::string pointer;
    nlohmann::json a, b;
    bool allowed = false;
};

struct OnlyIn {
    std::vector<std::string> methods;
    nlohmann::json points = nlohmann::json::array();
};

struct PictureCounts {
    std::size_t identical = 0, different = 0, not_examined = 0;
};

struct TimeCounts {
    std::size_t faster = 0, slower = 0, not_resolved = 0;
};

struct Summary {
    PictureCounts pictures;
    TimeCounts times;
    std::size_t statuses_changed = 0;
};

struct FlipError {
    double mean = 0, max = 0;
};

/// Absent if it was not examined, null if the pictures are identical.
struct WorstPixel {
    bool is_known = false;
    std::optional<std::array<int, 2>> place;

    bool operator==(const WorstPixel&) const = default;
};

struct PictureDiff {
    PictureVerdict verdict = PictureVerdict::not_examined;
    std::string reason;
    std::optional<FlipError> flip;
    std::optional<std::uint64_t> differing_pixels;
    std::optional<int> greatest_levels;
    WorstPixel worst_pixel;
    std::optional<report::Picture> flip_picture;
    std::optional<Floats> linear;
    report::Picture a, b;
};

struct TimesOf {
    std::optional<double> median;
    std::size_t samples = 0;
};

struct Judged {
    double value = 1;
    std::optional<report::Interval> ci95;
    report::SpeedVerdict verdict = report::SpeedVerdict::not_resolved;
    std::string reason;
};

struct TimeDiff {
    report::Clock clock = report::Clock::wall;
    TimesOf a, b;
    std::optional<Judged> absolute;
    OrReason<Judged> relative;
    report::SpeedVerdict verdict = report::SpeedVerdict::not_resolved;
    std::string reason;
};

using Reasons = Both<std::optional<std::string>>;

struct ResultDiff {
    std::string label, method;
    Both<report::ResultStatus> status;
    std::optional<PictureDiff> picture;
    std::optional<TimeDiff> time;
    std::optional<Reasons> reason;
};

struct ReferenceDiff {
    Both<std::string> method;
    std::optional<PictureDiff> picture;
};

struct Size {
    int width = 0, height = 0;
};

struct RunDiff {
    report::Point point = nlohmann::json::object();
    Size image;
    std::size_t compared = 0;
    ReferenceDiff reference;
    std::vector<ResultDiff> results;
};

struct Diff {
    Side a, b;
    bool same_device = false;
    std::vector<Difference> differences;
    Both<OnlyIn> only_in;
    Summary summary;
    std::vector<RunDiff> runs;
};

}  // namespace sheer::diff

namespace sheer {

template <>
struct Words<diff::PictureVerdict> {
    using enum diff::PictureVerdict;
    static constexpr std::pair<diff::PictureVerdict, const char*> all[] = {
        {identical, "identical"}, {different, "different"}, {not_examined, "not examined"}};
};
template <>
struct Words<diff::Floats> {
    using enum diff::Floats;
    static constexpr std::pair<diff::Floats, const char*> all[] = {{identical, "identical"}, {different, "different"}};
};

template <>
const Description<diff::Side>& description_of();
template <>
const Description<diff::Difference>& description_of();
template <>
const Description<diff::OnlyIn>& description_of();
template <>
const Description<diff::Both<diff::OnlyIn>>& description_of();
template <>
const Description<diff::PictureCounts>& description_of();
template <>
const Description<diff::TimeCounts>& description_of();
template <>
const Description<diff::Summary>& description_of();
template <>
const Description<diff::FlipError>& description_of();
template <>
const Description<diff::PictureDiff>& description_of();
template <>
const Description<diff::TimesOf>& description_of();
template <>
const Description<diff::Judged>& description_of();
template <>
const Description<diff::TimeDiff>& description_of();
template <>
const Description<diff::Both<report::ResultStatus>>& description_of();
template <>
const Description<diff::Reasons>& description_of();
template <>
const Description<diff::ResultDiff>& description_of();
template <>
const Description<diff::Both<std::string>>& description_of();
template <>
const Description<diff::ReferenceDiff>& description_of();
template <>
const Description<diff::Size>& description_of();
template <>
const Description<diff::RunDiff>& description_of();
template <>
const Description<diff::Diff>& description_of();

namespace detail {

template <>
struct Codec<diff::WorstPixel> {
    using Place = Codec<std::optional<std::array<int, 2>>>;
    static nlohmann::json write(const diff::WorstPixel& pixel) { return Place::write(pixel.place); }
    static void read(const nlohmann::json& from, diff::WorstPixel& to) {
        to.is_known = true;
        Place::read(from, to.place);
    }
    static nlohmann::json schema(SchemaBook& book) { return Place::schema(book); }
};

}  // namespace detail

}  // namespace sheer
