#include "renderer/pictures/early_pictures.h"

#include "renderer/core/files.h"

namespace sheer {

using nlohmann::json;

void write_early_pictures(const Run& run, PictureSink& pictures, const std::filesystem::path& folder) {
    json list = json::array();
    const auto add = [&](const std::string& label, const Image& image) {
        if (image.rgba.empty()) return;
        list.push_back({{"label", label}, {"sha256", pictures.take(quantize(image), label).sha256}});
    };
    add("Reference", run.reference_as_shown);
    for (const MethodResult& result : run.results)
        if (result.status == report::ResultStatus::ok) add(result.method.label, result.image);
    const std::filesystem::path file = folder / early_pictures_file, whole = folder / "early.new";
    write_file(whole,
               json{{"point", run.point}, {"pictures", list}}.dump(-1, ' ', true, json::error_handler_t::replace));
    std::filesystem::rename(whole, file);
}

}  // namespace sheer
