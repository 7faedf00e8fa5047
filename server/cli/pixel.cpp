// Takes a pixel of a report apart: every fragment under it, and what each method made of them.
#include "renderer/files/pixel.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>

#include "renderer/assets/file_assets.h"
#include "renderer/compare.h"
#include "renderer/files/blob_sink.h"
#include "renderer/report/report.h"
#include "server/archive/blob_store.h"
#include "server/cli/commands.h"
#include "server/cli/failure.h"
#include "server/cli/rendering.h"

namespace sheer::cli {

namespace {

using nlohmann::json;

struct PixelArguments {
    std::string file, base, data;
    int x = 0, y = 0, run = 0;
    bool as_json = false;
    gl::ContextRequest context;
};

/// Pictures by their SHA-256.
class MemorySink : public BlobSink {
  public:
    std::string put(const std::string& sha256, const std::string& bytes, const std::string&,
                    const std::string&) override {
        m_pictures[sha256] = bytes;
        return sha256;
    }
    std::string read(const json& image) const { return m_pictures.at(image.at("sha256").get<std::string>()); }

  private:
    std::map<std::string, std::string> m_pictures;
};

/// What is given: a report with its pictures, or a spec to make them from.
class Subject {
  public:
    explicit Subject(const PixelArguments& options) : m_options(options) {
        if (!std::filesystem::exists(file())) throw UsageError("there is no file " + file().string());
        const json document = json::parse(read_text(file()), nullptr, false);
        if (document.is_discarded()) throw UsageError(file().string() + " is not JSON");
        m_is_report = document.is_object() && document.contains("runs") && document.contains("spec");
        m_spec = parse_spec(m_is_report ? document["spec"] : document);
        if (m_is_report) {
            m_runs = document["runs"];
            m_spec_file = document.value("/provenance/spec"_json_pointer, "");
        }
        check_pixel();
    }

    json report() {
        const auto context = gl::open_device(m_options.context);
        const Spec spec = spec_at(m_spec, point());
        FileAssets assets = make_assets();
        const PixelStack stack = take_apart(spec, *context, assets);
        if (m_is_report) {
            const auto read = [this](const json& image) { return read_picture(image); };
            return pixel_report(stack, m_options.x, m_options.y, m_runs.at(index()), read);
        }
        MemorySink sink;
        json run = render(spec, *context, assets, sink);
        run["point"] = point();
        return pixel_report(stack, m_options.x, m_options.y, run, [&](const json& image) { return sink.read(image); });
    }

  private:
    std::filesystem::path file() const {
        const std::filesystem::path path = m_options.file;
        return std::filesystem::is_directory(path) ? path / "report.json" : path;
    }

    /// Of a report it is the folder that its spec was in, where that is still there.
    std::filesystem::path base() const {
        if (!m_options.base.empty()) return m_options.base;
        const std::filesystem::path of_spec = std::filesystem::path(m_spec_file).parent_path();
        std::error_code ignored;
        return !of_spec.empty() && std::filesystem::is_directory(of_spec, ignored) ? of_spec : file().parent_path();
    }

    std::size_t index() const { return static_cast<std::size_t>(m_options.run); }
    const SweepPoint& point() const { return m_spec.points[index()]; }

    void check_pixel() const {
        const std::size_t runs = m_is_report ? m_runs.size() : m_spec.points.size();
        if (m_options.run < 0 || index() >= std::min(runs, m_spec.points.size()))
            throw UsageError(fmt::format("--run must be in 0 to {}", std::min(runs, m_spec.points.size()) - 1));
        const ImageSpec image = spec_at(m_spec, point()).image;
        if (m_options.x < 0 || m_options.x >= image.width_px)
            throw UsageError(fmt::format("--x must be in 0 to {}", image.width_px - 1));
        if (m_options.y < 0 || m_options.y >= image.height_px)
            throw UsageError(fmt::format("--y must be in 0 to {}", image.height_px - 1));
    }

    PixelStack take_apart(const Spec& spec, gl::Context& context, FileAssets& assets) const {
        try {
            PixelStack stack = take_pixel_apart(spec, context, assets, m_options.x, m_options.y);
            check_unchanged(spec, assets);
            return stack;
        } catch (const SpecError&) {
            // A file that cannot be used any more is most likely another one.
            check_unchanged(spec, assets);
            throw;
        }
    }

