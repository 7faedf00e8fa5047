// Volume files written by hand, byte by byte.
#include "renderer/assets/read_volume.h"

#include <bzlib.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <bit>
#include <cmath>

#include "tests/unit/gzipped.h"

namespace sheer::read_volume_test {

namespace {

using test::gzipped;

using testing::ElementsAre;
using testing::FloatNear;
using testing::HasSubstr;
using testing::Pointwise;

std::string text_of(std::initializer_list<int> bytes) {
    std::string text;
    for (const int byte : bytes) text += static_cast<char>(byte);
    return text;
}

std::string bzip2ed(const std::string& bytes) {
    std::string packed(bytes.size() + 700, '\0');
    auto size = static_cast<unsigned>(packed.size());
    EXPECT_EQ(BZ2_bzBuffToBuffCompress(packed.data(), &size, const_cast<char*>(bytes.data()),
                                       static_cast<unsigned>(bytes.size()), 9, 0, 0),
              BZ_OK);
    packed.resize(size);
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

Volume read(const std::string& bytes, std::optional<glm::dvec2> range = std::nullopt) {
    return read_volume(bytes, {.raw = std::nullopt, .range = range});
}

/// Every voxel as the shading reads it.
std::vector<float> values_of(const Volume& volume) {
    if (volume.bytes.empty()) return volume.floats;
    std::vector<float> values;
    for (const std::uint8_t byte : volume.bytes)
        values.push_back(
            static_cast<float>((byte - volume.byte_range.x) / (volume.byte_range.y - volume.byte_range.x)));
    return values;
}

std::vector<std::string> codes_of(const Volume& volume) {
    std::vector<std::string> codes;
    for (const Note& note : volume.notes) codes.push_back(note.code);
    return codes;
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

TEST(Nrrd, Uint16OfEitherByteOrderIsScaledToItsRange) {
    const std::string fields = "type: ushort\ndimension: 3\nsizes: 2 2 1\nencoding: raw\nendian: ";
    // 2, 1026, 514, 258.
    const std::vector<float> expected = {0, 1, 0.5f, 0.25f};
    EXPECT_THAT(read(nrrd(fields + "little\n", text_of({2, 0, 2, 4, 2, 2, 2, 1}))).floats,
                Pointwise(FloatNear(1e-7f), expected));
    EXPECT_THAT(read(nrrd(fields + "big\n", text_of({0, 2, 4, 2, 2, 2, 1, 2}))).floats,
                Pointwise(FloatNear(1e-7f), expected));
}

/// -2, 0 and 6: the least becomes 0 and the greatest 1.
TEST(Nrrd, Int16IsScaledToItsRange) {
    const Volume volume = read(nrrd("type: int16\ndimension: 3\nsizes: 3 1 1\nencoding: raw\nendian: big\n",
                                    text_of({0xff, 0xfe, 0, 0, 0, 6})));
    EXPECT_THAT(volume.floats, ElementsAre(0, 0.25f, 1));
}

TEST(Nrrd, FloatsInGzipAreScaledToTheirRange) {
    const Volume volume =
        read(nrrd("type: float\ndimension: 3\nsizes: 1 2 2\nencoding: gzip\nendian: little\n"
                  "space: left-posterior-superior\nspace directions: (3,0,4) (0,-2,0) (0, 0, 0.25)\n",
                  gzipped(floats_little({-1, 3, 0, 1}))));
    // The second axis goes down.
    EXPECT_THAT(volume.floats, ElementsAre(1, 0, 0.5f, 0.25f));
    // The length of (3, 0, 4) is 5.
    EXPECT_EQ(volume.spacing, glm::dvec3(5, 2, 0.25));
}

TEST(Nrrd, EqualFloatsBecome0) {
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
                                     {"range", nlohmann::json::array({97.0, 98.0})},
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
            FAIL() << "it is accepted";
        } catch (const AssetError& error) {
            EXPECT_THAT(error.what(), HasSubstr(GetParam().reason));
        }
    }
}

/// Four uint8 voxels, with an additional or changed field.
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
        Broken{"no_field", nrrd("type uint8\n", ""), "is not a field"},
        Broken{"twice", with("sizes ", "2 2 1"), "\"sizes\" twice"},
        Broken{"detached", with("data file", "head.raw"), "its data in another file, \"head.raw\""},
        Broken{"detached_without_a_blank_line",
               "NRRD0004\ntype: uint8\ndatafile: a.raw\ndimension: 3\nsizes: 1 1 "
               "1\nencoding: raw",
               "its data in another file, \"a.raw\""},
        Broken{"detached_list", with("datafile", "LIST"), "several other files"},
        Broken{"detached_numbered", with("data file", "a%03d.raw 1 2 1"), "several other files"},
        Broken{"skipped_lines", with("line skip", "1"), "skips all the lines"},
        Broken{"skipped_bytes", with("byte skip", "5"), "leaves too few bytes"},
        Broken{"skipped_byte", with("byte skip", "1"), "holds 3 bytes of voxels"},
        Broken{"skip_of_less", with("byte skip", "-2"), "must be at least -1"},
        Broken{"lines_of_less", with("line skip", "-1"), "must be at least 0"},
        Broken{"last_bytes_of_text",
               nrrd("type: uint8\ndimension: 3\nsizes: 2 1 1\nencoding: text\nbyte skip: -1\n", "1 2"),
               "only with the encoding raw"},
        Broken{"no_type", with("type", ""), "no field \"type\""},
        Broken{"no_sizes", with("sizes", ""), "no field \"sizes\""},
        Broken{"no_encoding", with("encoding", ""), "no field \"encoding\""},
        Broken{"int64", with("type", "long long int"), "of type \"long long int\""},
        Broken{"block", with("type", "block"), "of type \"block\""},
        Broken{"not_text", with("type", "\xff"), "of type \"?\""},
        Broken{"zrl", with("encoding", "zrl"), "encoding \"zrl\""},
        Broken{"no_number", with("encoding", "ascii", "1 2 x 4"), "holds \"x\", which is not of type uint8"},
        Broken{"number_too_large", with("encoding", "ascii", "1 2 256 4"), "holds \"256\", which is not of type uint8"},
        Broken{"fraction_of_text", with("encoding", "ascii", "1 2 0.5 4"), "holds \"0.5\", which is not of type uint8"},
        Broken{"text_too_short", with("encoding", "ascii", "1 2 3"), "holds 3 voxels, but the sizes require 4"},
        Broken{"text_too_long", with("encoding", "text", "1 2 3 4 5"), "more than 4 voxels"},
        Broken{"no_hex", with("encoding", "hex", "0g"), "holds \"g\", which is not a digit"},
        Broken{"half_hex", with("encoding", "hex", "0"), "ends within a byte"},
        Broken{"hex_too_long", with("encoding", "hex", "0011223344"), "holds 5 bytes of voxels"},
        Broken{"no_bzip2", with("encoding", "bzip2"), "bzip2 data is damaged"},
        Broken{"bzip2_cut_off", with("encoding", "bz2", cut(bzip2ed("abcd"), 3)), "bzip2 data ends too early"},
        Broken{"bzip2_too_short", with("encoding", "bz2", bzip2ed("abc")),
               "holds 3 bytes of voxels, but the sizes require 4"},
        Broken{"bzip2_too_long", with("encoding", "bz2", bzip2ed("abcde")), "more than the 4 bytes"},
        Broken{"bzip2_and_more", with("encoding", "bz2", bzip2ed("abcd") + "x"), "more than the 4 bytes"},
        Broken{"vectors", with("kinds", "vector domain domain"), "an axis of the kind \"vector\""},
        Broken{"colors", with("kinds", "RGB-color space space"), "an axis of the kind \"RGB-color\""},
        Broken{"movie", with("kinds", "domain domain time"), "an axis of the kind \"time\""},
        Broken{"in_one_plane", with("space directions", "(1,0,0) (0,1,0) (1,1,0)"), "in one plane"},
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
        Broken{"too_short", with("sizes", "2 2 2"), "holds 4 bytes of voxels, but 2 x 2 x 2 of type uint8 are 8"},
        Broken{"too_long", with("sizes", "1 1 1"), "holds 4 bytes of voxels, but 1 x 1 x 1 of type uint8 are 1"},
        Broken{"no_endian", nrrd("type: short\ndimension: 3\nsizes: 2 1 1\nencoding: raw\n", "abcd"), "\"endian\""},
        Broken{"odd_endian", nrrd("type: short\ndimension: 3\nsizes: 2 1 1\nencoding: raw\nendian: middle\n", "abcd"),
               "must be big or little"},
        Broken{"flat", with("spacings", "1 0 1"), "\"spacings\" has unusable distances"},
        Broken{"not_a_number", with("spacings", "1 nan 1"), "\"spacings\" has unusable distances"},
        Broken{"no_direction", with("space directions", "none (0,1,0) (0,0,1)"), "three entries"},
        Broken{"direction_of_two", with("space directions", "(1,0) (0,1,0) (0,0,1)"), "three entries, not 2"},
        Broken{"no_gzip", with("encoding", "gzip"), "damaged"},
        Broken{"gzip_cut_off", with("encoding", "gzip", cut(gzipped("abcd"), 9)), "ends too early"},
        Broken{"gzip_without_its_end", with("encoding", "gzip", cut(gzipped("abcd"), 4)), "ends too early"},
        Broken{"gzip_of_nothing", with("encoding", "gzip", ""), "ends too early"},
        Broken{"gzip_too_short", with("encoding", "gzip", gzipped("abc")),
               "holds 3 bytes of voxels, but the sizes require 4"},
        Broken{"gzip_too_long", with("encoding", "gzip", gzipped(std::string(1000000, 'a'))), "more than the 4 bytes"},
        Broken{"gzip_and_more", with("encoding", "gzip", gzipped("abcd") + "x"), "more than the 4 bytes"},
        Broken{"infinite",
               nrrd("type: float\ndimension: 3\nsizes: 2 1 1\nencoding: raw\nendian: little\n",
                    floats_little({1, INFINITY})),
               "voxel 1 of the volume is not a finite number"}),
    [](const testing::TestParamInfo<Broken>& row) { return row.param.name; });

