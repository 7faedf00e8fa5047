// Explains a pixel of a report: every fragment under it, and each method's result.
#include "renderer/pictures/pixel.h"
#include "renderer/core/files.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>

#include "renderer/assets/file_assets.h"
#include "renderer/compare/looks.h"
#include "renderer/core/clock.h"
#include "renderer/files/report_document.h"
#include "renderer/params/json_text.h"
#include "renderer/pictures/blob_sink.h"
#include "renderer/report/report.h"
#include "server/cli/rendering/commands.h"
#include "server/cli/rendering/failure.h"
#include "server/cli/rendering/rendering.h"
#include "server/cli/rendering/sandbox_option.h"
#include "server/cli/rendering/shader_folder.h"
#include "server/storage/content_folder.h"

namespace sheer::cli {

namespace {

using nlohmann::json;

struct PixelArguments {
    std::string file, base, data;
    int x = 0, y = 0, run = 0;
    bool as_json = false;
    gl::ContextRequest context;
    SandboxOption sandbox;
    ShaderFolder shaders;
};

/// Pictures by their SHA-256.
class MemorySink : public BlobSink {
  public:
    std::string put(const std::string& sha256, const std::string& bytes, const std::string&,
                    const std::string&) override {
        m_pictures[sha256] = bytes;
        return sha256;
    }
    std::string read(const report::Picture& picture) const { return m_pictures.at(picture.sha256); }

  private:
    std::map<std::string, std::string> m_pictures;
};

/// The input: a report with its pictures, or a spec from which they are rendered.
class Subject {
  public:
    explicit Subject(const PixelArguments& options) : m_options(options) {
        if (!std::filesystem::exists(file())) throw UsageError("there is no file " + file().string());
        const json document = json::parse(read_file(file()), nullptr, false);
        if (document.is_discarded()) throw UsageError(file().string() + " is not JSON");
        m_is_report = document.is_object() && document.contains("runs") && document.contains("spec");
        m_spec = parse_spec(m_is_report ? document["spec"] : document);
        if (m_is_report) read(document);
        check_pixel();
    }

    pixel::Pixel pixel() {
        const auto context = gl::open_device(m_options.context);
        m_options.sandbox.confine_calls();
        const Spec spec = spec_at(m_spec, point());
        FileAssets assets = make_assets();
        const PixelStack stack = explain(spec, *context, assets);
        if (m_is_report) {
            const auto read = [this](const report::Picture& picture) { return read_picture(picture); };
            return pixel_report(stack, m_options.x, m_options.y, m_report.runs.at(index()), read);
        }
        MemorySink sink;
        report::Run run = render(spec, *context, assets, sink);
        run.point = point();
        return pixel_report(stack, m_options.x, m_options.y, run,
                            [&](const report::Picture& picture) { return sink.read(picture); });
    }

  private:
    void read(const json& document) {
        try {
            m_report = read_report(document);
        } catch (const DocumentError& wrong) {
            throw UsageError(fmt::format("{} is not a report: {}", file().string(), wrong.what()));
        }
    }

    std::filesystem::path file() const {
        const std::filesystem::path path = m_options.file;
        return std::filesystem::is_directory(path) ? path / "report.json" : path;
    }

    /// For a report, the folder of its spec, if it still exists.
    std::filesystem::path base() const {
        if (!m_options.base.empty()) return m_options.base;
        const std::filesystem::path of_spec = std::filesystem::path(m_report.provenance.spec).parent_path();
        std::error_code ignored;
        return !of_spec.empty() && std::filesystem::is_directory(of_spec, ignored) ? of_spec : file().parent_path();
    }

    std::size_t index() const { return static_cast<std::size_t>(m_options.run); }
    const SweepPoint& point() const { return m_spec.points[index()]; }

    void check_pixel() const {
        const std::size_t runs = m_is_report ? m_report.runs.size() : m_spec.points.size();
        if (m_options.run < 0 || index() >= std::min(runs, m_spec.points.size()))
            throw UsageError(fmt::format("--run must be from 0 to {}", std::min(runs, m_spec.points.size()) - 1));
        const ImageSpec image = spec_at(m_spec, point()).image;
        if (m_options.x < 0 || m_options.x >= image.width_px)
            throw UsageError(fmt::format("--x must be from 0 to {}", image.width_px - 1));
        if (m_options.y < 0 || m_options.y >= image.height_px)
            throw UsageError(fmt::format("--y must be from 0 to {}", image.height_px - 1));
    }

