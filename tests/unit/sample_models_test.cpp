// Reads the sample models, under the sanitizers: as they are, truncated and changed.
#include "tests/unit/sample_models.h"

#include <gtest/gtest.h>

#include "renderer/assets/read_model.h"
#include "renderer/core/random.h"

namespace sheer::test::sample_models_read_test {

namespace {

std::string file_of(const SampleModel& sample) {
    GlbWriter writer;
    sample.make(writer);
    return writer.glb();
}

/// "" if it can be read.
std::string refusal_of(const std::string& bytes) {
    try {
        read_model(bytes, no_other_files);
    } catch (const AssetError& error) {
        return error.what();
    }
    return "";
}

TEST(SampleModels, AreRead) {
    EXPECT_GE(sample_models().size(), 50u);
    for (const SampleModel& sample : sample_models()) EXPECT_EQ(refusal_of(file_of(sample)), "") << sample.name;
}

TEST(SampleModels, ChangedOnesAreReadOrRefused) {
    Random random(7);
    int refused = 0, tried = 0;
    for (const SampleModel& sample : sample_models()) {
        const std::string good = file_of(sample);
        for (int i = 0; i < 12; ++i, ++tried) {
            std::string bytes = good;
            for (std::uint64_t changes = 1 + random.below(6); changes > 0; --changes) {
                const std::size_t at = random.below(bytes.size());
                const std::uint64_t kind = random.below(3);
                if (kind == 0) bytes[at] = static_cast<char>(random.below(256));
                if (kind == 1) bytes[at] = "0123456789-[]{},\":e."[random.below(20)];
                if (kind == 2) bytes[at] = static_cast<char>(bytes[at] ^ 1 << random.below(8));
            }
            refused += !refusal_of(bytes).empty();
        }
    }
    EXPECT_GT(refused, tried / 10);
    EXPECT_LT(refused, tried);
}

}  // namespace

}  // namespace sheer::test::sample_models_read_test
