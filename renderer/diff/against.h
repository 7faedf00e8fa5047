#pragma once
#include <string>
#include <vector>

#include "renderer/diff/diff.h"

namespace sheer {

/// An accepted report with which another one may be compared.
struct Accepted {
    report::Report report;
    std::string baseline;     ///< the name under which it was accepted; "" if the spec names the report itself
    std::string accepted_at;  ///< UTC, RFC 3339; "" likewise
    std::string by;           ///< who accepted it; may be empty
    std::string age;          ///< such as "2 days"
};

/// Why a report cannot be compared with `before`, as a sentence; "" if it can. `differing` gets the pointers of the
/// fields that differ although the spec's `under_test` does not list them.
std::string why_not_against(const report::Report& before, const report::Report& now,
                            std::vector<std::string>& differing);

/// Compares a finished report that has an `against` with the first of `accepted`, which are in order of preference,
/// that was made by the same device and from the same spec except for `under_test`. Fills in the report's `against`,
/// adds its checks, and judges it again. Without any such report a check fails and says why. The readers give the
/// pictures of this report and of accepted ones.
void compare_against(report::Report& now, const std::vector<Accepted>& accepted,
                     const report::PictureReader& read_picture, const report::PictureReader& read_accepted);

}  // namespace sheer