    /// Throws UsageError for a file that is not what the report's pictures were made from. Reports made before files
    /// were named have none.
    void check_unchanged(const Spec& spec, const FileAssets& assets) const {
        if (!m_is_report || !m_runs.at(index()).contains("files")) return;
        const json& then = m_runs.at(index())["files"];
        for (const json& now : to_json(source_files(spec.scene, assets))) {
            const auto is_of_name = [&](const json& file) {
                return file["name"] == now["name"] && file["of"] == now["of"];
            };
            const auto before = std::ranges::find_if(then, is_of_name);
            if (before != then.end() && (*before)["sha256"] != now["sha256"])
                throw UsageError(fmt::format(
                    "{} has changed since the report was made: its SHA-256 was {} and is {}, so its fragments are not "
                    "those of the report's pictures",
                    now["name"].get<std::string>(), (*before)["sha256"].get<std::string>(),
                    now["sha256"].get<std::string>()));
        }
    }

    FileAssets make_assets() const {
        if (m_options.data.empty()) return assets_in_folder(base());
        return FileAssets(uploads_in(std::filesystem::path(m_options.data) / "assets"));
    }

    std::string read_picture(const json& image) const {
        if (!m_options.data.empty()) {
            const BlobStore blobs(std::filesystem::path(m_options.data) / "blobs");
            try {
                return read_text(blobs.find_whole(image.at("sha256")));
            } catch (const DamagedFile& damaged) {
                throw UsageError(fmt::format("a picture of the report is damaged: {}", damaged.what()));
            }
        }
        return read_text(file().parent_path() / image.at("url").get<std::string>());
    }

    /// The comparison at this point alone, timed no longer than it must be.
    static json render(Spec spec, gl::Context& context, AssetReader& assets, PictureSink& pictures) {
        spec.timing.rounds = 1;
        ReportMaker maker(spec, describe_device(context), &pictures, utc_now());
        compare(
            spec, context, assets, [](double, const std::string&) {}, [&](const Run& run) { maker.add(run); });
        return maker.finish()["runs"][0];
    }

    const PixelArguments& m_options;
    bool m_is_report = false;
    Spec m_spec;
    std::string m_spec_file;  ///< the path of the report's spec; "" if it does not say
    json m_runs;
};

int print_pixel(const PixelArguments& options) {
    fmt::print("{}", pixel_table(Subject(options).report()));
    return exit_ok;
}

/// One line, also for what went wrong.
int print_json(const PixelArguments& options) {
    json line;
    int exit_code = exit_ok;
    try {
        line = Subject(options).report();
    } catch (const UsageError& error) {
        line = {{"error", {{"kind", "usage"}, {"detail", error.what()}, {"errors", json::array()}}}};
        exit_code = exit_bad_spec;
    } catch (const std::exception& error) {
        const Failure failure = describe_failure(error);
        if (!failure.is_for_caller) spdlog::error("taking a pixel apart failed: {}", error.what());
        line = failure.message;
        exit_code = failure.exit_code;
    }
    fmt::print("{}\n", line.dump(-1, ' ', false, json::error_handler_t::replace));
    return exit_code;
}

}  // namespace

void add_pixel(CLI::App& app, int& exit_code) {
    CLI::App* command =
        app.add_subcommand("pixel", "Show every fragment under a pixel and what the methods made of it");
    auto options = std::make_shared<PixelArguments>();
    command
        ->add_option("file", options->file, "A report: its folder or report.json; or a spec, which is rendered first")
        ->required();
    command->add_option("--x", options->x, "Column of the pixel, from the left, from 0")->required();
    command->add_option("--y", options->y, "Row of the pixel, from the top, from 0")->required();
    command->add_option("--run", options->run, "Which point of the sweep, from 0")->capture_default_str();
    command->add_flag("--json", options->as_json, "As GET /reports/{id}/pixel answers, on one line");
    command->add_option("--base", options->base,
                        "Folder that paths in the spec start from; if not given, the one that the spec was in");
    command->add_option("--data", options->data, "The service's folder, which then has the pictures and uploaded files")
        ->group("");
    add_context_options(*command, options->context);
    command->callback([options, &exit_code] {
        exit_code = options->as_json ? print_json(*options) : guarded([&] { return print_pixel(*options); });
    });
}

}  // namespace sheer::cli
