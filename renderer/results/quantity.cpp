#include "renderer/results/quantity.h"

#include <algorithm>
#include <limits>

namespace sheer {

using report::Result;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Measured exactly(double value) {
    return {value, value, value};
}

Measured within(double value, const std::optional<report::Interval>& interval) {
    if (!interval) return {value, -infinity, infinity};
    return {value, (*interval)[0], (*interval)[1]};
}

/// A time of the frames. If it has an interval, that is its uncertainty.
Quantity time(const std::string& name, const std::string& head, const std::string& summary,
              double report::Timing::*member, bool can_be_checked = true) {
    return {.name = "timing." + name,
            .path = "timing." + name,
            .table = Quantity::Table::times,
            .head = head,
            .unit = "ms",
            .summary = summary,
            .can_be_checked = can_be_checked,
            .measure = [member](const Result& result) -> std::optional<Measured> {
                if (!result.timing) return std::nullopt;
                return exactly((*result.timing).*member);
            },
            .reason = [](const Result&) { return std::string(); }};
}

Quantity speedup(const std::string& name, const std::string& head, const std::string& summary,
                 OrReason<report::Speedup> Result::*member, Quantity::Table table) {
    return {.name = name,
            .path = name + ".value",
            .table = table,
            .head = head,
            .unit = "×",
            .summary = summary,
            .is_timed = table == Quantity::Table::speedups,
            .is_speedup = true,
            .has_interval = true,
            .measure = [member](const Result& result) -> std::optional<Measured> {
                const auto& found = result.*member;
                if (!found) return std::nullopt;
                return within(found->value, found->ci95);
            },
            .reason = [member](const Result& result) { return (result.*member).reason; }};
}

template <typename T>
Quantity fragment_count(const std::string& name, const std::string& head, const std::string& summary,
                        OrReason<T> report::Fragments::*member) {
    return {.name = "fragments." + name,
            .path = "fragments." + name,
            .table = Quantity::Table::fragments,
            .head = head,
            .summary = summary,
            .is_whole = std::integral<T>,
            .measure = [member](const Result& result) -> std::optional<Measured> {
                if (!result.fragments || !((*result.fragments).*member)) return std::nullopt;
                return exactly(static_cast<double>(*((*result.fragments).*member)));
            },
            .reason =
                [member](const Result& result) {
                    return result.fragments ? ((*result.fragments).*member).reason : std::string();
                }};
}

Quantity median_time() {
    Quantity median = time("median", "Median", "Median of the timed frames", &report::Timing::median);
    median.is_timed = median.has_interval = true;
    median.measure = [](const Result& result) -> std::optional<Measured> {
        if (!result.timing) return std::nullopt;
        return within(result.timing->median, result.timing->ci95);
    };
    return median;
}

Quantity sort_time() {
    return {
        .name = "timing.sort.median",
        .path = "timing.sort.median",
        .table = Quantity::Table::sorting,
        .head = "Sort",
        .unit = "ms",
        .summary =
            "Recomputing the order, which the timed frames leave out: keys, sort and upload of the scene's primitives",
        .has_interval = true,
        .measure = [](const Result& result) -> std::optional<Measured> {
            if (!result.timing || !result.timing->sort) return std::nullopt;
            return within(result.timing->sort->median, result.timing->sort->ci95);
        },
        .reason = [](const Result& result) { return result.timing ? result.timing->sort.reason : std::string(); }};
}

Quantity part_of_frame(const std::string& name, const std::string& head, const std::string& summary,
                       double report::Timing::*member) {
    Quantity part = time(name, head, summary, member, false);
    part.digits = 2;
    return part;
}

Quantity submitted() {
    return {.name = "fragments.submitted",
            .path = "fragments.submitted",
            .table = Quantity::Table::fragments,
            .head = "Submitted",
            .summary = "Transparent fragments that opaque geometry does not hide",
            .is_whole = true,
            .measure = [](const Result& result) -> std::optional<Measured> {
                if (!result.fragments) return std::nullopt;
                return exactly(static_cast<double>(result.fragments->submitted));
            },
            .reason = [](const Result&) { return std::string(); }};
}

Quantity most_shaded() {
    return {.name = "images.shaded.greatest",
            .path = "images.shaded.greatest",
            .table = Quantity::Table::fragments,
            .head = "Most shaded",
            .unit = "per px",
            .summary = "Greatest number of fragments that the method shaded in one pixel",
            .is_whole = true,
            .can_be_checked = false,
            .measure = [](const Result& result) -> std::optional<Measured> {
                const auto found = result.images.find("shaded");
                if (found == result.images.end() || !found->second.greatest) return std::nullopt;
                return exactly(static_cast<double>(*found->second.greatest));
            },
            .reason = [](const Result& result) { return result.fragments ? result.fragments->shaded.reason : ""; }};
}

Quantity memory() {
    return {.name = "memory_bytes",
            .path = "memory_bytes",
            .unit = "bytes",
            .summary = "GL objects that the method made for its own use",
            .is_whole = true,
            .measure = [](const Result& result) -> std::optional<Measured> {
                if (!result.memory_bytes) return std::nullopt;
                return exactly(static_cast<double>(*result.memory_bytes));
            },
            .reason = [](const Result&) { return std::string(); }};
}

std::optional<Measured> value_in(const report::Metrics& metrics, const std::string& id, const std::string& name) {
    const auto found = metrics.values.find(id);
    if (found == metrics.values.end()) return std::nullopt;
    const nlohmann::json value = name.empty()         ? *found
                                 : found->is_object() ? found->value(name, nlohmann::json())
                                                      : nlohmann::json();
    if (!value.is_number()) return std::nullopt;
    return exactly(value.get<double>());
}

/// Why a result has no `change`, if that is not known.
constexpr const char* no_own_look = "the method has no shading or texture of its own";

/// The same metric of what a look of its own changes in the method.
Quantity of_change(const MetricInfo& metric, const MetricField& field) {
    return {.name = "change." + full_name(metric, field),
            .path = "change.metrics." + full_name(metric, field),
            .unit = field.unit,
            .summary = field.summary + "; from the picture of the same method in the other look",
            .is_whole = field.kind == MetricField::Kind::count,
            .measure = [id = metric.id, name = field.name](const Result& result) -> std::optional<Measured> {
                if (!result.change) return std::nullopt;
                return value_in(result.change->metrics, id, name);
            },
            .reason = [id = metric.id](const Result& result) -> std::string {
                if (!result.change) return result.change.reason.empty() ? no_own_look : result.change.reason;
                const auto found = result.change->metrics.values.find(id);
                const bool is_object = found != result.change->metrics.values.end() && found->is_object();
                return is_object ? found->value("reason", "") : "";
            }};
}

Quantity change_speedup() {
    return {.name = "change.speedup",
            .path = "change.speedup.value",
            .unit = "×",
            .summary = "Median of the times in the other look over those in its own, round by round",
            .is_speedup = true,
            .has_interval = true,
            .measure = [](const Result& result) -> std::optional<Measured> {
                if (!result.change || !result.change->speedup) return std::nullopt;
                return within(result.change->speedup->value, result.change->speedup->ci95);
            },
            .reason = [](const Result& result) -> std::string {
                if (result.change) return result.change->speedup.reason;
                return result.change.reason.empty() ? no_own_look : result.change.reason;
            }};
}

Quantity of_metric(const MetricInfo& metric, const MetricField& field) {
    const auto measure = [id = metric.id, name = field.name](const Result& result) -> std::optional<Measured> {
        return result.metrics ? value_in(*result.metrics, id, name) : std::nullopt;
    };
    return {.name = full_name(metric, field),
            .path = "metrics." + full_name(metric, field),
            .table = field.column.head.empty() ? Quantity::Table::none : Quantity::Table::differences,
            .head = field.column.head,
            .unit = field.unit,
            .summary = field.summary,
            .is_whole = field.kind == MetricField::Kind::count,
            .digits = field.column.digits,
            .terminal = field.column.terminal,
            .measure = measure,
            .reason = [](const Result& result) { return result.metrics.reason; }};
}

std::vector<Quantity> make_quantities() {
    std::vector<Quantity> all = {
        median_time(),
        time("mad", "MAD", "Median absolute deviation from the median", &report::Timing::mad, false),
        time("min", "Min", "Shortest frame", &report::Timing::min),
        time("p95", "p95", "95th percentile of the frames", &report::Timing::p95),
        part_of_frame("initialization", "Init.",
                      "Initialization: preparing the method's own targets, part of the frame",
                      &report::Timing::initialization),
        part_of_frame("finalization", "Final.", "Finalization: writing the result into the image, part of the frame",
                      &report::Timing::finalization),
        speedup("speedup", "Speed-up",
                "Median of the baseline's times over this method's, round by round, with its 95 % interval; not the "
                "ratio of the medians",
                &Result::speedup, Quantity::Table::speedups),
        sort_time(),
        speedup("speedup_with_sort", "With sort",
                "Speed-up if each method that sorts, the baseline included, does so in every frame",
                &Result::speedup_with_sort, Quantity::Table::sorting),
        submitted(),
        fragment_count("shaded", "Shaded",
                       "How many times the method ran the scene's shading for a transparent fragment",
                       &report::Fragments::shaded),
        fragment_count("visible", "Visible",
                       "Those of the shaded fragments that pass the depth and stencil tests: the least that any device "
                       "has to shade",
                       &report::Fragments::visible),
        fragment_count("needed", "Needed",
                       "Fragments from front to back until the transmittance falls below the method's threshold",
                       &report::Fragments::needed),
        most_shaded(),
        fragment_count("warps", "Warps",
                       "Groups of 8 × 4 pixels in which fragments of a primitive start, as a GPU's threads would do",
                       &report::Fragments::warps),
        fragment_count("live_warps", "Live warps", "Those in which the shading runs for at least one fragment",
                       &report::Fragments::live_warps),
        fragment_count("live_quads", "Live quads", "The same in groups of 2 × 2 pixels",
                       &report::Fragments::live_quads),
        fragment_count("model_speedup", "Model",
                       "A model of a GPU, not measured: the speedup over the baseline if a warp costs its texture "
                       "reads and one more for its start",
                       &report::Fragments::model_speedup),
        fragment_count("efficiency", "Efficiency",
                       "Ideal time (that of f2b for only the needed fragments) over the method's own time",
                       &report::Fragments::efficiency),
        memory()};
    for (const MetricInfo& metric : all_metrics())
        for (const MetricField& field : metric.fields)
            if (field.is_number()) all.push_back(of_metric(metric, field));
    all.push_back(change_speedup());
    for (const MetricInfo& metric : all_metrics())
        for (const MetricField& field : metric.fields)
            if (field.is_number()) all.push_back(of_change(metric, field));
    return all;
}

}  // namespace