RawVolume raw_of(const std::string& voxel, bool big_endian = false) {
    return {.size = {2, 1, 1}, .spacing = {1, 2, 3}, .voxel = voxel, .big_endian = big_endian};
}

TEST(RawVolumes, MatchTheSpec) {
    const Volume bytes = read_volume(text_of({3, 255}), {.raw = raw_of("uint8"), .range = std::nullopt});
    EXPECT_THAT(bytes.bytes, ElementsAre(3, 255));
    EXPECT_EQ(bytes.spacing, glm::dvec3(1, 2, 3));
    EXPECT_THAT(read_volume(floats_little({5, -5}), {.raw = raw_of("float32"), .range = std::nullopt}).floats,
                ElementsAre(1, 0));
}

struct TypeRow {
    std::string voxel;
    std::initializer_list<int> little, big;
    glm::dvec2 numbers;
};

/// Two numbers of each type, byte by byte in either order. The range begins 1 below the first and ends 3 above the
/// second.
TEST(RawVolumes, HaveEightTypesOfVoxels) {
    const TypeRow rows[] = {
        {"int8", {0x80, 0x7f}, {0x80, 0x7f}, {-128, 127}},
        {"uint8", {7, 255}, {7, 255}, {7, 255}},
        {"int16", {0, 0x80, 0xff, 0x7f}, {0x80, 0, 0x7f, 0xff}, {-32768, 32767}},
        {"uint16", {1, 0, 0xff, 0xff}, {0, 1, 0xff, 0xff}, {1, 65535}},
        {"int32", {0, 0, 0, 0x80, 2, 0, 0, 0}, {0x80, 0, 0, 0, 0, 0, 0, 2}, {-2147483648.0, 2}},
        {"uint32", {5, 0, 0, 0, 255, 255, 255, 255}, {0, 0, 0, 5, 255, 255, 255, 255}, {5, 4294967295.0}},
        {"float32", {0, 0, 0x80, 0xbf, 0, 0, 0x40, 0x40}, {0xbf, 0x80, 0, 0, 0x40, 0x40, 0, 0}, {-1, 3}},
        {"float64",
         {0, 0, 0, 0, 0, 0, 0xf0, 0xbf, 0, 0, 0, 0, 0, 0, 8, 0x40},
         {0xbf, 0xf0, 0, 0, 0, 0, 0, 0, 0x40, 8, 0, 0, 0, 0, 0, 0},
         {-1, 3}},
    };
    for (const TypeRow& row : rows) {
        const double a = row.numbers.x, b = row.numbers.y, span = b + 3 - (a - 1);
        for (const bool big : {false, true}) {
            const Volume volume = read_volume(text_of(big ? row.big : row.little),
                                              {.raw = raw_of(row.voxel, big), .range = glm::dvec2(a - 1, b + 3)});
            const std::vector<float> expected = {static_cast<float>(1 / span), static_cast<float>((1 + b - a) / span)};
            EXPECT_THAT(values_of(volume), Pointwise(FloatNear(1e-7f), expected)) << row.voxel << (big ? " big" : "");
        }
    }
}

