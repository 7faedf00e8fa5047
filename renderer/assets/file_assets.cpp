#include "renderer/assets/file_assets.h"

#include "renderer/assets/file_bytes.h"
#include "renderer/assets/picture_file.h"
#include "renderer/assets/read_model.h"
#include "renderer/assets/read_volume.h"

namespace sheer {

Picture FileAssets::picture(const std::string& name, int width_px, int height_px) {
    return read_picture(read_asset_bytes(m_resolve(name)), width_px, height_px);
}

Volume FileAssets::volume(const std::string& name, const std::optional<RawVolume>& raw) {
    return read_volume(read_asset_bytes(m_resolve(name)), raw);
}

Model FileAssets::model(const std::string& name) {
    const std::filesystem::path file = m_resolve(name);
    return read_model(read_asset_bytes(file),
                      m_neighbours == Neighbours::read ? files_below(file.parent_path()) : no_other_files);
}

FileAssets assets_in_folder(std::filesystem::path folder) {
    const auto resolve = [folder = std::move(folder)](const std::string& name) {
        std::filesystem::path file = folder / name;
        if (!std::filesystem::is_regular_file(file)) throw AssetError("there is no file \"" + name + "\"");
        return file;
    };
    return FileAssets(resolve, FileAssets::Neighbours::read);
}

}  // namespace sheer
