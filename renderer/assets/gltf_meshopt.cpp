#include "renderer/assets/gltf_meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include "renderer/scene/assets.h"

namespace sheer {

namespace {

/// A few bytes may claim to decode to many.
constexpr std::uint64_t max_decoded_bytes = std::uint64_t{512} << 20;

struct Elements {
    std::uint64_t count, stride_bytes;
};

Elements elements_of(const GltfObject& extension, const std::string& mode) {
    const Elements elements{extension.needed_number("count"), extension.needed_number("byteStride")};
    const bool whole_words =
        elements.stride_bytes > 0 && elements.stride_bytes <= 256 && elements.stride_bytes % 4 == 0;
    const bool index = elements.stride_bytes == 2 || elements.stride_bytes == 4;
    if (mode == "ATTRIBUTES" ? !whole_words : !index)
        extension.fail(fmt::format("byteStride cannot be {} if mode is {}", elements.stride_bytes, mode));
    if (elements.count == 0) extension.fail("count is 0");
    if (elements.count > max_decoded_bytes / elements.stride_bytes)
        extension.fail(fmt::format("it decodes to more than {} bytes", max_decoded_bytes));
    if (mode == "TRIANGLES" && elements.count % 3 != 0) extension.fail("count is not a multiple of 3");
    return elements;
}

void apply_filter(const GltfObject& extension, const Elements& elements, std::string& bytes) {
    const std::string filter = extension.text("filter", "NONE");
    const auto expect = [&](bool fits) {
        if (!fits)
            extension.fail(fmt::format("byteStride cannot be {} if filter is {}", elements.stride_bytes, filter));
    };
    if (filter == "OCTAHEDRAL") {
        expect(elements.stride_bytes == 4 || elements.stride_bytes == 8);
        meshopt_decodeFilterOct(bytes.data(), elements.count, elements.stride_bytes);
    } else if (filter == "QUATERNION") {
        expect(elements.stride_bytes == 8);
        meshopt_decodeFilterQuat(bytes.data(), elements.count, elements.stride_bytes);
    } else if (filter == "EXPONENTIAL") {
        meshopt_decodeFilterExp(bytes.data(), elements.count, elements.stride_bytes);
    } else if (filter != "NONE") {
        extension.fail(fmt::format("there is no filter {:.40}", filter));
    }
}

}  // namespace

std::string decode_meshopt(const GltfObject& extension, std::string_view compressed) {
    const std::string mode = extension.text("mode");
    const auto* input = reinterpret_cast<const unsigned char*>(compressed.data());
    if (mode != "ATTRIBUTES" && mode != "TRIANGLES" && mode != "INDICES")
        extension.fail(fmt::format("there is no mode \"{:.40}\"", mode));
    const Elements elements = elements_of(extension, mode);
    std::string bytes(elements.count * elements.stride_bytes, '\0');
    int error = 0;
    if (mode == "ATTRIBUTES") {
        error =
            meshopt_decodeVertexBuffer(bytes.data(), elements.count, elements.stride_bytes, input, compressed.size());
    } else if (mode == "TRIANGLES") {
        error =
            meshopt_decodeIndexBuffer(bytes.data(), elements.count, elements.stride_bytes, input, compressed.size());
    } else {
        error =
            meshopt_decodeIndexSequence(bytes.data(), elements.count, elements.stride_bytes, input, compressed.size());
    }
    if (error != 0) extension.fail("the compressed data cannot be decoded");
    if (mode == "ATTRIBUTES") apply_filter(extension, elements, bytes);
    return bytes;
}

}  // namespace sheer
