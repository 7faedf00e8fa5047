#include "renderer/report/qualification.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "renderer/core/files.h"
#include "renderer/params/json_text.h"

namespace sheer {

using nlohmann::json;

namespace {

// Few enough for the limit on loops, and enough that one hundredth of them is a whole number.
constexpr int iterations = 200;
constexpr std::array slower_by{0.01, 0.02, 0.05, 0.1, 0.2, 0.5};
constexpr std::array same_labels{"same", "same again"};
// A slowdown counts as found from the size on from which nearly all of them are.
constexpr double enough_found = 0.95;

std::string shading(int loops) {
    return fmt::format(
        "vec4 c = tint;\nfor (int i = 0; i < {}; ++i)\n    c.rgb = fract(c.rgb * 1.37 + uv.xyx * 0.11);\nreturn c;",
        loops);
}

std::string slower_label(double share) {
    return fmt::format("{:.0f} % slower", 100 * share);
}

double median_of_slowdowns(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

bool is_same_device(const report::Qualification& one, const report::Device& device) {
    return one.renderer == device.renderer && one.cpu == device.cpu;
}

std::vector<report::Qualification> kept_qualifications(const std::filesystem::path& file) {
    if (!std::filesystem::exists(file)) return {};
    return from_document<std::vector<report::Qualification>>(read_json(read_file(file, 1 << 20)));
}

}  // namespace

json qualification_spec(int size_px, int rounds) {
    json methods = {"b2f"};
    for (const char* label : same_labels) methods.push_back({{"id", "b2f"}, {"label", label}});
    for (const double share : slower_by)
        methods.push_back({{"id", "b2f"},
                           {"label", slower_label(share)},
                           {"shading", {{"glsl", shading(static_cast<int>(std::lround(iterations * (1 + share))))}}}});
    return {{"title", "Qualification of the device"},
            {"image", {{"width", size_px}, {"height", size_px}}},
            {"scene", {{"type", "quads"}, {"count", 8}, {"shading", {{"glsl", shading(iterations)}}}}},
            {"methods", methods},
            {"baseline", "b2f"},
            {"timing", {{"warmup", 1}, {"rounds", rounds}}}};
}

void QualificationTally::add(const report::Report& report) {
    using enum report::SpeedVerdict;
    ++m_reports;
    m_device = report.device;
    if (m_slower.empty())
        for (const double share : slower_by) m_slower.emplace_back(share, Count{});
    for (const report::Result& result : report.runs.at(0).results) {
        if (!result.speedup.value) continue;
        const auto& [ratio, ci95, verdict, reason, compared] = *result.speedup.value;
        for (const char* label : same_labels) {
            if (result.label != label) continue;
            ++m_same.trials;
            m_same.found += verdict != not_resolved;
        }
        for (auto& [share, count] : m_slower) {
            if (result.label != slower_label(share)) continue;
            ++count.trials;
            count.found += verdict == slower;
            count.slowdowns.push_back(1 / ratio);
        }
    }
}

report::Qualification QualificationTally::result(const std::string& at) const {
    if (!m_device || m_same.trials == 0) throw std::runtime_error("nothing was timed");
    report::Qualification all{.at = at, .renderer = m_device->renderer, .cpu = m_device->cpu};
    all.comparisons = m_same.trials;
    all.false_changes = m_same.found;
    all.false_change_rate = static_cast<double>(m_same.found) / m_same.trials;
    all.false_change_ci95 = wilson_interval(m_same.found, m_same.trials);
    for (const auto& [share, count] : m_slower) {
        if (count.trials == 0) continue;
        all.slowdowns.push_back({.more_work = share,
                                 .slowdown = median_of_slowdowns(count.slowdowns),
                                 .found = static_cast<double>(count.found) / count.trials,
                                 .comparisons = count.trials});
    }
    for (auto one = all.slowdowns.rbegin(); one != all.slowdowns.rend() && one->found >= enough_found; ++one)
        all.found_from = one->slowdown;
    return all;
}

report::Interval wilson_interval(int found, int trials) {
    constexpr double z = 1.959964;
    const double n = trials, rate = found / n;
    const double middle = (rate + z * z / (2 * n)) / (1 + z * z / n);
    const double half = z / (1 + z * z / n) * std::sqrt(rate * (1 - rate) / n + z * z / (4 * n * n));
    return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

std::string qualification_table(const report::Qualification& all) {
    std::string text = fmt::format("{} on {}\n\n", all.renderer, all.cpu);
    text += fmt::format("{:>10}  {:>10}  {:>14}\n", "more work", "slowdown", "called slower");
    for (const auto& [more_work, slowdown, found, comparisons] : all.slowdowns)
        text += fmt::format("{:>8.0f} %  {:>9.3f}x  {:>9.0f} % of {}\n", 100 * more_work, slowdown, 100 * found,
                            comparisons);
    text += fmt::format("\nA change of nothing was called a change {} times in {}: {:.1f} % [{:.1f}, {:.1f}].\n",
                        all.false_changes, all.comparisons, 100 * all.false_change_rate, 100 * all.false_change_ci95[0],
                        100 * all.false_change_ci95[1]);
    text += all.found_from
                ? fmt::format("Slowdowns from {:.3f}x on were found at least {:.0f} times in 100.\n", *all.found_from,
                              100 * enough_found)
                : fmt::format("None of these slowdowns was found {:.0f} times in 100.\n", 100 * enough_found);
    return text;
}

std::filesystem::path qualifications_file() {
    const auto folder = [](const char* name) {
        const char* const value = std::getenv(name);
        return std::filesystem::path(value == nullptr ? "" : value);
    };
    constexpr const char* name = "qualifications.json";
    if (const auto state = folder("SHEER_STATE"); !state.empty()) return state / name;
    if (const auto state = folder("XDG_STATE_HOME"); state.is_absolute()) return state / "sheer" / name;
    if (const auto home = folder("HOME"); home.is_absolute()) return home / ".local" / "state" / "sheer" / name;
    return {};
}

std::optional<report::Qualification> last_qualification(const std::filesystem::path& file,
                                                        const report::Device& device) {
    try {
        for (const report::Qualification& one : kept_qualifications(file))
            if (is_same_device(one, device)) return one;
    } catch (const std::exception&) {
        // A report is worth more than what it says of its device.
    }
    return std::nullopt;
}

void keep_qualification(const std::filesystem::path& file, const report::Qualification& qualification) {
    if (file.empty()) throw std::runtime_error("there is no folder for qualifications: set SHEER_STATE");
    std::filesystem::create_directories(file.parent_path());
    std::vector<report::Qualification> all;
    try {
        all = kept_qualifications(file);
    } catch (const std::exception&) {
        // It is replaced.
    }
    report::Device device;
    device.renderer = qualification.renderer;
    device.cpu = qualification.cpu;
    std::erase_if(all, [&](const report::Qualification& one) { return is_same_device(one, device); });
    all.push_back(qualification);
    const std::filesystem::path partial = file.string() + ".partial";
    write_file(partial, json_page(to_document(all)));
    std::filesystem::rename(partial, file);
}

}  // namespace sheer
