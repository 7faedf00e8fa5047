#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "renderer/methods/shared/method.h"
#include "renderer/scene/assets.h"
#include "renderer/spec/spec.h"
#include "server/view/window.h"

namespace sheer::view {

/// What `sheer view` prints for the key H.
extern const char* const keys_text;

/// Shows a spec's scene in a window: one method, or two side by side, drawn again after each change.
class Viewer {
  public:
    /// Throws SpecError for a scene that cannot be built, Unsupported without a display. `screenshot` is the PNG file
    /// written by P and at the end of run(); if it is "", only P writes one, to sheer-view.png.
    Viewer(const Spec& spec, const gl::ContextRequest& request, AssetReader& assets, std::string screenshot);

    /// Runs until the window is closed. Throws RenderError.
    void run();

  private:
    /// Half of the window, or all of it.
    struct Side {
        std::size_t choice = 0;  ///< index into m_choices
        std::unique_ptr<Target> target;
        std::unique_ptr<Method> method;
        bool is_drawn = false;  ///< the target holds the method's picture of the scene
        std::string trouble;    ///< why the method cannot draw; "" if it can
        double frame_ms = 0;
        /// Called before something it depends on changes.
        void renew() {
            method.reset();
            is_drawn = false;
            trouble.clear();
        }
    };

    void handle(const KeyPress& press);
    void handle(const MouseMove& move);
    void handle(const Wheel& wheel);
    void choose(std::size_t choice, bool left);
    void scale_threshold(double factor);
    void look_through(const nlohmann::json& camera);

    void draw();
    void build_scenes();
    /// Null if it has not been built.
    const Scene* scene_of(const MethodSpec& choice) const;
    void draw_side(Side& side);
    void make_method(Side& side);
    gl::FrameSample render(Method& method, bool timed);
    void show_picture() const;
    void show_part(const Side& side, int begin_px, int end_px) const;
    void show_divider() const;
    std::string title() const;
    std::string title_of(const Side& side) const;
    void write_screenshot() const;

    Spec m_spec;
    AssetReader& m_assets;
    std::string m_screenshot;
    bool m_writes_at_end;
    Window m_window;
    gl::FrameTimer m_timer;
    std::vector<MethodSpec> m_choices;  ///< the spec's methods, then its reference
    nlohmann::json m_first_camera;      ///< null for a scene without one
    /// The scene in each look (MethodSpec::look) of the methods; empty if it has to be built.
    std::vector<std::pair<nlohmann::json, std::unique_ptr<Scene>>> m_scenes;
    std::array<Side, 2> m_sides;  ///< left, right; without a split the left one fills the window
    bool m_split = false;
    int m_divider_px = 0;  ///< in the window's picture
};

}  // namespace sheer::view
