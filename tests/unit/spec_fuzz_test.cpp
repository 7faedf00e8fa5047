// Random specs: each is read or refused, and nothing else happens.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "renderer/spec/spec.h"
#include "tests/source_folder.h"

namespace sheer::spec_fuzz_test {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// The ready-made specs, and one with every method for each scene.
std::vector<json> seeds() {
    std::vector<json> all;
    for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(source_folder()) / "configs/specs"))
        if (entry.path().extension() == ".json") all.push_back(json::parse(std::ifstream(entry.path())));
    json methods = json::array();
    for (const json& method : describe_methods()) methods.push_back({{"id", method["id"]}});
    for (const json& scene : describe_scenes())
        all.push_back({{"scene", {{"type", scene["id"]}}},
                       {"methods", methods},
                       {"sweep", {{{"pointer", "/image/width"}, {"values", {8, 16}}}}}});
    return all;
}

class Mutator {
  public:
    explicit Mutator(unsigned seed) : m_random(seed) {}

    json change(json document) {
        for (std::size_t i = 0, count = 1 + below(3); i < count; ++i) {
            std::vector<std::string> places;
            collect(document, "", places);
            const json::json_pointer place(places[below(places.size())]);
            json& value = document[place];
            switch (below(6)) {
                case 0:
                    value = document[json::json_pointer(places[below(places.size())])];
                    break;
                case 1:
                    if (value.is_object()) value["unknown"] = something();
                    if (value.is_array()) value.push_back(value.empty() ? something() : value[below(value.size())]);
                    break;
                case 2:
                    if (value.is_object() && !value.empty()) value.erase(std::next(value.begin(), offset(value)));
                    if (value.is_array() && !value.empty()) value.erase(value.begin() + offset(value));
                    break;
                case 3:
                    if (document.is_object())
                        document["sweep"].push_back(
                            {{"pointer", places[below(places.size())]}, {"values", {something(), something()}}});
                    break;
                default:
                    value = something();
            }
            if (document.is_object() && !document["sweep"].is_array()) document.erase("sweep");
        }
        return document;
    }

    /// The same for the bytes.
    std::string scratch(std::string text) {
        for (std::size_t i = 0, count = 1 + below(3); i < count && !text.empty(); ++i) {
            const std::size_t at = below(text.size());
            switch (below(4)) {
                case 0:
                    text[at] = static_cast<char>(below(256));
                    break;
                case 1:
                    text.erase(at, 1 + below(8));
                    break;
                case 2:
                    text.insert(at, text.substr(below(text.size()), below(40)));
                    break;
                default:
                    text.resize(at);
            }
        }
        return text;
    }

    std::size_t below(std::size_t end) { return m_random() % end; }

  private:
    std::ptrdiff_t offset(const json& value) { return static_cast<std::ptrdiff_t>(below(value.size())); }

    static void collect(const json& value, const std::string& pointer, std::vector<std::string>& places) {
        places.push_back(pointer);
        if (value.is_object())
            for (const auto& [key, inner] : value.items())
                if (key.find_first_of("/~") == std::string::npos) collect(inner, pointer + "/" + key, places);
        if (value.is_array())
            for (std::size_t i = 0; i < value.size(); ++i) collect(value[i], pointer + "/" + std::to_string(i), places);
    }

    json something() {
        static const std::vector<json> values = {nullptr,
                                                 true,
                                                 0,
                                                 1,
                                                 -1,
                                                 0.5,
                                                 1e308,
                                                 -1e-320,
                                                 4294967296,
                                                 9007199254740993,
                                                 std::numeric_limits<std::int64_t>::min(),
                                                 std::numeric_limits<std::uint64_t>::max(),
                                                 "",
                                                 "b2f",
                                                 "constant",
                                                 std::string(300, 'x'),
                                                 "\xf0\x9f\x8c\xbf/~0",
                                                 json::array(),
                                                 json::array({1, 2, 3}),
                                                 json::array({json::array()}),
                                                 json::object(),
                                                 {{"glsl", "return vec4(1); /*"}},
                                                 {{"glsl", 1}},
                                                 {{"id", "f2bd"}, {"threshold", "x"}},
                                                 {{"a", {{"b", {{"c", nullptr}}}}}}};
        return values[below(values.size())];
    }

    std::mt19937 m_random;
};

TEST(SpecFuzz, AMutatedSpecIsReadOrRefused) {
    const std::vector<json> all = seeds();
    ASSERT_GT(all.size(), 5u);
    Mutator mutator(20'240'501);
    int taken = 0, refused = 0;
    for (int i = 0; i < 5000; ++i) {
        const json document = mutator.change(all[mutator.below(all.size())]);
        try {
            const Spec spec = parse_spec(document);
            EXPECT_FALSE(spec.methods.empty());
            EXPECT_EQ(parse_spec(spec.normalised).normalised, spec.normalised) << document.dump();
            ++taken;
        } catch (const SpecError& error) {
            EXPECT_FALSE(error.errors().empty());
            EXPECT_LE(error.errors().size(), max_told_errors);
            ++refused;
        } catch (const std::exception& error) {
            ADD_FAILURE() << error.what() << "\n" << document.dump();
        }
    }
    // Otherwise the test would not try specs.
    EXPECT_GT(taken, 100);
    EXPECT_GT(refused, 1000);
}

TEST(SpecFuzz, AMutatedTextIsReadOrRefused) {
    const std::vector<json> all = seeds();
    Mutator mutator(7);
    for (int i = 0; i < 1000; ++i) {
        const std::string text = mutator.scratch(all[mutator.below(all.size())].dump(1));
        try {
            parse_spec_text(text);
        } catch (const SpecError&) {
        } catch (const std::exception& error) {
            ADD_FAILURE() << error.what() << "\n" << text;
        }
    }
}

TEST(SpecFuzz, EveryFieldRefusesEveryWrongTypeAtItsPlace) {
    const std::vector<json> values = {nullptr, true, 1, "x", json::array({nullptr}), {{"x", 1}}};
    for (const char* pointer : {"/title",
                                "/tags",
                                "/image",
                                "/image/width",
                                "/image/background",
                                "/scene",
                                "/scene/layers",
                                "/scene/layers/0",
                                "/scene/layers/0/rect",
                                "/scene/shading",
                                "/scene/texture",
                                "/methods",
                                "/methods/0",
                                "/reference",
                                "/baseline",
                                "/timing",
                                "/timing/rounds",
                                "/suite",
                                "/sweep",
                                "/checks",
                                "/checks/0",
                                "/checks/0/at"}) {
        for (const json& value : values) {
            json document = {{"image", {{"width", 8}}},
                             {"scene", {{"type", "layers"}, {"layers", {{{"depth", 0.5}}}}}},
                             {"methods", {{{"id", "b2f"}}}},
                             {"checks", {{{"metric", "rmse"}, {"method", "b2f"}, {"max", 1}}}}};
            document[json::json_pointer(pointer)] = value;
            try {
                parse_spec(document);
            } catch (const SpecError& error) {
                bool named = false;
                for (const FieldError& field : error.errors()) named |= field.pointer.starts_with(pointer);
                // A reference or check that names a removed method is an error too, and may be the only one.
                EXPECT_TRUE(named || std::string(pointer).starts_with("/methods")) << error.what() << value;
            } catch (const std::exception& error) {
                ADD_FAILURE() << pointer << " " << value << ": " << error.what();
            }
        }
    }
}

}  // namespace

}  // namespace sheer::spec_fuzz_test
