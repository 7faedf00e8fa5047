#include "renderer/assets/nrrd_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "renderer/assets/file_bytes.h"
#include "renderer/assets/nrrd_axes.h"
#include "renderer/assets/read_volume.h"
#include "renderer/assets/text_fields.h"

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

/// Fields by their names in lower case without spaces, because some are spelled both with and without.
using Fields = std::map<std::string, std::string_view>;

class HeaderReader {
  public:
    explicit HeaderReader(std::string_view bytes) : m_bytes(bytes) {}

    NrrdHeader read() {
        next_line();
        for (std::string_view line = next_line(); !line.empty(); line = next_line()) add_field(line);
        read_place();
        if (!m_ended && m_header.data_file.empty()) throw AssetError("the header of the NRRD file has no end");
        m_header.data_begin = m_position;
        read_dimension();
        VoxelLayout& layout = m_header.layout;
        layout.type = type();
        layout.encoding = encoding();
        layout.size = size();
        check_volume_size(layout.size, layout.type);
        if (m_header.byte_skip < 0 && layout.encoding != VoxelEncoding::raw)
            throw AssetError("the NRRD field \"byte skip\" is -1, which is allowed only with the encoding raw");
        layout.big_endian = kind_of(layout.type).bytes > 1 && layout.encoding != VoxelEncoding::text && big_endian();
        place_nrrd_axes({field("space"), field("spacedirections"), field("spacings")}, layout, m_header.notes);
        add_notes();
        return m_header;
    }

  private:
    /// "" at the blank line that ends a header, and at the end of a file without one.
    std::string_view next_line() {
        const std::string_view searched = m_bytes.substr(0, max_header_bytes);
        const std::size_t found = searched.find('\n', m_position);
        if (found == std::string_view::npos && searched.size() < m_bytes.size())
            throw AssetError("the header of the NRRD file has no end");
        const std::size_t end = std::min(found, m_bytes.size());
        std::string_view line = m_bytes.substr(std::min(m_position, end), end - std::min(m_position, end));
        m_position = std::min(end + 1, m_bytes.size());
        if (line.ends_with('\r')) line.remove_suffix(1);
        m_ended = line.empty() && found != std::string_view::npos;
        return line;
    }

    void add_field(std::string_view line) {
        if (line.starts_with('#')) return;
        const std::size_t colon = line.find(':');
        if (colon == std::string_view::npos)
            throw AssetError(
                fmt::format("the header of the NRRD file has the line \"{}\", which is not a field", printable(line)));
        if (line.substr(colon).starts_with(":=")) return;
        std::string name = lower(line.substr(0, colon));
        std::erase(name, ' ');
        if (!m_fields.emplace(name, trimmed(line.substr(colon + 1))).second)
            throw AssetError("the NRRD file has the field \"" + printable(name) + "\" twice");
    }

    std::optional<std::string_view> field(const std::string& name) const {
        const auto found = m_fields.find(name);
        return found == m_fields.end() ? std::nullopt : std::optional(found->second);
    }

    std::string_view required(const std::string& name) const {
        const auto found = field(name);
        if (!found) throw AssetError("the NRRD file has no field \"" + name + "\"");
        return *found;
    }

    /// Where the data is.
    void read_place() {
        if (const auto file = field("datafile")) {
            if (file->empty() || *file == "LIST" || file->starts_with("LIST ") || file->find('%') != file->npos)
                throw AssetError("the NRRD file keeps its data in several other files; only one is supported");
            m_header.data_file = *file;
        }
        for (const auto& [name, least, skip] :
             {std::tuple("lineskip", 0, &m_header.line_skip), std::tuple("byteskip", -1, &m_header.byte_skip)}) {
            if (const auto text = field(name)) *skip = number_in<int>(*text, name);
            if (*skip < least)
                throw AssetError(fmt::format("the NRRD field \"{}\" must be at least {}, not {}", name, least, *skip));
        }
    }

