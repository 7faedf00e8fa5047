#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/core/errors.h"
#include "renderer/image/image_spec.h"
#include "renderer/spec/sweep.h"

namespace sheer {

/// A method with its normalised parameters: every parameter is present.
struct MethodSpec {
    std::string id;
    std::string label;  ///< unique in the spec
    nlohmann::json parameters;
    /// Its look: the `shading` and the `texture` with which it draws the scene, instead of the scene's own; {}: none.
    nlohmann::json look = nlohmann::json::object();
    std::string pointer;  ///< in the spec
};

struct TimingSpec {
    int warmup = 1;
    int rounds = 10;
    double max_seconds = 60;  ///< no new round begins after this
};

struct CheckSpec {
    std::string metric;  ///< "flip.mean", "rmse", "speedup", ...
    std::string method;  ///< label
    nlohmann::json min = nullptr, max = nullptr;
    SweepPoint at;  ///< applies only to points of the sweep that have these values; {}: to all
};

/// A valid comparison to make, with defaults filled in.
struct Spec {
    std::string title;
    ImageSpec image;
    std::string scene_type;
    nlohmann::json scene;  ///< its parameters, normalised, with `type`
    std::vector<MethodSpec> methods;
    MethodSpec reference;
    std::string baseline;  ///< label of one of `methods`
    TimingSpec timing;
    std::vector<CheckSpec> checks;
    std::string against;               ///< "baseline:NAME" or a report's id, with which the report is compared; or ""
    std::string suite;                 ///< id of the suite that it repeats, or ""
    std::vector<std::string> devices;  ///< labels, if it lists several; each point has one at `device_pointer`
    std::vector<SweepPoint> points;    ///< at least one
    nlohmann::json normalised;         ///< the whole spec as JSON; parsing it gives the same spec

    /// The text of which the SHA-256 is taken: keys sorted, no spaces.
    std::string canonical_text() const { return normalised.dump(); }
};

struct AssetReference;
/// What is wrong with a file that a spec refers to, as a sentence about its field; "" if nothing is.
using AssetRule = std::function<std::string(const AssetReference& reference)>;

/// Throws SpecError with every wrong field, including those that `rule` rejects.
Spec parse_spec(const nlohmann::json& document, const AssetRule& rule = {});
/// The same from text. Text that is not JSON gives one error, at pointer "", with the position; an object that has a
/// key twice gives one at that key.
Spec parse_spec_text(const std::string& text);

/// What one of several devices renders: the spec with its label alone, and the checks that apply to it.
nlohmann::json spec_of_device(nlohmann::json normalised, const std::string& device);
/// The spec of one point of its sweep, without sweep and checks.
Spec spec_at(const Spec& spec, const SweepPoint& point);

/// JSON schema of a spec, for draft 7 and all later ones, made from the descriptions of methods and scenes.
nlohmann::json spec_schema();
/// The schema of Spec::normalised.
nlohmann::json normalised_spec_schema();
/// The fields of a spec as to_json() gives them. The contents of scene, methods and reference are described separately.
nlohmann::json describe_spec_fields();

/// What `GET /methods` and `GET /scenes` answer: arrays of catalog::Method and catalog::Scene.
nlohmann::json describe_methods();
nlohmann::json describe_scenes();
/// Every metric and its fields: an array of catalog::Metric.
nlohmann::json describe_metrics();

}  // namespace sheer
