// How every store handles uploaded files.
#include <gmock/gmock.h>

#include "store_fixture.h"

namespace sheer::test::asset_store_test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using Removal = ReportArchive::Removal;

class AssetsTest : public StoreTest {
  protected:
    std::vector<std::string> names() {
        std::vector<std::string> all;
        for (const Asset& asset : m_assets.list(2)) all.push_back(asset.name);
        return all;
    }
};

TEST_P(AssetsTest, AnAssetIsStoredOnceWithItsBytes) {
    const std::string sha256 = add_asset("first");
    const std::int64_t created_ms = m_now_ms;
    add_asset("first");
    const auto asset = m_assets.find(sha256);
    ASSERT_TRUE(asset);
    EXPECT_EQ(asset->type, "texture");
    EXPECT_EQ(asset->media_type, "image/png");
    EXPECT_EQ(asset->size_bytes, 5);
    EXPECT_EQ(asset->created_ms, created_ms);
    EXPECT_EQ(asset->facts, (json{{"width", 7}}));
    EXPECT_EQ(upload(sha256), "first");
    EXPECT_EQ(asset->broken, "");
    EXPECT_FALSE(m_assets.find(sha256_hex("other")));
    EXPECT_FALSE(m_blobs.open(sha256));
}

TEST_P(AssetsTest, TheListIsNewestFirst) {
    for (const char* bytes : {"a", "b", "c"}) add_asset(bytes);
    EXPECT_THAT(names(), ElementsAre("name of c", "name of b"));
}

TEST_P(AssetsTest, AnAssetInUseIsNotRemoved) {
    const std::string sha256 = add_asset("first"), other = add_asset("second");
    const std::string id = submit("title", {{"scene", {{"type", "quads"}, {"texture", {{"image", sha256}}}}}});
    EXPECT_EQ(m_assets.remove(sha256), Assets::Removal::in_use);
    const Lease job = lease();
    EXPECT_EQ(m_assets.remove(sha256), Assets::Removal::in_use);
    EXPECT_EQ(m_assets.remove(other), Assets::Removal::removed);
    EXPECT_TRUE(m_queue.commit(job, finished(job, "picture")));
    EXPECT_EQ(m_assets.remove(sha256), Assets::Removal::removed);
    EXPECT_EQ(m_assets.remove(sha256), Assets::Removal::not_found);
    EXPECT_EQ(status(id), Status::done);
}

TEST_P(AssetsTest, DeletingReportsLeavesAssetsAlone) {
    const std::string sha256 = add_asset("picture");
    const std::string id = make_done("title", "picture");
    EXPECT_EQ(m_reports.remove(id), Removal::deleted);
    EXPECT_FALSE(m_blobs.open(sha256));
    EXPECT_EQ(upload(sha256), "picture");
}

INSTANTIATE_TEST_SUITE_P(Stores, AssetsTest, every_store, store_name);

}  // namespace
}  // namespace sheer::test::asset_store_test
