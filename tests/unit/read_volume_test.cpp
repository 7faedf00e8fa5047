// Volume files written by hand, byte by byte.
#include "renderer/assets/read_volume.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <bit>
#include <cmath>

namespace sheer::read_volume_test {

namespace {

using testing::ElementsAre;
using testing::FloatNear;
using testing::HasSubstr;
using testing::Pointwise;

std::string text_of(std::initializer_list<int> bytes) {
    std::string text;
    for (const int byte : bytes) text += static_cast<char>(byte);
    return text;
}

std::string gzipped(const std::string& bytes) {
    std::string packed(bytes.size() + 64, '\0');
    z_stream stream{};
    deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

std::string floats_little(std::initializer_list<float> numbers) {
    std::string bytes;
    for (const float number : numbers) {
        const auto bits = std::bit_cast<std::uint32_t>(number);
        for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(bits >> shift & 255);
    }
    return bytes;
}

std::string nrrd(const std::string& fields, const std::string& data) {
    return "NRRD0004\n" + fields + "\n" + data;
}

Volume read(const std::string& bytes) {
    return read_volume(bytes, std::nullopt);
}

TEST(Nrrd, Uint8IsKeptAsItIs) {
    const Volume volume = read(
        "NRRD0005\r\n# a comment\r\nType: unsigned char\r\ndimension: 3\r\nsizes: 2 1 3\r\nencoding: raw\r\n"
        "spacings: 0.5 1 2e0\r\nkey:=value: 3\r\nkinds: domain domain domain\r\n\r\n" +
        text_of({0, 1, 10, 128, 254, 255}));
    EXPECT_EQ(volume.size, glm::ivec3(2, 1, 3));
    EXPECT_EQ(volume.spacing, glm::dvec3(0.5, 1, 2));
    EXPECT_THAT(volume.bytes, ElementsAre(0, 1, 10, 128, 254, 255));
    EXPECT_TRUE(volume.floats.empty());
}

TEST(Nrrd, Uint16OfEitherEndIsDividedByItsGreatestValue) {
    const std::string fields = "type: ushort\ndimension: 3\nsizes: 2 2 1\nencoding: raw\nendian: ";
    const std::vector<float> expected = {0, 1, 258.0f / 65535, 513.0f / 65535};
    EXPECT_THAT(read(nrrd(fields + "little\n", text_of({0, 0, 255, 255, 2, 1, 1, 2}))).floats,
                Pointwise(FloatNear(1e-7f), expected));
    EXPECT_THAT(read(nrrd(fields + "big\n", text_of({0, 0, 255, 255, 1, 2, 2, 1}))).floats,
                Pointwise(FloatNear(1e-7f), expected));
}

/// -2, 0 and 6: the least is 0 and the greatest 1.
TEST(Nrrd, Int16GoesFromItsLeastToItsGreatest) {
    const Volume volume = read(nrrd("type: int16\ndimension: 3\nsizes: 3 1 1\nencoding: raw\nendian: big\n",
                                    text_of({0xff, 0xfe, 0, 0, 0, 6})));
    EXPECT_THAT(volume.floats, ElementsAre(0, 0.25f, 1));
}

TEST(Nrrd, FloatsInGzipGoFromTheirLeastToTheirGreatest) {
    const Volume volume =
        read(nrrd("type: float\ndimension: 3\nsizes: 1 2 2\nencoding: gzip\nendian: little\n"
                  "space: left-posterior-superior\nspace directions: (3,0,4) (0,-2,0) (0, 0, 0.25)\n",
                  gzipped(floats_little({-1, 3, 0, 1}))));
    EXPECT_THAT(volume.floats, ElementsAre(0, 1, 0.25f, 0.5f));
    // The length of (3, 0, 4) is 5.
    EXPECT_EQ(volume.spacing, glm::dvec3(5, 2, 0.25));
}

TEST(Nrrd, WhereAllFloatsAreEqualTheyAre0) {
    EXPECT_THAT(read(nrrd("type: float\ndimension: 3\nsizes: 1 1 2\nencoding: gz\nendian: little\n",
                          gzipped(floats_little({7, 7}))))
                    .floats,
                ElementsAre(0, 0));
}

TEST(Nrrd, IsDescribed) {
    const auto facts = describe_nrrd(nrrd("type: uint8\ndimension: 3\nsizes: 2 1 1\nencoding: raw\n", "ab"));
    EXPECT_EQ(facts, nlohmann::json({{"size", {2, 1, 1}},
                                     {"spacing", {1.0, 1.0, 1.0}},
                                     {"voxel", "uint8"},
                                     {"encoding", "raw"},
                                     {"notes", nlohmann::json::array()}}));
}

struct Broken {
    std::string name, bytes, reason;
};

void PrintTo(const Broken& row, std::ostream* out) {
    *out << row.name;
}

class BrokenNrrd : public testing::TestWithParam<Broken> {};

TEST_P(BrokenNrrd, IsRefusedWithTheReason) {
    for (const bool described : {false, true}) {
        try {
            described ? (void)describe_nrrd(GetParam().bytes) : (void)read(GetParam().bytes);
            FAIL() << "it is taken";
        } catch (const AssetError& error) {
            EXPECT_THAT(error.what(), HasSubstr(GetParam().reason));
        }
    }
}

/// Four uint8 voxels, with a field more or in place of the usual one.
std::string with(const std::string& name, const std::string& value, const std::string& data = "abcd") {
    std::string fields;
    bool there = false;
    for (const auto& [usual_name, usual_value] : {std::pair<std::string, std::string>{"type", "uint8"},
                                                  {"dimension", "3"},
                                                  {"sizes", "2 2 1"},
                                                  {"encoding", "raw"},
                                                  {"endian", "little"}}) {
        const bool same = name == usual_name;
        there |= same;
        if (!same || !value.empty()) fields += usual_name + ": " + (same ? value : usual_value) + "\n";
    }
    if (!there) fields += name + ": " + value + "\n";
    return nrrd(fields, data);
}

std::string cut(std::string text, std::size_t from_end) {
    text.resize(text.size() - from_end);
    return text;
}

INSTANTIATE_TEST_SUITE_P(
    All, BrokenNrrd,
    testing::Values(
        Broken{"other_file", "P6 2 2 255\n", "not an NRRD file"}, Broken{"empty", "", "not an NRRD file"},
        Broken{"endless_header", "NRRD0004\ntype: uint8\n", "has no end"},
        Broken{"huge_header", "NRRD0004\n" + std::string(100000, 'x') + "\n\n", "has no end"},
        Broken{"no_field", nrrd("type uint8\n", ""), "is no field"},
        Broken{"twice", with("sizes ", "2 2 1"), "\"sizes\" twice"},
        Broken{"detached", with("data file", "head.raw"), "another file"},
        Broken{"detached_old", with("datafile", "LIST"), "another file"},
        Broken{"skipped_lines", with("line skip", "1"), "\"lineskip\""},
        Broken{"skipped_bytes", with("byte skip", "-1"), "\"byteskip\""},
        Broken{"no_type", with("type", ""), "no field \"type\""},
        Broken{"no_sizes", with("sizes", ""), "no field \"sizes\""},
        Broken{"no_encoding", with("encoding", ""), "no field \"encoding\""},
        Broken{"doubles", with("type", "double"), "of type \"double\""},
        Broken{"ascii", with("encoding", "ascii"), "encoding \"ascii\""},
        Broken{"bzip2", with("encoding", "bzip2"), "encoding \"bzip2\""},
        Broken{"two_dimensions", with("dimension", "2"), "has 2 dimensions"},
        Broken{"four_dimensions", with("dimension", "4"), "has 4 dimensions"},
        Broken{"word_for_dimension", with("dimension", "three"), "holds \"three\""},
        Broken{"two_sizes", with("sizes", "2 2"), "three entries, not 2"},
        Broken{"fraction", with("sizes", "2 2 1.5"), "holds \"1.5\""},
        Broken{"overflow", with("sizes", "2 2 99999999999"), "holds \"99999999999\""},
        Broken{"no_voxels", with("sizes", "2 0 2"), "each side has 1 to 1024"},
        Broken{"negative", with("sizes", "2 -2 -1"), "each side has 1 to 1024"},
        Broken{"too_wide", with("sizes", "1025 1 1"), "each side has 1 to 1024"},
        Broken{"too_much", with("sizes", "1024 1024 513"), "takes 513 MiB"},
        Broken{"too_short", with("sizes", "2 2 2"), "holds 4 bytes of voxels; 2 x 2 x 2 of type uint8 are 8"},
        Broken{"too_long", with("sizes", "1 1 1"), "holds 4 bytes of voxels; 1 x 1 x 1 of type uint8 are 1"},
        Broken{"no_endian", nrrd("type: short\ndimension: 3\nsizes: 2 1 1\nencoding: raw\n", "abcd"), "\"endian\""},
        Broken{"odd_endian", nrrd("type: short\ndimension: 3\nsizes: 2 1 1\nencoding: raw\nendian: middle\n", "abcd"),
               "neither big nor little"},
        Broken{"flat", with("spacings", "1 0 1"), "\"spacings\" gives distances"},
        Broken{"not_a_number", with("spacings", "1 nan 1"), "\"spacings\" gives distances"},
        Broken{"no_direction", with("space directions", "none (0,1,0) (0,0,1)"), "three entries"},
        Broken{"direction_of_two", with("space directions", "(1,0) (0,1,0) (0,0,1)"), "three entries, not 2"},
        Broken{"no_gzip", with("encoding", "gzip"), "damaged"},
        Broken{"gzip_cut_off", with("encoding", "gzip", cut(gzipped("abcd"), 9)), "ends too early"},
        Broken{"gzip_without_its_end", with("encoding", "gzip", cut(gzipped("abcd"), 4)), "ends too early"},
        Broken{"gzip_of_nothing", with("encoding", "gzip", ""), "ends too early"},
        Broken{"gzip_too_short", with("encoding", "gzip", gzipped("abc")), "holds 3 bytes of voxels; the sizes say 4"},
        Broken{"gzip_too_long", with("encoding", "gzip", gzipped(std::string(1000000, 'a'))), "more than the 4 bytes"},
        Broken{"gzip_and_more", with("encoding", "gzip", gzipped("abcd") + "x"), "more than the 4 bytes"},
        Broken{"infinite",
               nrrd("type: float\ndimension: 3\nsizes: 2 1 1\nencoding: raw\nendian: little\n",
                    floats_little({1, INFINITY})),
               "voxel 1 of the volume is not a finite number"}),
    [](const testing::TestParamInfo<Broken>& row) { return row.param.name; });

TEST(RawVolumes, HoldWhatTheSpecSays) {
    const auto raw = [](const std::string& voxel) {
        return RawVolume{.size = {2, 1, 1}, .spacing = {1, 2, 3}, .voxel = voxel};
    };
    EXPECT_THAT(read_volume(text_of({3, 255}), raw("uint8")).bytes, ElementsAre(3, 255));
    EXPECT_EQ(read_volume(text_of({3, 255}), raw("uint8")).spacing, glm::dvec3(1, 2, 3));
    EXPECT_THAT(read_volume(text_of({255, 255, 0, 1}), raw("uint16")).floats, ElementsAre(1, 256.0f / 65535));
    EXPECT_THAT(read_volume(floats_little({5, -5}), raw("float32")).floats, ElementsAre(1, 0));
}

TEST(RawVolumes, OfAnotherSizeAreRefused) {
    for (const std::string& bytes : {std::string(7, 'a'), std::string(9, 'a'), std::string()}) {
        try {
            read_volume(bytes, RawVolume{.size = {2, 2, 1}, .spacing = glm::dvec3(1), .voxel = "uint16"});
            FAIL();
        } catch (const AssetError& error) {
            EXPECT_THAT(error.what(), HasSubstr("2 x 2 x 1 of type uint16 are 8"));
        }
    }
    EXPECT_THROW(read_volume("a", RawVolume{.size = {1024, 1024, 1024}, .spacing = glm::dvec3(1), .voxel = "uint8"}),
                 AssetError);
}

}  // namespace

}  // namespace sheer::read_volume_test