std::optional<double> Quantity::value(const Result& result) const {
    const auto measured = measure(result);
    return measured ? std::optional(measured->value) : std::nullopt;
}

std::string Quantity::no_value_reason(const Result& result) const {
    if (result.status != report::ResultStatus::ok)
        return word_of(result.status) + (result.reason.empty() ? "" : ": " + result.reason);
    const std::string why = reason(result);
    return why.empty() ? "it was not measured" : why;
}

const std::vector<Quantity>& all_quantities() {
    static const std::vector<Quantity> all = make_quantities();
    return all;
}

const Quantity* find_quantity(const std::string& name) {
    const auto found = std::ranges::find(all_quantities(), name, &Quantity::name);
    return found == all_quantities().end() ? nullptr : &*found;
}

std::vector<std::string> checkable_names() {
    std::vector<std::string> names;
    for (const Quantity& quantity : all_quantities())
        if (quantity.can_be_checked) names.push_back(quantity.name);
    return names;
}

std::vector<Quantity> time_and_fragment_columns() {
    std::vector<Quantity> columns;
    for (const Quantity& quantity : all_quantities())
        if (quantity.table != Quantity::Table::none && quantity.table != Quantity::Table::differences)
            columns.push_back(quantity);
    return columns;
}

template <>
const Description<Quantity>& description_of() {
    static const auto description =
        Description<Quantity>("Column", "a column of the tables of times and fragments")
            .member(&Quantity::name, "name", "as checks name it")
            .member(&Quantity::path, "path", "path of its value in a result of a report, with dots between the members")
            .member(&Quantity::table, "table", "the table, or part of the table of times, to which it belongs")
            .member(&Quantity::head, "head", "its heading")
            .member(&Quantity::unit, "unit", "\"\" for none")
            .member(&Quantity::summary, "title", "its meaning")
            .member(&Quantity::is_whole, "whole", "whether it is a count")
            .member(&Quantity::is_timed, "timed", "whether the methods that may be called fastest are marked in it")
            .member(&Quantity::is_speedup, "is_speedup", "whether it is shown with its interval and verdict")
            .maybe(&Quantity::digits, "digits",
                   "significant digits of its smallest value; absent if it has as many decimals as the median time");
    return description;
}

}  // namespace sheer
