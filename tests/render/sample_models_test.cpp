// Models like those in the glTF sample collections, written by the tests: what must be visible where.
#include "tests/unit/sample_models.h"

#include "renderer/assets/read_model.h"
#include "renderer/core/random.h"
#include "tests/render/render_test.h"

namespace sheer::test::sample_models_test {

namespace {

/// Reads a file in memory, whatever the name.
class ModelBytes : public AssetReader {
  public:
    explicit ModelBytes(std::string bytes) : m_bytes(std::move(bytes)) {}
    Picture picture(const std::string&, int, int) override { throw AssetError("no pictures here"); }
    Volume volume(const std::string&, const VolumeOptions&) override { throw AssetError("no volumes here"); }
    Model model(const std::string&) override { return read_model(m_bytes, no_other_files); }

  private:
    std::string m_bytes;
};

Spec spec_of(const SampleModel& sample, const nlohmann::json& methods) {
    nlohmann::json scene = sample_scene();
    scene["type"] = "gltf";
    scene["model"] = "the one";
    scene.update(sample.scene);
    const Spec spec = make_spec(scene, methods, sample_size_px, "rgba32f");
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(spec.image.background[i], sample_background[i], 1e-6);
    return spec;
}

std::string bytes_of(const SampleModel& sample) {
    GlbWriter writer;
    sample.make(writer);
    return writer.glb();
}

/// They share a context, which takes longer to make than a picture.
class SampleModels : public testing::TestWithParam<SampleModel> {
  protected:
    static void SetUpTestSuite() { s_context = make_context("egl"); }
    static void TearDownTestSuite() { s_context.reset(); }

    static Image draw(const Spec& spec, const std::string& bytes) {
        Stage stage(*s_context, spec, spec.image.format, std::make_unique<ModelBytes>(bytes));
        return stage.picture(spec.methods[0]);
    }

    static std::unique_ptr<gl::Context> s_context;
};

std::unique_ptr<gl::Context> SampleModels::s_context;

TEST_P(SampleModels, ShowWhatIsExpected) {
    const SampleModel& sample = GetParam();
    for (const char* method : {"b2f", "depth_peeling"}) {
        SCOPED_TRACE(method);
        const Image image = draw(spec_of(sample, {method}), bytes_of(sample));
        for (const ExpectedPixel& expected : sample.expected)
            for (std::size_t channel = 0; channel < 3; ++channel)
                EXPECT_NEAR(image.pixel(expected.x_px, expected.y_px)[channel], expected.color[channel],
                            sample.tolerance)
                    << "pixel " << expected.x_px << ", " << expected.y_px << ", channel " << channel;
    }
}

INSTANTIATE_TEST_SUITE_P(All, SampleModels, testing::ValuesIn(sample_models()),
                         [](const testing::TestParamInfo<SampleModel>& row) { return row.param.name; });

/// Changes a few numbers of its JSON or bytes of its data, so that much of it can still be read.
std::string changed(std::string bytes, Random& random) {
    const std::size_t data = bytes.rfind(std::string_view("BIN\0", 4)) + 4;
    for (std::uint64_t changes = 1 + random.below(3); changes > 0;) {
        const bool in_data = random.below(2) == 0;
        const std::size_t at = in_data ? data + random.below(bytes.size() - data) : 20 + random.below(data - 20);
        if (!in_data && (bytes[at] < '0' || bytes[at] > '9')) continue;
        bytes[at] = in_data ? static_cast<char>(random.below(256)) : "0123456789"[random.below(10)];
        --changes;
    }
    return bytes;
}

/// The model is refused, or drawn in finite colors without a device error; and not all of them are refused.
using MutatedModels = SampleModels;
TEST_P(MutatedModels, AreRefusedOrDrawn) {
    Random random(std::hash<std::string>()(GetParam().name));
    const std::string good = bytes_of(GetParam());
    const Spec spec = spec_of(GetParam(), {"b2f"});
    for (int i = 0; i < 6; ++i) {
        try {
            const Image image = draw(spec, changed(good, random));
            for (const float value : image.rgba) ASSERT_TRUE(value >= 0 && value <= 1) << i;
        } catch (const SpecError& error) {
            ASSERT_EQ(error.errors().size(), 1u);
            EXPECT_EQ(error.errors()[0].pointer, "/scene/model");
            EXPECT_FALSE(error.errors()[0].detail.empty());
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, MutatedModels, testing::ValuesIn(sample_models()),
                         [](const testing::TestParamInfo<SampleModel>& row) { return row.param.name; });

}  // namespace

}  // namespace sheer::test::sample_models_test