    PixelStack explain(const Spec& spec, gl::Context& context, FileAssets& assets) const {
        try {
            PixelStack stack = explain_pixel(spec, context, assets, m_options.x, m_options.y);
            check_unchanged(spec, assets);
            return stack;
        } catch (const SpecError&) {
            // A file that can no longer be used has most likely been changed.
            check_unchanged(spec, assets);
            throw;
        }
    }

    /// Throws UsageError for a file that is not the one from which the report's pictures were made. Older reports do
    /// not list files.
    void check_unchanged(const Spec& spec, const FileAssets& assets) const {
        if (!m_is_report) return;
        const std::vector<report::File>& then = m_report.runs.at(index()).files;
        for (const auto& [pointer, now] : source_files_of(spec, assets)) {
            const auto is_of_name = [&now = now](const report::File& file) {
                return file.name == now.name && file.of == now.of;
            };
            const auto before = std::ranges::find_if(then, is_of_name);
            if (before != then.end() && before->sha256 != now.sha256)
                throw UsageError(fmt::format(
                    "{} has changed since the report was made: its SHA-256 was {} and is {}, so its fragments are not "
                    "those of the report's pictures",
                    now.name, before->sha256, now.sha256));
        }
    }

    FileAssets make_assets() const {
        if (m_options.data.empty()) return assets_in_folder(base());
        return FileAssets(uploads_of(m_options.data));
    }

    std::string read_picture(const report::Picture& picture) const {
        if (!m_options.data.empty()) {
            try {
                return stored_pictures(m_options.data)(picture);
            } catch (const DamagedData& damaged) {
                throw UsageError(fmt::format("a picture of the report is damaged: {}", damaged.what()));
            }
        }
        return read_file(file().parent_path() / picture.url);
    }

    /// The comparison at this point only, timed as briefly as possible.
    static report::Run render(Spec spec, gl::Context& context, AssetReader& assets, PictureSink& pictures) {
        spec.timing.rounds = 1;
        ReportMaker maker(spec, describe_device(context), &pictures, utc_now());
        compare(
            spec, context, assets, [](double, const std::string&) {}, [&](const Run& run) { maker.add(run); });
        return maker.finish().runs.at(0);
    }

    const PixelArguments& m_options;
    bool m_is_report = false;
    Spec m_spec;
    report::Report m_report;  ///< if the input is a report
};

int print_pixel(const PixelArguments& options) {
    fmt::print("{}", pixel_table(Subject(options).pixel()));
    return exit_ok;
}

/// One line, also for errors.
int print_json(const PixelArguments& options) {
    json line;
    int exit_code = exit_ok;
    try {
        OpenFiles files = stored_files(options.data);
        options.shaders.open(files);
        options.sandbox.confine_files(std::move(files));
        line = to_document(Subject(options).pixel());
    } catch (const UsageError& error) {
        line = {{"error", {{"kind", "usage"}, {"detail", error.what()}, {"errors", json::array()}}}};
        exit_code = exit_bad_spec;
    } catch (const std::exception& error) {
        const Failure failure = describe_failure(error);
        if (!failure.is_for_caller) spdlog::error("explaining a pixel failed: {}", error.what());
        line = failure.message;
        exit_code = failure.exit_code;
    }
    fmt::print("{}\n", json_line(line));
    return exit_code;
}

}  // namespace

void add_pixel(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("pixel", "Show every fragment under a pixel and the methods' results");
    auto options = std::make_shared<PixelArguments>();
    command
        ->add_option("file", options->file, "A report (its folder or report.json), or a spec, which is rendered first")
        ->required();
    command->add_option("--x", options->x, "Column of the pixel from the left, from 0")->required();
    command->add_option("--y", options->y, "Row of the pixel from the top, from 0")->required();
    command->add_option("--run", options->run, "Index of the point of the sweep, from 0")->capture_default_str();
    command->add_flag("--json", options->as_json, "Print the answer of GET /reports/{id}/pixel, on one line");
    command->add_option("--base", options->base,
                        "Folder to which paths in the spec are relative; by default the spec's own folder");
    command->add_option("--data", options->data, "The service's folder with the pictures and uploaded files")
        ->group("");
    add_context_options(*command, options->context);
    options->sandbox.add_to(*command);
    options->shaders.add_to(*command);
    command->footer("Example: sheer pixel out --x 200 --y 120");
    command->callback([options, &exit_code] {
        exit_code = options->as_json ? print_json(*options) : guarded([&] { return print_pixel(*options); });
    });
}

}  // namespace sheer::cli
