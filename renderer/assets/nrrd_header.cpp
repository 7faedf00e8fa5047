#include "renderer/assets/nrrd_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <vector>

#include "renderer/assets/read_volume.h"

namespace sheer {

namespace {

constexpr std::string_view magic = "NRRD000";
constexpr std::size_t max_header_bytes = 64 << 10;
constexpr std::string_view spaces = " \t";

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(spaces);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(spaces) - begin + 1);
}

std::string lower(std::string_view text) {
    std::string result(text);
    std::ranges::transform(result, result.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return result;
}

/// Words between any of `separators`.
std::vector<std::string_view> split(std::string_view text, std::string_view separators) {
    std::vector<std::string_view> words;
    std::size_t begin = text.find_first_not_of(separators);
    while (begin != std::string_view::npos) {
        const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
        words.push_back(text.substr(begin, end - begin));
        begin = text.find_first_not_of(separators, end);
    }
    return words;
}

template <typename Number>
Number number_in(std::string_view word, const std::string& field) {
    Number number{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size())
        throw AssetError(
            fmt::format("the NRRD field \"{}\" holds \"{}\", which is not such a number", field, word.substr(0, 40)));
    return number;
}

/// Throws AssetError if there are not three.
std::vector<std::string_view> three(std::vector<std::string_view> entries, const std::string& field) {
    if (entries.size() != 3)
        throw AssetError(fmt::format("the NRRD field \"{}\" must have three entries, not {}", field, entries.size()));
    return entries;
}

/// What stands in each pair of parentheses.
std::vector<std::string_view> groups_in(std::string_view text) {
    std::vector<std::string_view> groups;
    while (true) {
        const std::size_t open = text.find('('), close = text.find(')');
        if (open == std::string_view::npos || close == std::string_view::npos || close < open) return groups;
        groups.push_back(text.substr(open + 1, close - open - 1));
        text.remove_prefix(close + 1);
    }
}

/// Fields by their names in lower case without spaces, as some have been spelt both with and without.
using Fields = std::map<std::string, std::string_view>;

class HeaderReader {
  public:
    explicit HeaderReader(std::string_view bytes) : m_bytes(bytes) {}

    NrrdHeader read() {
        next_line();
        for (std::string_view line = next_line(); !line.empty(); line = next_line()) add_field(line);
        refuse_detached();
        if (const auto dimension = number_in<int>(required("dimension"), "dimension"); dimension != 3)
            throw AssetError(fmt::format("the NRRD file has {} dimensions; a volume has 3", dimension));
        VoxelLayout layout;
        layout.type = type();
        layout.gzip = gzip();
        layout.size = size();
        check_volume_size(layout.size, layout.type);
        layout.big_endian = bytes_of(layout.type) > 1 && big_endian();
        layout.spacing = spacing();
        return {layout, m_position};
    }

  private:
    std::string_view next_line() {
        const std::size_t end = m_bytes.substr(0, max_header_bytes).find('\n', m_position);
        if (end == std::string_view::npos) throw AssetError("the header of the NRRD file has no end");
        std::string_view line = m_bytes.substr(m_position, end - m_position);
        m_position = end + 1;
        if (line.ends_with('\r')) line.remove_suffix(1);
        return line;
    }

    void add_field(std::string_view line) {
        if (line.starts_with('#')) return;
        const std::size_t colon = line.find(':');
        if (colon == std::string_view::npos)
            throw AssetError(
                fmt::format("the header of the NRRD file has the line \"{}\", which is no field", line.substr(0, 40)));
        if (line.substr(colon).starts_with(":=")) return;
        std::string name = lower(line.substr(0, colon));
        std::erase(name, ' ');
        if (!m_fields.emplace(name, trimmed(line.substr(colon + 1))).second)
            throw AssetError("the NRRD file has the field \"" + name + "\" twice");
    }

    std::string_view required(const std::string& name) const {
        const auto found = m_fields.find(name);
        if (found == m_fields.end()) throw AssetError("the NRRD file has no field \"" + name + "\"");
        return found->second;
    }

    void refuse_detached() const {
        if (m_fields.contains("datafile"))
            throw AssetError("the NRRD file keeps its data in another file; upload one with the data attached");
        for (const std::string name : {"lineskip", "byteskip"})
            if (const auto found = m_fields.find(name); found != m_fields.end() && found->second != "0")
                throw AssetError("the NRRD field \"" + name + "\" is taken only where it is 0");
    }

    VoxelType type() const {
        static const std::map<std::string, VoxelType, std::less<>> types = {{"uchar", VoxelType::uint8},
                                                                            {"unsigned char", VoxelType::uint8},
                                                                            {"uint8", VoxelType::uint8},
                                                                            {"uint8_t", VoxelType::uint8},
                                                                            {"short", VoxelType::int16},
                                                                            {"short int", VoxelType::int16},
                                                                            {"signed short", VoxelType::int16},
                                                                            {"signed short int", VoxelType::int16},
                                                                            {"int16", VoxelType::int16},
                                                                            {"int16_t", VoxelType::int16},
                                                                            {"ushort", VoxelType::uint16},
                                                                            {"unsigned short", VoxelType::uint16},
                                                                            {"unsigned short int", VoxelType::uint16},
                                                                            {"uint16", VoxelType::uint16},
                                                                            {"uint16_t", VoxelType::uint16},
                                                                            {"float", VoxelType::float32}};
        const std::string_view name = required("type");
        const auto found = types.find(lower(name));
        if (found == types.end())
            throw AssetError(
                fmt::format("the NRRD file has voxels of type \"{}\"; taken are uint8, int16, uint16 and float",
                            name.substr(0, 40)));
        return found->second;
    }

    bool gzip() const {
        const std::string encoding = lower(required("encoding"));
        if (encoding == "gzip" || encoding == "gz") return true;
        if (encoding == "raw") return false;
        throw AssetError(
            fmt::format("the NRRD file has the encoding \"{}\"; taken are raw and gzip", encoding.substr(0, 40)));
    }

    bool big_endian() const {
        const std::string endian = lower(required("endian"));
        if (endian != "big" && endian != "little")
            throw AssetError(
                fmt::format("the NRRD field \"endian\" is \"{}\", neither big nor little", endian.substr(0, 40)));
        return endian == "big";
    }

    glm::ivec3 size() const {
        const auto words = three(split(required("sizes"), spaces), "sizes");
        return {number_in<int>(words[0], "sizes"), number_in<int>(words[1], "sizes"),
                number_in<int>(words[2], "sizes")};
    }

    glm::dvec3 spacing() const {
        glm::dvec3 spacing(1);
        std::string field;
        if (m_fields.contains("spacedirections")) {
            field = "spacedirections";
            const auto directions = three(groups_in(required(field)), field);
            for (int axis = 0; axis < 3; ++axis)
                spacing[axis] = length_of(directions[static_cast<std::size_t>(axis)], field);
        } else if (m_fields.contains("spacings")) {
            field = "spacings";
            const auto words = three(split(required(field), spaces), field);
            for (int axis = 0; axis < 3; ++axis)
                spacing[axis] = std::abs(number_in<double>(words[static_cast<std::size_t>(axis)], field));
        }
        for (int axis = 0; axis < 3; ++axis)
            if (!(spacing[axis] >= 1e-9 && spacing[axis] <= 1e9))
                throw AssetError("the NRRD field \"" + field + "\" gives distances between voxels that cannot be used");
        return spacing;
    }

    static double length_of(std::string_view direction, const std::string& field) {
        double squares = 0;
        for (const std::string_view word : three(split(direction, ", \t"), field)) {
            const auto component = number_in<double>(word, field);
            squares += component * component;
        }
        return std::sqrt(squares);
    }

    std::string_view m_bytes;
    std::size_t m_position = 0;
    Fields m_fields;
};

}  // namespace