TEST(RawVolumes, OfAnotherSizeAreRefused) {
    const auto read_raw = [](const std::string& bytes, const glm::ivec3& size, const std::string& voxel) {
        read_volume(bytes, {.raw = RawVolume{.size = size, .voxel = voxel}, .range = std::nullopt});
    };
    for (const std::string& bytes : {std::string(7, 'a'), std::string(9, 'a'), std::string()}) {
        try {
            read_raw(bytes, {2, 2, 1}, "uint16");
            FAIL();
        } catch (const AssetError& error) {
            EXPECT_THAT(error.what(), HasSubstr("2 x 2 x 1 of type uint16 are 8"));
        }
    }
    EXPECT_THROW(read_raw("a", {1024, 1024, 1024}, "uint8"), AssetError);
}

std::string typed(const std::string& type, const std::string& encoding, const std::string& data) {
    return nrrd(fmt::format("type: {}\ndimension: 3\nsizes: 4 1 1\nencoding: {}\nendian: big\n", type, encoding), data);
}

TEST(NrrdEncodings, AllGiveTheSame) {
    // 10, -20, 30, 40 as big-endian 16-bit numbers.
    const std::string raw = text_of({0, 10, 0xff, 0xec, 0, 30, 0, 40});
    const std::vector<float> expected = {0.5f, 0, 5.0f / 6, 1};
    const auto same = Pointwise(FloatNear(1e-7f), expected);
    EXPECT_THAT(read(typed("short", "raw", raw)).floats, same);
    EXPECT_THAT(read(typed("int16", "ascii", "10 -20\n  30,+40\n")).floats, same);
    EXPECT_THAT(read(typed("int16", "hex", "000A ffec\n001e 0028")).floats, same);
    EXPECT_THAT(read(typed("int16", "gzip", gzipped(raw))).floats, same);
    EXPECT_THAT(read(typed("int16", "bzip2", bzip2ed(raw))).floats, same);
    EXPECT_THAT(read(typed("double", "text", "10 -2e1 3.0e+1 40.")).floats, same);
    EXPECT_THAT(read(typed("int", "txt", "10 -20 30 40")).floats, same);
}

