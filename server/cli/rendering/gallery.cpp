// Every method on every scene in one picture, and the scenes' thumbnails for the page: ./dev gallery.
#include <fmt/format.h>
#include <openssl/evp.h>

#include "renderer/assets/file_assets.h"
#include "renderer/compare/compare.h"
#include "renderer/core/files.h"
#include "renderer/methods/shared/method.h"
#include "renderer/pictures/picture_file.h"
#include "server/cli/rendering/commands.h"
#include "server/cli/rendering/rendering.h"

namespace sheer::cli {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int thumbnail_px = 320;
constexpr int size_px = 128, gap_px = 6, label_px = 22, left_px = 120;

struct GalleryArguments {
    std::vector<std::string> specs;
    std::string out, thumbnails;
    gl::ContextRequest context;
};

/// A small version of a spec's picture by every method.
Spec small_spec(const std::string& path) {
    json document = json::parse(read_file(path));
    for (const char* field : {"checks", "sweep", "baseline", "suite"}) document.erase(field);
    document["image"].update({{"width", size_px}, {"height", size_px}, {"format", "rgba8"}});
    document["timing"] = {{"warmup", 1}, {"rounds", 1}};
    document["methods"] = json::array();
    for (const MethodInfo& method : all_methods()) document["methods"].push_back(method.id);
    return parse_spec(document);
}

/// The reference's picture of a spec, as large as a card of the page.
Image thumbnail(const std::string& path, gl::Context& context, AssetReader& assets) {
    json document = json::parse(read_file(path));
    for (const char* field : {"checks", "sweep", "baseline", "suite"}) document.erase(field);
    document["image"].update({{"width", thumbnail_px}, {"height", thumbnail_px}, {"format", "rgba8"}});
    document["timing"] = {{"warmup", 1}, {"rounds", 1}};
    document["methods"] = {"unsorted"};
    Image picture;
    compare(
        parse_spec(document), context, assets, [](double, const std::string&) {},
        [&picture](const Run& run) { picture = run.reference_image; });
    return picture;
}

std::string base64(const std::string& bytes) {
    std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');
    const int length =
        EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                        reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
    text.resize(static_cast<std::size_t>(length));
    return text;
}

/// Rows of labelled pictures as one self-contained SVG file.
class Sheet {
  public:
    void add(const Run& run, const std::string& name) {
        const int top = m_rows++ * (size_px + gap_px) + label_px + gap_px;
        m_body += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>\n", left_px - gap_px,
                              top + size_px / 2, name);
        int column = 0;
        for (const MethodResult& result : run.results) {
            const int left = left_px + column++ * (size_px + gap_px);
            if (m_rows == 1)
                m_body += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", left + size_px / 2,
                                      label_px - gap_px / 2, result.method.id);
            m_body += result.status == report::ResultStatus::ok ? picture(result.image, left, top)
                                                                : missing(word_of(result.status), left, top);
        }
        m_columns = std::max(m_columns, column);
    }

    std::string svg() const {
        const int width = left_px + m_columns * (size_px + gap_px);
        const int height = label_px + gap_px + m_rows * (size_px + gap_px);
        return fmt::format(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
            "font-family=\"sans-serif\" font-size=\"11\" fill=\"#222\">\n<rect width=\"{0}\" height=\"{1}\" "
            "fill=\"#fff\"/>\n{2}</svg>\n",
            width, height, m_body);
    }

  private:
    static std::string picture(const Image& image, int left, int top) {
        return fmt::format("<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" href=\"data:image/jpeg;base64,{}\"/>\n",
                           left, top, size_px, size_px, base64(encode_jpeg(quantize(image))));
    }
    static std::string missing(const std::string& status, int left, int top) {
        return fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", left + size_px / 2,
                           top + size_px / 2, status);
    }

    std::string m_body;
    int m_rows = 0, m_columns = 0;
};

int run_gallery(const GalleryArguments& options) {
    const auto context = gl::open_device(options.context);
    if (!options.thumbnails.empty()) fs::create_directories(fs::path(options.thumbnails) / "specs");
    Sheet sheet;
    for (const std::string& path : options.specs) {
        const Spec spec = small_spec(path);
        FileAssets assets = assets_in_folder(fs::path(path).parent_path());
        const std::string name = fs::path(path).stem().string();
        const auto take = [&](const Run& run) {
            sheet.add(run, name);
            if (!options.thumbnails.empty())
                write_file(fs::path(options.thumbnails) / (spec.scene_type + ".png"),
                           encode_png(quantize(run.reference_image)));
        };
        fmt::print("{}\n", path);
        if (!options.thumbnails.empty())
            write_file(fs::path(options.thumbnails) / "specs" / (name + ".jpg"),
                       encode_jpeg(quantize(thumbnail(path, *context, assets))));
        compare(
            spec, *context, assets, [](double, const std::string&) {}, take);
    }
    write_file(options.out, sheet.svg());
    return exit_ok;
}

}  // namespace

void add_gallery(CLI::App& app, int& exit_code) {
    CLI::App* command =
        app.add_subcommand("gallery", "One picture with every method on the scenes of specs")->group("");
    auto options = std::make_shared<GalleryArguments>();
    command->add_option("specs", options->specs, "Specs, one row for each")->required();
    command->add_option("--out", options->out, "The SVG file")->required();
    command->add_option("--thumbnails", options->thumbnails, "Folder for a PNG of each scene type");
    add_context_options(*command, options->context);
    command->callback([options, &exit_code] { exit_code = guarded([&] { return run_gallery(*options); }); });
}

}  // namespace sheer::cli
