#include "renderer/assets/gltf_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "renderer/assets/picture_file.h"
#include "renderer/scene/picture_arrays.h"

namespace sheer {

namespace {

constexpr std::size_t max_pictures = 1024;

PictureUse::Wrap wrap_of(const GltfObject& sampler, const char* name) {
    switch (sampler.whole_number(name).value_or(10497)) {
        case 10497:
            return PictureUse::Wrap::repeat;
        case 33071:
            return PictureUse::Wrap::clamp;
        case 33648:
            return PictureUse::Wrap::mirror;
        default:
            sampler.fail(fmt::format("{} must be 10497 (repeat), 33071 (clamp) or 33648 (mirror)", name));
    }
}

/// minFilter of a sampler, glTF 2.0, section 5.26.2.
struct MinFilter {
    std::uint64_t value;
    bool nearest;
    PictureUse::Mipmaps mipmaps;
};
constexpr std::array min_filters = {
    MinFilter{9728, true, PictureUse::Mipmaps::none},    MinFilter{9729, false, PictureUse::Mipmaps::none},
    MinFilter{9984, true, PictureUse::Mipmaps::nearest}, MinFilter{9985, false, PictureUse::Mipmaps::nearest},
    MinFilter{9986, true, PictureUse::Mipmaps::linear},  MinFilter{9987, false, PictureUse::Mipmaps::linear}};

/// Other sources that a texture may have, possibly as its only one.
constexpr std::array unread_sources = {"KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds"};

}  // namespace

PictureUse GltfPictures::use(const GltfObject& info, Alpha alpha) {
    const std::uint64_t number = info.needed_number("index");
    const GltfObject texture = m_file.item(gltf_lists::textures, number, info.what());
    PictureUse use;
    const Wanted wanted{image_of(texture), alpha};
    const auto known = std::ranges::find(m_wanted, wanted);
    use.picture = static_cast<int>(known - m_wanted.begin());
    if (known == m_wanted.end()) m_wanted.push_back(wanted);
    if (m_wanted.size() > max_pictures)
        throw AssetError(fmt::format("the model has more than {} pictures", max_pictures));
    if (const auto sampler = texture.whole_number("sampler"))
        read_sampler(m_file.item(gltf_lists::samplers, *sampler, texture.what()), use);
    return use;
}

std::uint64_t GltfPictures::image_of(const GltfObject& texture) {
    std::optional<std::uint64_t> image = texture.whole_number("source");
    if (const auto webp = texture.extension("EXT_texture_webp")) image = webp->whole_number("source");
    for (const char* name : unread_sources)
        if (!image && texture.extension(name))
            texture.fail(fmt::format("its only picture is in {}, which is not supported", name));
    if (!image) texture.fail("it has no source");
    m_file.item(gltf_lists::images, *image, texture.what());
    return *image;
}

void GltfPictures::read_sampler(const GltfObject& sampler, PictureUse& use) const {
    use.wrap_s = wrap_of(sampler, "wrapS");
    use.wrap_t = wrap_of(sampler, "wrapT");
    const std::uint64_t magnified = sampler.whole_number("magFilter").value_or(9729);
    if (magnified != 9728 && magnified != 9729) sampler.fail("magFilter must be 9728 (nearest) or 9729 (linear)");
    use.nearest_when_magnified = magnified == 9728;
    const std::uint64_t minified = sampler.whole_number("minFilter").value_or(9987);
    const auto* filter = std::ranges::find(min_filters, minified, &MinFilter::value);
    if (filter == min_filters.end()) sampler.fail("minFilter must be 9728, 9729 or 9984 to 9987");
    use.nearest_when_minified = filter->nearest;
    use.mipmaps = filter->mipmaps;
}

std::vector<Picture> GltfPictures::read() {
    std::vector<std::string> encoded;
    std::vector<glm::ivec2> sizes;
    const auto named = [](const Wanted& wanted, const AssetError& error) {
        return AssetError(fmt::format("image {}: {}", wanted.image, error.what()));
    };
    for (const Wanted& wanted : m_wanted) {
        try {
            encoded.push_back(m_file.picture(m_file.item(gltf_lists::images, wanted.image, "the model")));
            const PictureHeader header = read_picture_header(encoded.back());
            sizes.emplace_back(header.width_px, header.height_px);
        } catch (const AssetError& error) {
            throw named(wanted, error);
        }
    }
    const PictureArrays arranged = arrange_pictures(sizes);
    std::vector<Picture> pictures;
    for (std::size_t i = 0; i < encoded.size(); ++i) {
        const Wanted& wanted = m_wanted[i];
        const glm::ivec2 size = arranged.sizes_px[i];
        const std::string where = fmt::format("images[{}]", wanted.image);
        try {
            pictures.push_back(read_picture(encoded[i], size.x, size.y));
        } catch (const AssetError& error) {
            throw named(wanted, error);
        }
        if (size != sizes[i])
            m_file.note("picture-scaled",
                        fmt::format("The picture is scaled to {} x {} pixels from {} x {}.", sizes[i].x, sizes[i].y,
                                    size.x, size.y),
                        where);
        for (const Note& note : pictures.back().notes) m_file.note(note.code, note.text, where);
        if (wanted.alpha == Alpha::ignored)
            for (std::size_t at = 3; at < pictures.back().image.rgba.size(); at += 4)
                pictures.back().image.rgba[at] = 1;
    }
    return pictures;
}

}  // namespace sheer