std::size_t bytes_of(VoxelType type) {
    return type == VoxelType::uint8 ? 1 : type == VoxelType::float32 ? 4 : 2;
}

const char* name_of(VoxelType type) {
    switch (type) {
        case VoxelType::uint8:
            return "uint8";
        case VoxelType::int16:
            return "int16";
        case VoxelType::uint16:
            return "uint16";
        case VoxelType::float32:
            return "float32";
    }
    return "";
}

bool is_nrrd(std::string_view bytes) {
    return bytes.starts_with(magic);
}

NrrdHeader read_nrrd_header(std::string_view bytes) {
    if (!is_nrrd(bytes)) throw AssetError("the file is not an NRRD file");
    return HeaderReader(bytes).read();
}

void check_volume_size(const glm::ivec3& size, VoxelType type) {
    const std::string text = fmt::format("{} x {} x {}", size.x, size.y, size.z);
    for (int axis = 0; axis < 3; ++axis)
        if (size[axis] < 1 || size[axis] > max_volume_side)
            throw AssetError(fmt::format("the volume has {} voxels; each side has 1 to {}", text, max_volume_side));
    const std::size_t voxel_bytes = type == VoxelType::uint8 ? 1 : sizeof(float);
    const auto count =
        static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
    if (count * voxel_bytes > max_volume_bytes)
        throw AssetError(fmt::format("the volume of {} voxels takes {} MiB; at most {} are taken", text,
                                     (count * voxel_bytes) >> 20, max_volume_bytes >> 20));
}

}  // namespace sheer