/// As parallel packers write them.
TEST(NrrdEncodings, MayBeSeveralStreams) {
    EXPECT_THAT(read(typed("uchar", "gzip", gzipped("ab") + gzipped("cd"))).bytes, ElementsAre('a', 'b', 'c', 'd'));
    EXPECT_THAT(read(typed("uchar", "bzip2", bzip2ed("abc") + bzip2ed("d"))).bytes, ElementsAre('a', 'b', 'c', 'd'));
}

TEST(NrrdSkips, AreLeftOut) {
    const auto with_skips = [](const std::string& skips, const std::string& encoding, const std::string& data) {
        return read(nrrd("type: uchar\ndimension: 3\nsizes: 2 1 1\nencoding: " + encoding + "\n" + skips, data)).bytes;
    };
    EXPECT_THAT(with_skips("byte skip: -1\n", "raw", "a head of any length: xy"), ElementsAre('x', 'y'));
    EXPECT_THAT(with_skips("byte skip: -1\n", "raw", "xy"), ElementsAre('x', 'y'));
    EXPECT_THAT(with_skips("byteskip: 3\n", "raw", "abcxy"), ElementsAre('x', 'y'));
    EXPECT_THAT(with_skips("line skip: 2\n", "raw", "one\ntwo\nxy"), ElementsAre('x', 'y'));
    EXPECT_THAT(with_skips("lineskip: 1\nbyteskip: 2\n", "raw", "one\nabxy"), ElementsAre('x', 'y'));
    // In a compressed stream, the bytes are skipped after decompression.
    EXPECT_THAT(with_skips("byte skip: 3\n", "gzip", gzipped("abcxy")), ElementsAre('x', 'y'));
    EXPECT_THAT(with_skips("line skip: 1\n", "ascii", "x and y\n120 121"), ElementsAre('x', 'y'));
}

