#pragma once
#include <memory>
#include <string>
#include <vector>

#include "renderer/gl/context.h"

namespace sheer::gl {

/// Where in the frame a pass stands, for the report's `initialization` and `finalization` (Table 7 of the SCCG paper).
enum class Phase { opaque, initialization, transparent, finalization };

/// GPU time of one pass.
struct PassSample {
    std::string name;
    Phase phase = Phase::transparent;
    double gpu_ms = 0;
};

/// One frame, timed by both clocks.
struct FrameSample {
    double wall_ms = 0;  ///< monotonic clock from an idle pipeline to an idle pipeline (glFinish on both sides)
    double gpu_ms = 0;   ///< sum of the passes' GL_TIME_ELAPSED
    bool valid = true;   ///< false if the clocks disagree by more than 10 % on a frame of over 5 ms
    std::vector<PassSample> passes;
};

/// Divides a frame into named passes; times them if asked to. Every pass is also a debug group.
///
///     FrameTimer::Frame frame = timer.frame(true);
///     { auto pass = timer.pass("transparent", Phase::transparent); ... }
///     FrameSample sample = frame.end();
///
/// GL_TIME_ELAPSED is wrong on llvmpipe unless a glFlush follows its begin: see the workaround `flush-timer-queries`.
class FrameTimer {
  public:
    explicit FrameTimer(const Context& context);
    ~FrameTimer();

    /// Ends its pass when it goes out of scope. Passes do not nest.
    class Pass {
      public:
        Pass(Pass&& other) noexcept;
        Pass& operator=(Pass&&) = delete;
        ~Pass();

      private:
        friend class FrameTimer;
        explicit Pass(FrameTimer* timer) : m_timer(timer) {}
        FrameTimer* m_timer;
    };

    /// Ends when it goes out of scope, if it was not ended before; the timer is then ready for the next frame.
    class [[nodiscard]] Frame {
      public:
        Frame(Frame&& other) noexcept;
        Frame& operator=(Frame&&) = delete;
        ~Frame();
        /// Waits until the frame is done. Without timing all times are 0. Throws std::logic_error within a pass, or if
        /// it has ended.
        FrameSample end();

      private:
        friend class FrameTimer;
        explicit Frame(FrameTimer* timer) : m_timer(timer) {}
        FrameTimer* m_timer;
    };

    /// Frames do not nest.
    Frame frame(bool timed);
    Pass pass(std::string name, Phase phase);

  private:
    class StampTarget;
    struct State;
    void end_pass();
    void end_frame();
    std::unique_ptr<State> m_state;
};

}  // namespace sheer::gl
