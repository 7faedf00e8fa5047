#pragma once
#include <filesystem>
#include <functional>

#include "renderer/scene/assets.h"

namespace sheer {

/// Reads the files that a spec refers to: PNG, JPEG and OpenEXR pictures; NRRD and raw volumes; glTF models.
class FileAssets : public AssetReader {
  public:
    /// From the name in the spec to the file; throws AssetError for one that must not be read or does not exist.
    using Resolver = std::function<std::filesystem::path(const std::string& name)>;

    /// Whether a model, or a detached NRRD header, may read files in its folder and below: only if the user has chosen
    /// the file on this machine.
    enum class Neighbours { refused, read };

    explicit FileAssets(Resolver resolve, Neighbours neighbours = Neighbours::refused)
        : m_resolve(std::move(resolve)), m_neighbours(neighbours) {}
    Picture picture(const std::string& name, int width_px, int height_px) override;
    Volume volume(const std::string& name, const VolumeOptions& options) override;
    Model model(const std::string& name) override;
    std::vector<AssetFile> files() const override { return m_files; }

  private:
    std::string read(const std::string& name);
    /// Reads files in the folder of the file `name` and below, and remembers each one that is read.
    std::function<std::string(const std::string& other)> neighbours_of(const std::string& name);
    void remember(const std::string& name, const std::string& of, std::string_view bytes);

    Resolver m_resolve;
    Neighbours m_neighbours;
    std::vector<AssetFile> m_files;
};

/// Names are paths, relative to `folder` unless they are absolute. Errors about missing files name the path, so this is
/// for users of this machine only.
FileAssets assets_in_folder(std::filesystem::path folder);

}  // namespace sheer
