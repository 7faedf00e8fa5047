#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "renderer/core/errors.h"
#include "renderer/pictures/blob_sink.h"
#include "renderer/results/diff_types.h"
#include "renderer/results/report.h"

namespace sheer {

/// One of two reports that are compared with each other.
struct DiffSide {
    const report::Report& report;
    report::PictureReader read_picture;
};

struct DiffOptions {
    BlobSink* pictures = nullptr;    ///< takes the FLIP maps; null: none are made
    std::optional<std::size_t> run;  ///< only this one of the common runs, from 0
    /// Limit on decoded pixels; further pictures are "not examined".
    std::uint64_t max_pixels = std::numeric_limits<std::uint64_t>::max();
    /// JSON pointers into the spec, such as /scene/shading/glsl; methods are counted as in the first report. The fields
    /// there and everything below may differ between the two specs.
    std::vector<std::string> allow;
};

/// The two specs describe different pictures.
class DiffConflict : public SpecError {
  public:
    DiffConflict(std::vector<FieldError> errors, std::vector<std::string> allowable)
        : SpecError(std::move(errors)), m_allowable(std::move(allowable)) {}
    /// Pointers that would have to be allowed for the reports to be compared; empty if allowing would not help.
    const std::vector<std::string>& allowable() const { return m_allowable; }

  private:
    std::vector<std::string> m_allowable;
};

/// What changed from report `a` to report `b` of one spec, in pictures and in time; docs/measuring.md says how times
/// are judged. Runs are matched by their points, methods by their labels. Throws DiffConflict with every field, by JSON
/// pointer, if the two specs describe different pictures and `options.allow` does not allow it; SpecError if a report
/// is not done, there is no such run or one of `options.allow` is not a JSON pointer; DocumentError or nlohmann's
/// exceptions if the spec of a report is not one: check_comparable() finds that.
diff::Diff diff_reports(const DiffSide& a, const DiffSide& b, const DiffOptions& options = {});

/// How much worse a report may be than the one before it.
struct DiffTolerance {
    double max_flip = 0;      ///< mean FLIP error of a picture that differs, 0..1
    double max_slowdown = 1;  ///< a method's time over its time before, at least 1
};

/// A sentence for each change for the worse: a picture that differs by more than the tolerance, a status that changed,
/// a method that is resolved to be slower by more than the tolerance, which means that its whole interval is.
std::vector<std::string> changes_for_the_worse(const diff::Diff& diff, const DiffTolerance& tolerance = {});

/// A table for the terminal, with a line for each method.
std::string diff_table(const diff::Diff& diff);

}  // namespace sheer
