#include "renderer/assets/file_assets.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/assets/file_bytes.h"
#include "renderer/assets/picture_file.h"
#include "renderer/assets/read_model.h"
#include "renderer/assets/read_volume.h"
#include "renderer/core/sha256.h"

namespace sheer {

Picture FileAssets::picture(const std::string& name, int width_px, int height_px) {
    return read_picture(read(name), width_px, height_px);
}

Volume FileAssets::volume(const std::string& name, const VolumeOptions& options) {
    if (m_neighbours == Neighbours::refused) return read_volume(read(name), options);
    return read_volume(read(name), options, neighbours_of(name));
}

Model FileAssets::model(const std::string& name) {
    if (m_neighbours == Neighbours::refused) return read_model(read(name), no_other_files);
    return read_model(read(name), neighbours_of(name));
}

std::function<std::string(const std::string& other)> FileAssets::neighbours_of(const std::string& name) {
    return [this, name, others = files_below(m_resolve(name).parent_path())](const std::string& other) {
        std::string bytes = others(other);
        remember((std::filesystem::path(name).parent_path() / other).lexically_normal().generic_string(), name, bytes);
        return bytes;
    };
}

std::string FileAssets::read(const std::string& name) {
    std::string bytes = read_asset_bytes(m_resolve(name));
    remember(name, "", bytes);
    return bytes;
}

void FileAssets::remember(const std::string& name, const std::string& of, std::string_view bytes) {
    const AssetFile file{name, of, sha256_hex(bytes), bytes.size()};
    const auto known = std::ranges::find_if(
        m_files, [&](const AssetFile& other) { return other.name == file.name && other.of == file.of; });
    if (known == m_files.end()) {
        m_files.push_back(file);
    } else {
        *known = file;
    }
}

FileAssets assets_in_folder(std::filesystem::path folder) {
    const auto resolve = [folder = std::move(folder)](const std::string& name) {
        std::filesystem::path file = folder / name;
        std::error_code error;
        if (!std::filesystem::is_regular_file(file, error))
            throw AssetError(fmt::format("there is no file \"{}\"; looked for it at {}", name,
                                         std::filesystem::absolute(file).lexically_normal().string()));
        return file;
    };
    return FileAssets(resolve, FileAssets::Neighbours::read);
}

}  // namespace sheer