    void read_dimension() const {
        if (const auto dimension = number_in<int>(required("dimension"), "dimension"); dimension != 3)
            throw AssetError(fmt::format("the NRRD file has {} dimensions; a volume has 3", dimension));
        if (!field("kinds")) return;
        for (const std::string_view kind : three(split(*field("kinds"), spaces), "kinds"))
            if (const std::string name = lower(kind); name != "domain" && name != "space" && name != "???")
                throw AssetError(
                    fmt::format("the NRRD file has an axis of the kind \"{}\"; a volume of numbers has "
                                "three spatial axes",
                                printable(kind)));
    }

    VoxelType type() const {
        static const std::map<std::string, VoxelType, std::less<>> types = {{"signed char", VoxelType::int8},
                                                                            {"int8", VoxelType::int8},
                                                                            {"int8_t", VoxelType::int8},
                                                                            {"uchar", VoxelType::uint8},
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
                                                                            {"int", VoxelType::int32},
                                                                            {"signed int", VoxelType::int32},
                                                                            {"int32", VoxelType::int32},
                                                                            {"int32_t", VoxelType::int32},
                                                                            {"uint", VoxelType::uint32},
                                                                            {"unsigned int", VoxelType::uint32},
                                                                            {"uint32", VoxelType::uint32},
                                                                            {"uint32_t", VoxelType::uint32},
                                                                            {"float", VoxelType::float32},
                                                                            {"double", VoxelType::float64}};
        const std::string_view name = required("type");
        const auto found = types.find(lower(name));
        if (found == types.end())
            throw AssetError(
                fmt::format("the NRRD file has voxels of type \"{}\"; supported are whole numbers of 8 to 32 "
                            "bits, float and double",
                            printable(name)));
        return found->second;
    }

    VoxelEncoding encoding() const {
        static const std::map<std::string, VoxelEncoding, std::less<>> encodings = {
            {"raw", VoxelEncoding::raw},    {"txt", VoxelEncoding::text},  {"text", VoxelEncoding::text},
            {"ascii", VoxelEncoding::text}, {"hex", VoxelEncoding::hex},   {"gz", VoxelEncoding::gzip},
            {"gzip", VoxelEncoding::gzip},  {"bz2", VoxelEncoding::bzip2}, {"bzip2", VoxelEncoding::bzip2}};
        const std::string_view name = required("encoding");
        const auto found = encodings.find(lower(name));
        if (found == encodings.end())
            throw AssetError(
                fmt::format("the NRRD file has the encoding \"{}\"; supported are raw, ascii, hex, gzip and bzip2",
                            printable(name)));
        return found->second;
    }

    bool big_endian() const {
        const std::string endian = lower(required("endian"));
        if (endian != "big" && endian != "little")
            throw AssetError(
                fmt::format("the NRRD field \"endian\" must be big or little, not \"{}\"", printable(endian)));
        return endian == "big";
    }

    glm::ivec3 size() const {
        const auto words = three(split(required("sizes"), spaces), "sizes");
        return {number_in<int>(words[0], "sizes"), number_in<int>(words[1], "sizes"),
                number_in<int>(words[2], "sizes")};
    }

    void add_notes() {
        if (const auto centerings = field("centerings");
            centerings && lower(*centerings).find("node") != std::string::npos)
            add_note(m_header.notes,
                     {"node-centering-ignored",
                      "The file places samples at the corners of cells; they are drawn as the middles of voxels.", ""});
        if ((field("axismins") || field("axismaxs")) && !field("spacedirections") && !field("spacings"))
            add_note(m_header.notes,
                     {"axis-ranges-ignored",
                      "The fields \"axis mins\" and \"axis maxs\" are ignored; the voxels are drawn as cubes.", ""});
    }

    std::string_view m_bytes;
    std::size_t m_position = 0;
    bool m_ended = false;  ///< by a blank line
    Fields m_fields;
    NrrdHeader m_header;
};

}  // namespace

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
        throw AssetError(fmt::format("the volume of {} voxels takes {} MiB; at most {} are allowed", text,
                                     (count * voxel_bytes) >> 20, max_volume_bytes >> 20));
}

}  // namespace sheer
