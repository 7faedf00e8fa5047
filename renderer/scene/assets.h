#pragma once
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "renderer/scene/model.h"
#include "renderer/scene/picture.h"
#include "renderer/scene/volume.h"

namespace sheer {

/// What a file of voxels without a header holds.
struct RawVolume {
    glm::ivec3 size;
    glm::dvec3 spacing{1};
    std::string voxel;  ///< int8, uint8, int16, uint16, int32, uint32, float32 or float64
    bool big_endian = false;
};

/// What a spec says about a volume's file.
struct VolumeOptions {
    std::optional<RawVolume> raw;     ///< none: the file has a header
    std::optional<glm::dvec2> range;  ///< the values that become 0 and 1, x < y; none: the least and the greatest
};

/// A file that was read, identified by its contents.
struct AssetFile {
    std::string name;    ///< as an AssetReader takes it; of a file beside a model, below the same folder as the model's
    std::string of;      ///< the name of the file that needs it; "" for one that the spec itself names
    std::string sha256;  ///< lower-case hexadecimal
    std::uint64_t bytes = 0;

    bool operator==(const AssetFile&) const = default;
};

/// A file is not what the spec says it is, or does not exist; the text is for the caller and names no path of the host.
class AssetError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Reads the files that a spec refers to. The core knows no file formats, so a benchmark can do without them.
///
/// `name` is the text in the spec: the SHA-256 of an uploaded asset, or a path for `sheer compare`. All throw
/// AssetError.
class AssetReader {
  public:
    virtual ~AssetReader() = default;
    /// Scaled to width x height by area-averaging or cubic interpolation, whatever its own shape.
    virtual Picture picture(const std::string& name, int width_px, int height_px) = 0;
    /// NRRD, unless the options say what the file holds.
    virtual Volume volume(const std::string& name, const VolumeOptions& options) = 0;
    /// A glTF 2.0 file.
    virtual Model model(const std::string& name) = 0;
    /// Every file that was read so far, including those that models refer to, as it was when it was last read.
    virtual std::vector<AssetFile> files() const { return {}; }
};

/// For programs without files: everything is an AssetError.
class NoAssets : public AssetReader {
  public:
    Picture picture(const std::string& name, int, int) override { refuse(name); }
    Volume volume(const std::string& name, const VolumeOptions&) override { refuse(name); }
    Model model(const std::string& name) override { refuse(name); }

  private:
    [[noreturn]] static void refuse(const std::string& name) {
        throw AssetError("there are no assets here, so \"" + name + "\" cannot be read");
    }
};

}  // namespace sheer
