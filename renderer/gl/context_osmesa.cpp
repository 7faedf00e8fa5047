#include <array>
#include <cstdint>

#include "renderer/core/errors.h"
#include "renderer/gl/context_kinds.h"
// After glad, which must be included before <GL/gl.h>, which this header includes.
#include <GL/osmesa.h>

namespace sheer::gl {
namespace {

class OsmesaHandle {
  public:
    OsmesaHandle() {
        constexpr std::array<int, 11> attributes{OSMESA_FORMAT,
                                                 OSMESA_RGBA,
                                                 OSMESA_DEPTH_BITS,
                                                 0,
                                                 OSMESA_PROFILE,
                                                 OSMESA_CORE_PROFILE,
                                                 OSMESA_CONTEXT_MAJOR_VERSION,
                                                 4,
                                                 OSMESA_CONTEXT_MINOR_VERSION,
                                                 5,
                                                 0};
        m_context = OSMesaCreateContextAttribs(attributes.data(), nullptr);
        if (m_context == nullptr) throw Unsupported("OSMesa has no OpenGL 4.5 core context");
    }
    OsmesaHandle(const OsmesaHandle&) = delete;
    OsmesaHandle& operator=(const OsmesaHandle&) = delete;
    ~OsmesaHandle() {
        if (OSMesaGetCurrentContext() == m_context) OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0);
        OSMesaDestroyContext(m_context);
    }

    void make_current() {
        if (OSMesaMakeCurrent(m_context, m_pixels.data(), GL_UNSIGNED_BYTE, width_px, height_px) == GL_FALSE) {
            throw RenderError("the OSMesa context cannot be made current");
        }
    }

  private:
    // OSMesa has no context without a drawable; rendering goes to framebuffer objects, so the smallest will do.
    static constexpr int width_px = 1;
    static constexpr int height_px = 1;
    alignas(16) std::array<std::uint8_t, 4 * width_px * height_px> m_pixels{};
    OSMesaContext m_context = nullptr;
};

class OsmesaContext final : public Context {
  public:
    OsmesaContext(const DeviceInfo& info, const ContextRequest& request) {
        m_handle.make_current();
        initialize([](const char* name) { return reinterpret_cast<void*>(OSMesaGetProcAddress(name)); }, info, request);
    }

    void make_current() override { m_handle.make_current(); }

  private:
    OsmesaHandle m_handle;
};

}  // namespace

std::vector<Candidate> osmesa_candidates() {
    DeviceInfo info;
    info.context = "osmesa";
    info.name = "osmesa:0";
    info.platform = "OSMesa";
    return {{std::move(info), Expectation::software, [](const DeviceInfo& device, const ContextRequest& request) {
                 return std::make_unique<OsmesaContext>(device, request);
             }}};
}

}  // namespace sheer::gl