TEST(NrrdRange, CanBeGiven) {
    const std::string file = typed("uchar", "raw", text_of({10, 20, 60, 110}));
    EXPECT_THAT(values_of(read(file)), ElementsAre(0, 0.1f, 0.5f, 1));
    EXPECT_THAT(values_of(read(file, glm::dvec2(20, 60))), ElementsAre(-0.25f, 0, 1, 2.25f));
    EXPECT_THAT(values_of(read(typed("short", "ascii", "10 20 60 110"), glm::dvec2(20, 60))),
                ElementsAre(-0.25f, 0, 1, 2.25f));
}

TEST(NrrdRange, IsNoted) {
    const auto note = [](const Volume& volume) {
        EXPECT_EQ(codes_of(volume), std::vector<std::string>{"value-range"});
        return volume.notes.empty() ? "" : volume.notes[0].text;
    };
    const std::string file = typed("int", "ascii", "-1024 0 7 3071");
    EXPECT_THAT(note(read(file)), HasSubstr("from -1024 to 3071, the least and the greatest"));
    EXPECT_THAT(note(read(file, glm::dvec2(0, 80.5))),
                HasSubstr("from 0 to 80.5 become 0 to 1, as set by the field range"));
    EXPECT_THAT(note(read(typed("uchar", "ascii", "9 9 9 9"))), HasSubstr("All voxels are 9"));
    EXPECT_THAT(values_of(read(typed("uchar", "ascii", "9 9 9 9"))), ElementsAre(0, 0, 0, 0));
}

/// A number far outside the range does not reduce the precision of the others, and the span may exceed the greatest
/// double.
TEST(NrrdRange, KeepsTheDigitsInside) {
    const Volume outlier = read(typed("double", "text", "1e300 1 2 3"), glm::dvec2(1, 3));
    EXPECT_FLOAT_EQ(outlier.floats[2], 0.5f);
    EXPECT_TRUE(std::isfinite(outlier.floats[0]));
    EXPECT_THAT(read(typed("double", "text", "-1.5e308 1.5e308 0 -0.75e308")).floats, ElementsAre(0, 1, 0.5f, 0.25f));
    EXPECT_THAT(read(typed("uint", "text", "4294967290 4294967295 4294967294 4294967290")).floats,
                ElementsAre(0, 1, 0.8f, 0));
}

struct AxesRow {
    std::string fields;
    std::vector<int> voxels;  ///< in the scene's order
    glm::ivec3 size;
    glm::dvec3 spacing;
    std::vector<std::string> codes;
};

