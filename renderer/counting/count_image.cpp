#include "renderer/counting/count_image.h"

namespace sheer {

CountImage::CountImage(const gl::Functions& gl, std::string_view label, int width_px, int height_px)
    : m_gl(gl),
      m_width_px(width_px),
      m_height_px(height_px),
      m_texture(gl::make_texture_2d(gl, label, GL_R32UI, width_px, height_px)) {
    clear();
}

void CountImage::clear() const {
    const GLuint zero = 0;
    m_gl.ClearTexImage(m_texture.id(), 0, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
}

void CountImage::bind() const {
    m_gl.BindImageTexture(0, m_texture.id(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
}

PixelCounts CountImage::read() const {
    PixelCounts counts{m_width_px, m_height_px, {}};
    counts.counts.resize(static_cast<std::size_t>(m_width_px) * m_height_px);
    m_gl.MemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    m_gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
    m_gl.GetTextureImage(m_texture.id(), 0, GL_RED_INTEGER, GL_UNSIGNED_INT,
                         static_cast<GLsizei>(counts.counts.size() * sizeof(counts.counts[0])), counts.counts.data());
    return counts;
}

}  // namespace sheer
