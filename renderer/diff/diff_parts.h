#pragma once
#include <string>
#include <vector>

#include "renderer/diff/diff.h"

namespace sheer {

/// A field whose value differs between two reports.
struct FieldDifference : diff::Difference {
    bool is_in_both = true;  ///< otherwise only one of them has it
};

/// The differing fields of spec, device and provenance, and the differing files of the scenes, each as a whole entry of
/// `files`; methods are matched by label.
std::vector<FieldDifference> report_differences(const report::Report& a, const report::Report& b);

/// Throws DiffConflict if the two specs describe different pictures, and marks the differences that `allow` allows. A
/// field that only one spec has, such as a parameter that is newer than the other report, is not a conflict. Sizes
/// cannot be allowed to differ. Throws SpecError if one of `allow` is not a JSON pointer.
void check_specs(const report::Report& a, const report::Report& b, const std::vector<std::string>& allow,
                 std::vector<FieldDifference>& differences);

/// The labels of the methods of its spec.
std::vector<std::string> method_labels(const report::Report& report);

/// Whether both were rendered by the same renderer on the same kind of processor.
bool is_same_device(const report::Report& a, const report::Report& b);

/// A run that both reports have.
struct RunPair {
    const report::Run &a, &b;
    std::string baseline_a, baseline_b;
    bool same_device = true;
    std::size_t compared = 1;  ///< methods that ran in both
};

/// How the time of a method that ran in both changed; none if one of the results has no times.
std::optional<diff::TimeDiff> time_diff(const RunPair& run, const report::Result& a, const report::Result& b);

/// Compares pictures of two reports.
class PictureComparison {
  public:
    /// References must outlive it.
    PictureComparison(const DiffSide& a, const DiffSide& b, const DiffOptions& options)
        : m_a(a), m_b(b), m_sink(options.pictures), m_pixels_left(options.max_pixels) {}
    /// `a` and `b` are the `images` of one method in the two reports; `name` is for the file of the FLIP map. None if
    /// one of them has no picture.
    std::optional<diff::PictureDiff> compare(const report::Pictures& a, const report::Pictures& b, diff::Size size_px,
                                             const std::string& name);

  private:
    void examine(diff::PictureDiff& result, diff::Size size_px, const std::string& name);

    const DiffSide& m_a;
    const DiffSide& m_b;
    BlobSink* m_sink;
    std::uint64_t m_pixels_left;
};

}  // namespace sheer