/// 0..5, of 3 x 2 x 1 voxels: a file's first row is 0 1 2, its second 3 4 5.
TEST(NrrdAxes, PutTheVoxelsInOrder) {
    const std::vector<std::string> none = {"value-range"};
    const AxesRow rows[] = {
        {"", {0, 1, 2, 3, 4, 5}, {3, 2, 1}, {1, 1, 1}, none},
        {"space directions: (2,0,0) (0,3,0) (0,0,4)\n", {0, 1, 2, 3, 4, 5}, {3, 2, 1}, {2, 3, 4}, none},
        {"space directions: (-2,0,0) (0,3,0) (0,0,4)\n", {2, 1, 0, 5, 4, 3}, {3, 2, 1}, {2, 3, 4}, none},
        {"space directions: (2,0,0) (0,-3,0) (0,0,-4)\n", {3, 4, 5, 0, 1, 2}, {3, 2, 1}, {2, 3, 4}, none},
        // The first axis goes up: columns of the scene are rows of the file.
        {"space directions: (0,2,0) (3,0,0) (0,0,4)\n", {0, 3, 1, 4, 2, 5}, {2, 3, 1}, {3, 2, 4}, none},
        // The first axis goes down, the second to the viewer, the third to the right.
        {"space directions: (0,-2,0) (0,0,3) (4,0,0)\n", {2, 1, 0, 5, 4, 3}, {1, 3, 2}, {4, 2, 3}, none},
        {"spacings: -2 3 4\n", {2, 1, 0, 5, 4, 3}, {3, 2, 1}, {2, 3, 4}, none},
        {"space: right-anterior-superior\nspace directions: (0,0,1) (0,-1,0) (1,0,0)\nspace origin: (9,9,9)\n",
         {3, 0, 4, 1, 5, 2},
         {1, 2, 3},
         {1, 1, 1},
         none},
        {"space: LAS\nspace directions: (2,0,0) (0,3,0) (0,0,4)\n",
         {2, 1, 0, 5, 4, 3},
         {3, 2, 1},
         {2, 3, 4},
         {"left-handed-space", "value-range"}},
        {"space: 3D-left-handed\n", {2, 1, 0, 5, 4, 3}, {3, 2, 1}, {1, 1, 1}, {"left-handed-space", "value-range"}},
        // By 10 degrees about z: cos 0.9848, sin 0.1736.
        {"space directions: (0.9848,0.1736,0) (0.1736,-0.9848,0) (0,0,1)\n",
         {3, 4, 5, 0, 1, 2},
         {3, 2, 1},
         {1, 1, 1},
         {"oblique-axes", "value-range"}},
        {"centerings: node node node\n",
         {0, 1, 2, 3, 4, 5},
         {3, 2, 1},
         {1, 1, 1},
         {"node-centering-ignored", "value-range"}},
        {"axis maxs: 3 2 1\n", {0, 1, 2, 3, 4, 5}, {3, 2, 1}, {1, 1, 1}, {"axis-ranges-ignored", "value-range"}},
    };
    for (const AxesRow& row : rows) {
        const std::string fields = "dimension: 3\nsizes: 3 2 1\nencoding: text\n" + row.fields;
        for (const std::string type : {"uint8", "float"}) {
            const Volume volume = read(nrrd("type: " + type + "\n" + fields, "0 1 2 3 4 5"), glm::dvec2(0, 1));
            EXPECT_EQ(volume.size, row.size) << row.fields;
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_NEAR(volume.spacing[axis], row.spacing[axis], 1e-4) << row.fields;
            const std::vector<float> values = values_of(volume);
            EXPECT_EQ(std::vector<int>(values.begin(), values.end()), row.voxels) << row.fields;
            EXPECT_EQ(codes_of(volume), row.codes) << row.fields;
        }
    }
}

TEST(NrrdAxes, AreNeverMirrored) {
    // By 60 degrees about (1, 1, 1), for which two orders of the axes are equally near.
    const Volume volume =
        read(nrrd("type: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\nspace directions: "
                  "(0.6667,0.6667,-0.3333) (-0.3333,0.6667,0.6667) (0.6667,-0.3333,0.6667)\n",
                  "abcdefgh"));
    // The determinant of the steps along the file's axes, in the scene, is over 0 if nothing is mirrored.
    const auto place_of = [&](char voxel) {
        const auto at = std::ranges::find(volume.bytes, static_cast<std::uint8_t>(voxel)) - volume.bytes.begin();
        return glm::dvec3(at & 1, at >> 1 & 1, at >> 2);
    };
    const glm::dvec3 first = place_of('a');
    EXPECT_GT(glm::determinant(glm::dmat3(place_of('b') - first, place_of('c') - first, place_of('e') - first)), 0);
}

TEST(DetachedNrrd, IsReadFromItsOtherFile) {
    const std::string header =
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 1 1\nencoding: raw\nbyte skip: -1\ndata file: in here/a.raw";
    std::vector<std::string> asked;
    const DataFiles files = [&](const std::string& name) {
        asked.push_back(name);
        return std::string("some head xy");
    };
    EXPECT_THAT(read_volume(header, {}, files).bytes, ElementsAre('x', 'y'));
    EXPECT_THAT(read_volume(header + "\n\nnot this", {}, files).bytes, ElementsAre('x', 'y'));
    EXPECT_THAT(asked, ElementsAre("in here/a.raw", "in here/a.raw"));
    const DataFiles nothing = [](const std::string&) -> std::string { throw AssetError("it is not there"); };
    try {
        read_volume(header, {}, nothing);
        FAIL();
    } catch (const AssetError& error) {
        EXPECT_STREQ(error.what(), "the NRRD file keeps its data in another file: it is not there");
    }
}

}  // namespace

}  // namespace sheer::read_volume_test
