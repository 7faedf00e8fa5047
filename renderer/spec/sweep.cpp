#include "renderer/spec/sweep.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace sheer {

using nlohmann::json;

namespace {

// Limit for all points together, which are kept in memory: some tens of megabytes.
constexpr std::size_t max_points_weight = 500'000;

constexpr const char* shape = "must be an object with a pointer and an array of values, or with an array of points";

/// What a sweep may change: only parameters of the rendering.
bool is_parameter(const std::string& pointer) {
    if (pointer == "/scene/type" || pointer.ends_with("/id") || pointer.ends_with("/label")) return false;
    return pointer.starts_with("/scene/") || pointer.starts_with("/image/") || pointer.starts_with("/methods/");
}

/// The one of `fields` that equals `field`, contains it or is a part of it; "" for none. Well-formed pointers have one
/// spelling for each field.
std::string overlapping(const std::set<std::string>& fields, const std::string& field) {
    for (std::size_t end = field.find('/', 1); end != std::string::npos; end = field.find('/', end + 1))
        if (fields.contains(field.substr(0, end))) return field.substr(0, end);
    if (fields.contains(field)) return field;
    const auto part = fields.lower_bound(field + "/");
    return part != fields.end() && part->starts_with(field + "/") ? *part : std::string();
}

std::size_t json_weight_of(const std::vector<SweepPoint>& points) {
    std::size_t weight = 0;
    for (const SweepPoint& point : points) weight += json_weight(point);
    return weight;
}

class SweepReader {
  public:
    SweepReader(const json& document, std::vector<FieldError>& errors) : m_document(document), m_errors(errors) {}

    std::vector<SweepPoint> read(const json& sweep) {
        std::vector<SweepPoint> points = {json::object()};
        if (!sweep.is_array() || sweep.size() > max_sweeps) {
            error("/sweep", fmt::format("must be an array of at most {} axes", max_sweeps));
            return points;
        }
        for (std::size_t i = 0; i < sweep.size(); ++i) {
            const std::vector<SweepPoint> axis = read_axis(sweep[i], fmt::format("/sweep/{}", i));
            m_taken.merge(m_taken_here);
            m_taken_here.clear();
            if (points.size() * axis.size() > max_sweep_points) {
                error("/sweep", fmt::format("must have at most {} points in all", max_sweep_points));
                return {json::object()};
            }
            if (json_weight_of(points) * axis.size() + json_weight_of(axis) * points.size() > max_points_weight) {
                error("/sweep", "must not repeat such large values at so many points");
                return {json::object()};
            }
            points = product(points, axis);
        }
        return points;
    }

  private:
    void error(const std::string& pointer, const std::string& detail) {
        add_error(m_errors, pointer, [&] { return detail; });
    }

    static std::vector<SweepPoint> product(const std::vector<SweepPoint>& slow, const std::vector<SweepPoint>& fast) {
        std::vector<SweepPoint> all;
        for (const SweepPoint& a : slow) {
            for (const SweepPoint& b : fast) {
                all.push_back(a);
                all.back().update(b);
            }
        }
        return all;
    }

    /// Never empty, so that a wrong axis does not hide the others' errors.
    std::vector<SweepPoint> read_axis(const json& axis, const std::string& pointer) {
        std::vector<SweepPoint> points;
        const bool single = axis.is_object() && axis.size() == 2 && axis.contains("pointer") &&
                            axis["pointer"].is_string() && axis.contains("values") && axis["values"].is_array();
        const bool several =
            axis.is_object() && axis.size() == 1 && axis.contains("points") && axis["points"].is_array();
        if (single) {
            const auto field = axis["pointer"].get<std::string>();
            if (check_field(field, pointer + "/pointer"))
                for (const json& value : axis["values"]) points.push_back({{field, value}});
            if (axis["values"].empty()) error(pointer + "/values", "must not be empty");
        } else if (several) {
            for (std::size_t i = 0; i < axis["points"].size(); ++i)
                read_point(axis["points"][i], fmt::format("{}/points/{}", pointer, i), points);
            if (axis["points"].empty()) error(pointer + "/points", "must not be empty");
        } else {
            error(pointer, shape);
        }
        if (points.empty()) points.push_back(json::object());
        return points;
    }

    void read_point(const json& point, const std::string& pointer, std::vector<SweepPoint>& points) {
        if (!point.is_object() || point.empty()) return error(pointer, "must be an object of values by their pointers");
        bool right = true;
        std::set<std::string> own;
        for (const auto& [field, value] : point.items()) {
            right = check_field(field, pointer) && right;
            if (const std::string other = overlapping(own, field); !other.empty()) {
                error(pointer, fmt::format("\"{}\" overlaps \"{}\"", field, other));
                right = false;
            }
            own.insert(field);
        }
        if (right) points.push_back(point);
    }

    bool check_field(const std::string& field, const std::string& pointer) {
        std::string detail;
        if (!is_parameter(field)) {
            detail = "must point to a parameter in /scene, /image or /methods/N";
        } else if (const std::string taken = overlapping(m_taken, field); !taken.empty()) {
            detail =
                taken == field ? "is swept already" : fmt::format("overlaps \"{}\", which is swept already", taken);
        } else {
            try {
                if (!m_document.contains(json::json_pointer(field))) detail = "there is no such field";
            } catch (const json::exception&) {
                detail = "is not a JSON pointer (RFC 6901)";
            }
        }
        if (detail.empty()) m_taken_here.insert(field);
        if (!detail.empty()) error(pointer, fmt::format("\"{}\" {}", field, detail));
        return detail.empty();
    }

    const json& m_document;
    std::vector<FieldError>& m_errors;
    std::set<std::string> m_taken;       ///< by the previous axes
    std::set<std::string> m_taken_here;  ///< by this axis, each of whose points may set the same field
};

}  // namespace

std::vector<SweepPoint> read_sweep(const json& sweep, const json& document, std::vector<FieldError>& errors) {
    return SweepReader(document, errors).read(sweep);
}

std::string sweep_pointer(const json& sweep, const std::string& field_pointer) {
    for (std::size_t i = 0; i < sweep.size(); ++i) {
        const json& axis = sweep[i];
        const auto reaches = [&](const std::string& field) { return field_pointer.starts_with(field); };
        if (axis.contains("pointer") && reaches(axis["pointer"].get_ref<const std::string&>()))
            return fmt::format("/sweep/{}", i);
        for (const json& point : axis.value("points", json::array()))
            for (const auto& [field, value] : point.items())
                if (reaches(field)) return fmt::format("/sweep/{}", i);
    }
    return "/sweep";
}

std::string describe_point(const SweepPoint& point) {
    std::string text;
    for (const auto& [field, value] : point.items()) {
        const std::string shown = value.is_string() ? value.get<std::string>() : value.dump();
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", field.substr(field.rfind('/') + 1), shown);
    }
    return text;
}

std::size_t json_weight(const json& value) {
    if (value.is_string()) return 1 + value.get_ref<const std::string&>().size() / 32;
    std::size_t weight = 1;
    if (value.is_structured())
        for (const json& inner : value) weight += json_weight(inner);
    return weight;
}

bool lies_at(const SweepPoint& point, const json& at) {
    for (const auto& [field, value] : at.items())
        if (!point.contains(field) || point[field] != value) return false;
    return true;
}

json at_point(json document, const SweepPoint& point) {
    document.erase("sweep");
    document.erase("checks");
    for (const auto& [field, value] : point.items()) document[json::json_pointer(field)] = value;
    return document;
}

}  // namespace sheer
