#pragma once
#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/errors.h"
#include "renderer/spec/sweep.h"

namespace sheer {

/// What the methods blend into.
enum class PixelFormat { rgba8, rgba16f, rgba32f };
/// As a spec names it.
std::string to_string(PixelFormat format);

struct ImageSpec {
    int width_px = 512;
    int height_px = 512;
    std::array<float, 3> background{};  ///< 0..1
    PixelFormat format = PixelFormat::rgba8;
};

/// A method with its parameters, normalised: every parameter is there.
struct MethodSpec {
    std::string id;
    std::string label;  ///< unique in the spec
    nlohmann::json parameters;
};

struct TimingSpec {
    int warmup = 1;
    int rounds = 10;
    double max_seconds = 60;  ///< no new round is begun after this
};

struct CheckSpec {
    std::string metric;  ///< "flip.mean", "rmse", "speedup", ...
    std::string method;  ///< label
    nlohmann::json min = nullptr, max = nullptr;
    SweepPoint at;  ///< holds only where a point of the sweep has these values; {}: everywhere
};

/// A comparison to make, valid and with defaults filled in.
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
    std::string suite;               ///< id of the suite that it measures, or ""
    std::vector<SweepPoint> points;  ///< at least one
    nlohmann::json normalised;       ///< the whole as JSON; parsing it gives the same spec

    /// SHA-256 is over this text: keys sorted, no spaces.
    std::string canonical_text() const { return normalised.dump(); }
};

struct AssetReference;
/// What is wrong with a file that a spec refers to, as a sentence on its field; "" for nothing.
using AssetRule = std::function<std::string(const AssetReference& reference)>;

/// Throws SpecError with every wrong field, those that `rule` objects to among them.
Spec parse_spec(const nlohmann::json& document, const AssetRule& rule = {});
/// The same from text; text that is not JSON gives one error at pointer "" that says where it breaks, an object that
/// has a key twice one at that key.
Spec parse_spec_text(const std::string& text);

/// The spec of one point of its sweep, without sweep and checks.
Spec spec_at(const Spec& spec, const SweepPoint& point);

/// JSON schema (draft 7) of a spec, made from the descriptions of methods and scenes.
nlohmann::json spec_schema();
/// The fields of a spec as to_json() gives them. What scene, methods and reference hold is described with these.
nlohmann::json describe_spec_fields();

/// What `GET /methods` and `GET /scenes` answer: an array of self-descriptions with `parameters`.
nlohmann::json describe_methods();
nlohmann::json describe_scenes();
/// Every metric and its fields, for the page's captions.
nlohmann::json describe_metrics();

}  // namespace sheer
