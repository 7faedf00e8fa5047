#include "renderer/diff/join.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/diff/diff_parts.h"
#include "renderer/files/report_document.h"
#include "renderer/report/growth.h"
#include "renderer/report/report.h"
#include "renderer/spec/spec.h"

namespace sheer {

using report::Report, report::Result;

namespace {

report::Point without_device(report::Point point) {
    point.erase(device_pointer);
    return point;
}

/// The run of a device that rendered nothing.
report::Run failed_run(const Spec& spec, const report::Point& point, const std::string& reason) {
    using enum report::ResultStatus;
    report::Run run{.point = point};
    run.reference = {.method = spec.reference.id, .parameters = spec.reference.parameters};
    run.reference.status = failed;
    run.reference.reason = reason;
    run.rounds.asked = static_cast<std::size_t>(spec.timing.rounds);
    for (const MethodSpec& method : spec.methods)
        run.results.push_back({.method = method.id,
                               .label = method.label,
                               .parameters = method.parameters,
                               .status = failed,
                               .reason = reason});
    return run;
}

std::optional<double> number_or_none(const nlohmann::json& value) {
    return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

/// Appends those of `more` that are still missing.
template <typename T>
void add_new(std::vector<T>& all, const std::vector<T>& more) {
    for (const T& one : more)
        if (std::ranges::find(all, one) == all.end()) all.push_back(one);
}

class Joining {
  public:
    Joining(const nlohmann::json& spec, const report::PictureReader& read_picture)
        : m_spec(parse_spec(spec)), m_read_picture(read_picture) {}

    Report join(const std::vector<RenderedPart>& parts) {
        const auto first = std::ranges::find_if(parts, [](const auto& part) { return part.report.has_value(); });
        if (first == parts.end()) throw std::invalid_argument("none of the parts has a report");
        m_report.device = first->report->device;
        m_report.color_space = first->report->color_space;
        m_report.provenance = first->report->provenance;
        m_report.provenance.rerun = "sheer submit SPEC.json --server URL";
        m_report.qualification = first->report->qualification;
        m_report.spec = m_spec.normalised;
        for (const RenderedPart& part : parts) part.report ? add(part.label, *part.report) : add_failed(part);
        m_report.growth = growth_of(m_spec.normalised.value("sweep", nlohmann::json::array()), m_report.runs);
        compare_devices();
        judge(m_report);
        return std::move(m_report);
    }

  private:
    void add(const std::string& label, const Report& part) {
        m_report.devices.push_back({.label = label,
                                    .status = report::Status::done,
                                    .device = part.device,
                                    .provenance = part.provenance,
                                    .qualification = part.qualification});
        for (report::Run run : part.runs) {
            run.point[device_pointer] = label;
            m_report.runs.push_back(std::move(run));
        }
        for (report::Check check : part.checks) {
            check.at[device_pointer] = label;
            m_report.checks.push_back(std::move(check));
        }
        add_new(m_report.notes, part.notes);
        add_new(m_report.files, part.files);
        m_report.points.asked += part.points.asked;
        m_report.points.done += part.points.done;
    }

    void add_failed(const RenderedPart& part) {
        m_report.devices.push_back({.label = part.label, .status = report::Status::failed, .reason = part.reason});
        const report::Point here{{device_pointer, part.label}};
        for (const SweepPoint& point : m_spec.points) {
            if (!lies_at(point, here)) continue;
            m_report.runs.push_back(failed_run(m_spec, point, part.reason));
            ++m_report.points.asked;
        }
        for (const CheckSpec& wanted : m_spec.checks)
            for (const SweepPoint& point : m_spec.points) {
                if (!lies_at(point, here) || !lies_at(point, wanted.at)) continue;
                report::Check check{.metric = wanted.metric, .method = wanted.method, .at = point};
                check.min = number_or_none(wanted.min);
                check.max = number_or_none(wanted.max);
                check.outcome = report::CheckOutcome::failed;
                check.reason = "the device failed: " + part.reason;
                m_report.checks.push_back(std::move(check));
            }
    }

    void compare_devices() {
        const DiffSide side{m_report, m_read_picture};
        PictureComparison pictures(side, side, {});
        const std::string& first = m_spec.devices.front();
        for (const report::Run& run : m_report.runs) {
            if (run.point.at(device_pointer) != first) continue;
            for (const Result& result : run.results) {
                report::AcrossRow row{.at = without_device(run.point), .method = result.label};
                for (const std::string& label : m_spec.devices)
                    row.devices.push_back(compare(pictures, label, run, result));
                m_report.across_devices.push_back(std::move(row));
            }
        }
    }

    /// A method's result on the device with this label, beside the one on the first device.
    report::AcrossDevice compare(PictureComparison& pictures, const std::string& label, const report::Run& first_run,
                                 const Result& first) const {
        report::AcrossDevice cell{.device = label};
        report::Point point = first_run.point;
        point[device_pointer] = label;
        const auto run = std::ranges::find(m_report.runs, point, &report::Run::point);
        const Result* result = run == m_report.runs.end() ? nullptr : run->find(first.label);
        if (!result) {
            cell.median.reason = cell.flip.reason = "there is no result";
            return cell;
        }
        if (result->timing) {
            cell.median.value = result->timing->median;
            cell.ci95 = result->timing->ci95;
        } else {
            cell.median.reason = result->reason;
        }
        if (label == m_spec.devices.front()) return cell;
        const std::array<int, 2> size_px = picture_size_px(m_report, point);
        const auto difference = pictures.compare(first.images, result->images, {size_px[0], size_px[1]}, "");
        if (difference && difference->flip) {
            cell.flip.value = difference->flip->mean;
            cell.differing_pixels = difference->differing_pixels;
        } else {
            cell.flip.reason = no_picture(first, *result);
        }
        return cell;
    }

    std::string no_picture(const Result& first, const Result& other) const {
        if (!first.reason.empty()) return fmt::format("no picture on {}: {}", m_spec.devices.front(), first.reason);
        return other.reason.empty() ? "it has no picture" : other.reason;
    }

    const Spec m_spec;
    const report::PictureReader& m_read_picture;
    Report m_report;
};

}  // namespace

Report join_parts(const nlohmann::json& spec, const std::vector<RenderedPart>& parts,
                  const report::PictureReader& read_picture) {
    return Joining(spec, read_picture).join(parts);
}

}  // namespace sheer
