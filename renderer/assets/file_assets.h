#pragma once
#include <filesystem>
#include <functional>

#include "renderer/scene/assets.h"

namespace sheer {

/// Reads the files that a spec refers to: PNG, JPEG and OpenEXR pictures; NRRD and raw volumes; glTF models.
class FileAssets : public AssetReader {
  public:
    /// From the name in the spec to the file; throws AssetError for one that may not be read or is not there.
    using Resolver = std::function<std::filesystem::path(const std::string& name)>;

    /// Whether a model, or a detached NRRD header, may read the files beside it and below: for files that the user has
    /// chosen on this machine.
    enum class Neighbours { refused, read };

    explicit FileAssets(Resolver resolve, Neighbours neighbours = Neighbours::refused)
        : m_resolve(std::move(resolve)), m_neighbours(neighbours) {}
    Picture picture(const std::string& name, int width_px, int height_px) override;
    Volume volume(const std::string& name, const VolumeOptions& options) override;
    Model model(const std::string& name) override;
    std::vector<AssetFile> files() const override { return m_files; }

  private:
    std::string read(const std::string& name);
    /// Those beside the file `name` and below; every one that is read is remembered.
    std::function<std::string(const std::string& other)> neighbours_of(const std::string& name);
    void remember(const std::string& name, const std::string& of, std::string_view bytes);

    Resolver m_resolve;
    Neighbours m_neighbours;
    std::vector<AssetFile> m_files;
};

/// Names are paths, those that are not absolute within `folder`. What is not there is told with the path that was
/// looked at, so this is for whoever sits at this machine.
FileAssets assets_in_folder(std::filesystem::path folder);

}  // namespace sheer
