// Files with bytes changed, removed and inserted by a seeded generator: each is refused with a reason, or read
// completely.
#include <gmock/gmock.h>

#include <cmath>
#include <optional>

#include "renderer/assets/picture_file.h"
#include "renderer/assets/read_volume.h"
#include "renderer/core/random.h"
#include "tests/unit/asset_pictures.h"
#include "tests/unit/gzipped.h"
#include "tests/unit/png_writer.h"

namespace sheer::mutated_files_test {
namespace {

using test::gzipped;

/// A few changes at random places, most of them of single bytes.
std::string mutated(std::string bytes, Random& random) {
    const auto place = [&] { return static_cast<std::size_t>(random.below(bytes.size())); };
    const auto some = [&] { return static_cast<std::size_t>(1 + random.below(16)); };
    for (std::uint64_t changes = 1 + random.below(3); changes > 0 && !bytes.empty(); --changes) {
        switch (random.below(6)) {
            case 0:
                bytes[place()] = static_cast<char>(random.below(256));
                break;
            case 1: {
                char& byte = bytes[place()];
                byte = static_cast<char>(byte ^ (1 << random.below(8)));
                break;
            }
            case 2:
                bytes[place()] = random.below(2) == 0 ? '\0' : '\xff';
                break;
            case 3:
                bytes.erase(place(), some());
                break;
            case 4: {
                const std::string copy = bytes.substr(place(), some());
                bytes.insert(place(), copy);
                break;
            }
            default:
                bytes.resize(place());
        }
    }
    return bytes;
}

/// Corrects the checksums of all chunks that are still complete, so that they do not reveal the changes.
void mend_checksums(std::string& png) {
    for (std::size_t at = 8; at + 12 <= png.size();) {
        std::size_t length = 0;
        for (std::size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<std::uint8_t>(png[at + i]);
        if (length > png.size() || at + 12 + length > png.size()) return;
        const std::string chunk = png_chunk(png.substr(at + 4, 4), png.substr(at + 8, length));
        png.replace(at, chunk.size(), chunk);
        at += chunk.size();
    }
}

std::string noise_text(std::size_t count) {
    const std::vector<std::uint8_t> values = noise(count);
    return {values.begin(), values.end()};
}

template <typename Value>
std::vector<Value> ramp(std::size_t count, double step) {
    std::vector<Value> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<Value>(static_cast<double>(i) * step));
    return values;
}

/// A picture as it is read, or nothing if it is refused.
std::optional<Picture> read_or_refuse(const std::string& bytes) {
    try {
        return read_picture(bytes, 8, 8);
    } catch (const AssetError& error) {
        EXPECT_STRNE(error.what(), "");
        for (const char* c = error.what(); *c != '\0'; ++c) EXPECT_TRUE(*c >= ' ' && *c <= '~') << error.what();
        return std::nullopt;
    }
}

TEST(MutatedPictures, AreRefusedOrRead) {
    const PngParts palette = {.width_px = 9,
                              .height_px = 5,
                              .depth = 8,
                              .color_type = 3,
                              .before_data = png_chunk("PLTE", "abcdefghijkl") + png_chunk("tRNS", "\x80\x40") +
                                             png_chunk("eXIf", exif_of(6, true)),
                              .rows = std::string(5 * 10, '\0'),
                              .after = ""};
    const std::string pngs[] = {encode_picture("png", 13, 11, 4, ramp<std::uint8_t>(13 * 11 * 4, 3.7)),
                                encode_picture("png", 7, 9, 3, ramp<std::uint16_t>(7 * 9 * 3, 321)), png_of(palette)};
    const std::string others[] = {encode_picture("jpeg", 24, 17, 3, ramp<std::uint8_t>(24 * 17 * 3, 1.3)),
                                  encode_picture("jpeg", 16, 16, 1, ramp<std::uint8_t>(16 * 16, 2)),
                                  encode_picture("openexr", 12, 9, 4, ramp<float>(12 * 9 * 4, 0.01)),
                                  encode_picture("openexr", 20, 18, 3, ramp<float>(20 * 18 * 3, 0.01), 16)};
    Random random(20261126);
    int refused = 0, read = 0;
    const auto check = [&](const std::string& bytes) {
        const std::optional<Picture> picture = read_or_refuse(bytes);
        ++(picture ? read : refused);
        if (!picture) return picture;
        EXPECT_EQ(picture->image.rgba.size(), 8u * 8 * 4);
        for (const float value : picture->image.rgba) EXPECT_TRUE(std::isfinite(value) && value >= 0) << value;
        return picture;
    };
    for (int i = 0; i < 125; ++i) {
        for (const bool mended : {false, true}) {
            const std::string& whole = pngs[random.below(std::size(pngs))];
            std::string bytes = mutated(whole, random);
            if (mended) mend_checksums(bytes);
            const std::optional<Picture> picture = check(bytes);
            // Without new checksums a change is detected, or makes no difference, such as one after the end.
            if (picture && !mended) {
                EXPECT_EQ(picture->image.rgba, read_picture(whole, 8, 8).image.rgba) << i;
            }
        }
        for (int j = 0; j < 2; ++j) check(mutated(others[random.below(std::size(others))], random));
    }
    EXPECT_GT(refused, 250);
    EXPECT_GT(read, 25);
}

TEST(MutatedVolumes, AreRefusedOrRead) {
    const auto nrrd = [](const std::string& fields, const std::string& data) {
        return "NRRD0005\ndimension: 3\nsizes: 3 4 2\n" + fields + "\n" + data;
    };
    std::string text, bytes = noise_text(48);
    for (int i = 0; i < 24; ++i) text += std::to_string(i * 7 - 50) + " ";
    const std::string wholes[] = {
        nrrd("type: int16\nencoding: ascii\nspacings: 1 -2 0.5\n", text),
        nrrd("type: ushort\nencoding: raw\nendian: little\nspace: LPS\nspace directions: (-1,0,0) (0,0,2) (0,1,0)\n",
             bytes),
        nrrd("type: uint16\nencoding: gzip\nendian: big\nbyte skip: 2\n", gzipped("ab" + bytes)),
        nrrd("type: float\nencoding: hex\nendian: little\nkinds: domain domain domain\n", [] {
            std::string digits;
            for (int i = 0; i < 24; ++i) digits += "0000803f ";
            return digits;
        }())};
    Random random(11);
    int refused = 0, read = 0;
    for (int i = 0; i < 100; ++i) {
        try {
            const std::string& whole = wholes[random.below(std::size(wholes))];
            const Volume volume = read_volume(mutated(whole, random), {});
            EXPECT_EQ(volume.floats.size() + volume.bytes.size(), volume.voxel_count());
            for (const float value : volume.floats) EXPECT_TRUE(value >= 0 && value <= 1) << value;
            ++read;
        } catch (const AssetError& error) {
            for (const char* c = error.what(); *c != '\0'; ++c) EXPECT_TRUE(*c >= ' ' && *c <= '~') << error.what();
            ++refused;
        }
    }
    EXPECT_GT(refused, 25);
    EXPECT_GT(read, 5);
}

}  // namespace
}  // namespace sheer::mutated_files_test
