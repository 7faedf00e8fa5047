#include "renderer/spec/spec.h"

#include "tests/fuzz/target.h"

namespace sheer::test {

namespace {

/// A spec in its normal form stays as it is.
void read_spec(std::string_view input) {
    try {
        const Spec spec = parse_spec_text(std::string(input));
        require(!spec.methods.empty() && !spec.points.empty(), "a spec without methods or points");
        require(parse_spec(spec.normalised).normalised == spec.normalised, "a normal form that is not normal");
    } catch (const SpecError& error) {
        require(!error.errors().empty() && error.errors().size() <= max_told_errors, "no errors, or too many");
    }
}

}  // namespace

FuzzTarget fuzz_spec() {
    return {"spec", read_spec};
}

}  // namespace sheer::test
