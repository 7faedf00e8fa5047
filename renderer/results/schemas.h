#pragma once
#include "renderer/params/described.h"

namespace sheer {

// Schemas of parts that are described elsewhere.

/// The parameters of a method: every parameter of any method, as the method describes it.
nlohmann::json parameters_schema(SchemaBook& book);
/// Values that only one method reports.
nlohmann::json findings_schema(SchemaBook& book);
/// A point of a sweep: values by JSON pointer into the spec.
nlohmann::json point_schema(SchemaBook& book);
/// The name of the schema of a spec with its defaults filled in, which normalised_spec_schema() makes.
inline constexpr const char* normalised_spec_name = "NormalisedSpec";
nlohmann::json spec_reference(SchemaBook& book);

/// What a description says of an interval of a median.
inline constexpr const char* interval_text =
    "95 % interval of the median, [low, high]; null if there are too few samples";

}  // namespace sheer
