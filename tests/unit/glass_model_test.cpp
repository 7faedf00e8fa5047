// The model of the ready-made comparison configs/specs/glass.json is the one that its generator makes.
#include "tests/unit/glass_model.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "renderer/assets/read_model.h"
#include "tests/source_folder.h"

namespace sheer::test::glass_model_test {

namespace {

const std::string path = source_folder() + std::string("/configs/specs/glass.glb");

/// Rewrites the file: unit_tests --gtest_also_run_disabled_tests --gtest_filter=GlassModel.DISABLED_Write
TEST(GlassModel, DISABLED_Write) {
    std::ofstream file(path, std::ios::binary);
    file << make_glass_model();
    ASSERT_TRUE(file.flush());
}

TEST(GlassModel, IsMadeByItsGenerator) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream bytes;
    bytes << file.rdbuf();
    ASSERT_TRUE(file) << "cannot read " << path;
    EXPECT_TRUE(bytes.str() == make_glass_model()) << path << " differs from the result of make_glass_model";
    EXPECT_LT(bytes.str().size(), 100000u);
}

TEST(GlassModel, HasEveryKindOfSurface) {
    const Model model = read_model(make_glass_model(), no_other_files);
    std::size_t kinds[3] = {};
    for (const ModelPart& part : model.parts) ++kinds[static_cast<int>(model.materials[part.material].alpha)];
    EXPECT_EQ(kinds[static_cast<int>(Material::Alpha::opaque)], 3u);
    EXPECT_EQ(kinds[static_cast<int>(Material::Alpha::mask)], 1u);
    EXPECT_EQ(kinds[static_cast<int>(Material::Alpha::blend)], 6u);
}

}  // namespace

}  // namespace sheer::test::glass_model_test
