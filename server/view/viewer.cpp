#include "server/view/viewer.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <new>
#include <numbers>

#include "renderer/core/errors.h"
#include "renderer/core/files.h"
#include "renderer/counting/loop_check.h"
#include "renderer/pictures/picture_file.h"
#include "server/view/orbit.h"

namespace sheer::view {

namespace {

constexpr double wheel_factor = 0.9, threshold_factor = 1.25, least_threshold = 1e-4;
constexpr int divider_px = 2;
constexpr const char* default_screenshot = "sheer-view.png";

/// The part of the window that the picture fills: as large as fits, in the middle.
struct Frame {
    int x_px, y_px, width_px, height_px;
};
Frame frame_of(const Size& window, const Target& target) {
    const double scale = std::min(static_cast<double>(window.width_px) / target.width_px(),
                                  static_cast<double>(window.height_px) / target.height_px());
    const int width = std::max(1, static_cast<int>(std::lround(target.width_px() * scale)));
    const int height = std::max(1, static_cast<int>(std::lround(target.height_px() * scale)));
    return {(window.width_px - width) / 2, (window.height_px - height) / 2, width, height};
}

}  // namespace

const char* const keys_text =
    "1 to 9     show the method with that number in the spec; 0 shows the reference\n"
    "S          show two methods side by side; the border follows the mouse\n"
    "           1 to 9 and 0 then choose the right one, with Shift the left one\n"
    "+ or Up    raise the threshold of every method shown that has one; - or Down lower it\n"
    "drag       move around the scene; the wheel moves closer or away; R resets the camera\n"
    "P          write the picture to a PNG file\n"
    "H or F1    show this text\n"
    "Esc        quit\n";

Viewer::Viewer(const Spec& spec, const gl::ContextRequest& request, AssetReader& assets, std::string screenshot)
    : m_spec(spec),
      m_assets(assets),
      m_screenshot(std::move(screenshot)),
      m_writes_at_end(!m_screenshot.empty()),
      m_window({spec.image.width_px, spec.image.height_px}, request),
      m_timer(m_window),
      m_choices(spec.methods) {
    if (m_screenshot.empty()) m_screenshot = default_screenshot;
    m_choices.push_back(spec.reference);
    m_choices.back().label = spec.reference.id;
    m_sides[1].choice = 1;
    for (Side& side : m_sides) side.target = std::make_unique<Target>(m_window.gl(), m_spec.image, m_spec.image.format);
    m_divider_px = m_window.size().width_px / 2;
    build_scenes();
    for (const auto& [look, scene] : m_scenes) check_loops(m_window.gl(), *scene, m_spec.image);
}

void Viewer::run() {
    while (!m_window.is_closing()) {
        draw();
        m_window.swap();
        for (const Event& event : m_window.wait()) std::visit([this](const auto& what) { handle(what); }, event);
    }
    if (!m_writes_at_end) return;
    draw();
    write_screenshot();
}

void Viewer::handle(const KeyPress& press) {
    const int key = press.key;
    if (key >= GLFW_KEY_0 && key <= GLFW_KEY_9) {
        const auto number = static_cast<std::size_t>(key - GLFW_KEY_0);
        choose(number == 0 ? m_choices.size() - 1 : number - 1, press.shift || !m_split);
    } else if (key == GLFW_KEY_KP_ADD || key == GLFW_KEY_UP) {
        scale_threshold(threshold_factor);
    } else if (key == GLFW_KEY_KP_SUBTRACT || key == GLFW_KEY_DOWN) {
        scale_threshold(1 / threshold_factor);
    } else if (key == GLFW_KEY_S) {
        m_split = !m_split;
    } else if (key == GLFW_KEY_R && !m_first_camera.is_null()) {
        look_through(m_first_camera);
    } else if (key == GLFW_KEY_P) {
        draw();
        write_screenshot();
    } else if (key == GLFW_KEY_H || key == GLFW_KEY_F1) {
        fmt::print("{}", keys_text);
        std::fflush(stdout);
    } else if (key == GLFW_KEY_ESCAPE) {
        m_window.close();
    }
}

void Viewer::handle(const MouseMove& move) {
    const Size size = m_window.size();
    m_divider_px = std::clamp(static_cast<int>(std::lround(move.at.x)), 0, size.width_px);
    if (!move.dragging || m_first_camera.is_null()) return;
    // The scene follows the mouse: once around for the width, from pole to pole for the height.
    const double turn = -2 * std::numbers::pi * move.moved.x / std::max(1, size.width_px);
    const double rise = std::numbers::pi * move.moved.y / std::max(1, size.height_px);
    look_through(orbited(m_spec.scene.at("camera"), turn, rise));
}

void Viewer::handle(const Wheel& wheel) {
    if (m_first_camera.is_null()) return;
    look_through(moved_away(m_spec.scene.at("camera"), std::pow(wheel_factor, wheel.steps)));
}

void Viewer::choose(std::size_t choice, bool left) {
    if (choice >= m_choices.size()) return;
    Side& side = m_sides[left ? 0 : 1];
    side.choice = choice;
    side.renew();
}

void Viewer::scale_threshold(double factor) {
    std::vector<std::size_t> shown = {m_sides[0].choice};
    if (m_split && m_sides[1].choice != shown[0]) shown.push_back(m_sides[1].choice);
    for (const std::size_t choice : shown) {
        const Param* threshold = find_method(m_choices[choice].id)->saturation();
        if (threshold == nullptr) continue;
        nlohmann::json& value = m_choices[choice].parameters.at(threshold->name);
        const double scaled = std::max(value.get<double>(), least_threshold) * factor;
        value = std::clamp(scaled < least_threshold ? 0 : scaled, threshold->min, threshold->max);
        for (Side& side : m_sides)
            if (side.choice == choice) side.renew();
    }
}

void Viewer::look_through(const nlohmann::json& camera) {
    m_spec.scene["camera"] = camera;
    for (Side& side : m_sides) side.renew();
    m_scenes.clear();
}

void Viewer::draw() {
    if (m_scenes.empty()) build_scenes();
    draw_side(m_sides[0]);
    if (m_split) draw_side(m_sides[1]);
    show_picture();
    m_window.check("showing the picture");
    m_window.set_title(title());
}

void Viewer::build_scenes() {
    Geometry geometry = build_geometry(m_spec.scene, m_spec.image, m_assets);
    if (m_first_camera.is_null() && !geometry.camera.is_null()) {
        m_first_camera = geometry.camera;
        m_spec.scene["camera"] = geometry.camera;
    }
    for (const MethodSpec& choice : m_choices) {
        if (scene_of(choice) != nullptr) continue;
        add_textures(*find_scene(m_spec.scene_type), choice.look, choice.pointer, m_assets, geometry);
        nlohmann::json parameters = m_spec.scene;
        parameters.update(choice.look);
        m_scenes.emplace_back(choice.look, std::make_unique<Scene>(m_window.gl(), geometry, parameters,
                                                                   choice.look.empty() ? "/scene" : choice.pointer));
    }
}

const Scene* Viewer::scene_of(const MethodSpec& choice) const {
    for (const auto& [look, scene] : m_scenes)
        if (look == choice.look) return scene.get();
    return nullptr;
}

void Viewer::draw_side(Side& side) {
    if (side.is_drawn || !side.trouble.empty()) return;
    const std::string doing = "rendering " + m_choices[side.choice].label;
    // The failure of one method is no reason to close the window; the loss of the device is.
    try {
        make_method(side);
        side.frame_ms = render(*side.method, true).wall_ms;
        m_window.check(doing);
        side.is_drawn = true;
    } catch (const ContextLost&) {
        throw;
    } catch (const Unsupported& unsupported) {
        side.trouble = fmt::format("not supported here: {}", unsupported.what());
    } catch (const RenderError& error) {
        side.trouble = fmt::format("failed: {}", error.what());
    } catch (const std::bad_alloc&) {
        side.trouble = "failed: memory ran out";
    }
    if (side.is_drawn) return;
    side.method.reset();
    // Errors that GL still reports belong to this method, not to the next one.
    try {
        m_window.check(doing);
    } catch (const ContextLost&) {
        throw;
    } catch (const RenderError& error) {
        side.trouble += fmt::format("; {}", error.what());
    }
    spdlog::error("{}: {}", m_choices[side.choice].label, side.trouble);
}

/// The first frame, which may compile shaders, is not timed.
void Viewer::make_method(Side& side) {
    const MethodSpec& choice = m_choices[side.choice];
    side.method =
        find_method(choice.id)->make({m_window, m_window.gl(), *scene_of(choice), *side.target}, choice.parameters);
    render(*side.method, false);
}

gl::FrameSample Viewer::render(Method& method, bool timed) {
    gl::FrameTimer::Frame frame = m_timer.frame(timed);
    method.render(m_timer);
    return frame.end();
}

void Viewer::show_picture() const {
    const gl::Functions& gl = m_window.gl();
    const Size window = m_window.size();
    gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl.Disable(GL_SCISSOR_TEST);
    gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    const float surround[] = {0.1f, 0.1f, 0.1f, 1};
    gl.ClearBufferfv(GL_COLOR, 0, surround);
    show_part(m_sides[0], 0, m_split ? m_divider_px : window.width_px);
    if (!m_split) return;
    show_part(m_sides[1], m_divider_px, window.width_px);
    show_divider();
}

/// The columns from `begin_px` up to `end_px` of the window.
void Viewer::show_part(const Side& side, int begin_px, int end_px) const {
    const gl::Functions& gl = m_window.gl();
    const Size window = m_window.size();
    const Frame frame = frame_of(window, *side.target);
    if (!side.trouble.empty() || begin_px >= end_px) return;
    gl.Enable(GL_SCISSOR_TEST);
    gl.Scissor(begin_px, 0, end_px - begin_px, window.height_px);
    const bool enlarged = frame.width_px >= side.target->width_px();
    // Row 0 is the top row of the target but the bottom row of a window.
    gl.BlitNamedFramebuffer(side.target->framebuffer().id(), 0, 0, 0, side.target->width_px(), side.target->height_px(),
                            frame.x_px, frame.y_px + frame.height_px, frame.x_px + frame.width_px, frame.y_px,
                            GL_COLOR_BUFFER_BIT, enlarged ? GL_NEAREST : GL_LINEAR);
    gl.Disable(GL_SCISSOR_TEST);
}

void Viewer::show_divider() const {
    const gl::Functions& gl = m_window.gl();
    gl.Enable(GL_SCISSOR_TEST);
    gl.Scissor(m_divider_px - divider_px / 2, 0, divider_px, m_window.size().height_px);
    const float white[] = {1, 1, 1, 1};
    gl.ClearBufferfv(GL_COLOR, 0, white);
    gl.Disable(GL_SCISSOR_TEST);
}

std::string Viewer::title() const {
    const std::string left = title_of(m_sides[0]);
    return m_split ? fmt::format("{} | {} - Sheer", left, title_of(m_sides[1])) : fmt::format("{} - Sheer", left);
}

std::string Viewer::title_of(const Side& side) const {
    const MethodSpec& method = m_choices[side.choice];
    if (!side.trouble.empty()) return fmt::format("{}: {}", method.label, side.trouble);
    std::string text = fmt::format("{}: {:.2f} ms", method.label, side.frame_ms);
    if (const auto threshold = find_method(method.id)->saturation_of(method.parameters))
        text += fmt::format(", threshold {:.4g}", *threshold);
    return text;
}

/// Writes what has been drawn but not yet swapped. The file is written completely or not at all.
void Viewer::write_screenshot() const {
    const gl::Functions& gl = m_window.gl();
    const Size size = m_window.size();
    std::vector<std::uint8_t> rows(std::size_t(3) * size.width_px * size.height_px);
    gl.NamedFramebufferReadBuffer(0, GL_BACK);
    gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl.ReadPixels(0, 0, size.width_px, size.height_px, GL_RGB, GL_UNSIGNED_BYTE, rows.data());
    Image8 image(size.width_px, size.height_px);
    for (int y = 0; y < size.height_px; ++y)
        std::copy_n(rows.begin() + std::ptrdiff_t(3) * size.width_px * (size.height_px - 1 - y), 3 * size.width_px,
                    image.rgb.begin() + std::ptrdiff_t(3) * size.width_px * y);
    write_file(m_screenshot + ".partial", encode_png(image));
    std::filesystem::rename(m_screenshot + ".partial", m_screenshot);
    fmt::print("Wrote {}\n", m_screenshot);
    std::fflush(stdout);
}

}  // namespace sheer::view
