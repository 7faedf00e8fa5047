// The failure of one method affects only that method. The driver is real; single functions of it are replaced.
#include <gmock/gmock.h>

#include <new>

#include "renderer/compare/compare.h"
#include "tests/render/render_test.h"

namespace sheer::test::failures_test {

namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Replaces glTextureBarrier, which of the methods compared here only f2bd calls: once it has been called
/// `calls_before` times it does `what`. GL functions take no user data, so there is one at a time.
class BrokenBarrier {
  public:
    BrokenBarrier(gl::Context& context, int calls_before, void (*what)(const gl::Functions&))
        : m_functions(const_cast<gl::Functions&>(context.gl())),  // the context is not a const object
          m_original(m_functions.TextureBarrier),
          m_calls_left(calls_before),
          m_what(what) {
        s_only = this;
        m_functions.TextureBarrier = &call;
    }
    ~BrokenBarrier() {
        m_functions.TextureBarrier = m_original;
        s_only = nullptr;
    }
    BrokenBarrier(const BrokenBarrier&) = delete;
    BrokenBarrier& operator=(const BrokenBarrier&) = delete;

    int calls() const { return m_calls; }

  private:
    static void GLAD_API_PTR call() {
        ++s_only->m_calls;
        if (s_only->m_calls_left-- <= 0) s_only->m_what(s_only->m_functions);
        s_only->m_original();
    }

    static inline BrokenBarrier* s_only = nullptr;
    gl::Functions& m_functions;
    PFNGLTEXTUREBARRIERPROC m_original;
    int m_calls_left, m_calls = 0;
    void (*m_what)(const gl::Functions&);
};

void gl_error(const gl::Functions& gl) {
    gl.Enable(0xDEAD);
}
void unsupported(const gl::Functions&) {
    throw Unsupported("no barrier of this kind");
}
void render_error(const gl::Functions&) {
    throw RenderError("the barrier broke");
}
void no_memory(const gl::Functions&) {
    throw std::bad_alloc();
}
void surprise(const gl::Functions&) {
    throw std::out_of_range("/home/somebody/secret");
}
void nothing(const gl::Functions&) {}

Spec spec_of(const std::string& baseline = "b2f") {
    return parse_spec({{"scene", {{"type", "quads"}, {"count", 12}, {"shading", "constant"}}},
                       {"methods", {"b2f", "f2bd", "f2b"}},
                       {"baseline", baseline},
                       {"image", {{"width", 24}, {"height", 24}}},
                       {"timing", {{"rounds", 3}}}});
}

sheer::Run compare_once(const Spec& spec, gl::Context& context,
                        const std::function<void(const std::string&)>& at = {}) {
    NoAssets assets;
    std::vector<sheer::Run> runs;
    compare(
        spec, context, assets,
        [&](double, const std::string& stage) {
            if (at) at(stage);
        },
        [&](const sheer::Run& run) { runs.push_back(run); });
    return runs.at(0);
}

/// How often f2bd calls the barrier until a stage begins.
int barriers_before(const Spec& spec, gl::Context& context, const std::string& stage) {
    BrokenBarrier counted(context, 1 << 30, nothing);
    int calls = -1;
    compare_once(spec, context, [&](const std::string& now) {
        if (now == stage) calls = counted.calls();
    });
    return calls;
}

void expect_others_whole(const sheer::Run& run) {
    for (const std::size_t other : {0u, 2u}) {
        const MethodResult& result = run.results[other];
        EXPECT_EQ(result.status, report::ResultStatus::ok) << result.reason;
        EXPECT_EQ(result.samples.size(), 3u);
        EXPECT_TRUE(result.metrics.has_value());
        EXPECT_TRUE(result.fragments.shaded.has_value());
        EXPECT_EQ(result.image.pixel_count(), 24u * 24u);
    }
    EXPECT_EQ(run.rounds_done, 3);
}

struct Row {
    const char* stage;  ///< before which nothing fails
    void (*what)(const gl::Functions&);
    report::ResultStatus status;
    const char* reason;
};

class OneFails : public testing::TestWithParam<Row> {};

INSTANTIATE_TEST_SUITE_P(
    Failures, OneFails,
    testing::Values(
        Row{"warming up f2bd", gl_error, report::ResultStatus::failed, "rendering f2bd: "},
        Row{"warming up f2bd", unsupported, report::ResultStatus::unsupported, "no barrier of this kind"},
        Row{"warming up f2bd", no_memory, report::ResultStatus::failed, "memory ran out"},
        Row{"timing round 2 of 3", gl_error, report::ResultStatus::failed, "timing f2bd: "},
        Row{"timing round 1 of 3", render_error, report::ResultStatus::failed, "timing f2bd: the barrier broke"},
        Row{"counting the fragments of f2bd", gl_error, report::ResultStatus::failed,
            "counting the fragments of f2bd: "},
        Row{"counting the fragments of f2bd", unsupported, report::ResultStatus::unsupported,
            "no barrier of this kind"},
        Row{"measuring f2bd", render_error, report::ResultStatus::failed, "measuring f2bd: the barrier broke"},
        Row{"measuring f2bd", surprise, report::ResultStatus::failed, "an error within the renderer"}));

TEST_P(OneFails, TheOthersGoOn) {
    const auto context = make_context("egl");
    const Row& row = GetParam();
    Spec spec = spec_of();
    // The picture over black has been made; the one over white has not.
    const int before = barriers_before(spec, *context, row.stage);
    ASSERT_GE(before, 0) << row.stage;
    const BrokenBarrier broken(*context, before, row.what);
    const sheer::Run run = compare_once(spec, *context);
    const MethodResult& failed = run.results[1];
    EXPECT_EQ(failed.status, row.status);
    EXPECT_THAT(failed.reason, AllOf(HasSubstr(row.reason), testing::Not(HasSubstr("secret"))));
    EXPECT_TRUE(failed.samples.empty());
    EXPECT_FALSE(failed.metrics.has_value());
    EXPECT_FALSE(failed.fragments.shaded.has_value());
    EXPECT_EQ(failed.method.label, "f2bd");
    expect_others_whole(run);
    EXPECT_EQ(run.baseline_again.size(), 3u);
    EXPECT_EQ(run.reference_status, report::ResultStatus::ok);
}

TEST(Failures, AnErrorKeptBesideARefusalIsNotTheNextMethods) {
    const auto context = make_context("egl");
    const BrokenBarrier broken(*context, 0, [](const gl::Functions& gl) {
        gl.Enable(0xDEAD);
        throw Unsupported("no barrier");
    });
    const sheer::Run run = compare_once(spec_of(), *context);
    EXPECT_EQ(run.results[1].status, report::ResultStatus::unsupported);
    EXPECT_THAT(run.results[1].reason, AllOf(HasSubstr("no barrier; "), HasSubstr("INVALID_ENUM")));
    expect_others_whole(run);
}

TEST(Failures, TheBaselineMustRunTwice) {
    const auto context = make_context("egl");
    const Spec spec = spec_of("f2bd");
    const int once = barriers_before(spec_of("b2f"), *context, "warming up f2b");
    ASSERT_GT(once, 0);
    const BrokenBarrier broken(*context, once, gl_error);
    const sheer::Run run = compare_once(spec, *context);
    EXPECT_EQ(run.results[1].status, report::ResultStatus::failed);
    EXPECT_THAT(run.results[1].reason, HasSubstr("f2bd a second time, for the noise floor"));
    EXPECT_TRUE(run.baseline_again.empty());
    expect_others_whole(run);
}

TEST(Failures, WithoutAReferenceTheRestIsStillMeasured) {
    const auto context = make_context("egl");
    Spec spec =
        parse_spec({{"scene", {{"type", "quads"}, {"count", 40000}, {"distribution", "full"}, {"shading", "constant"}}},
                    {"methods", {"b2f", "f2b"}},
                    {"reference", {{"id", "exact"}, {"form", "lists"}, {"memory_mib", 1}}},
                    {"image", {{"width", 2}, {"height", 1}}},
                    {"timing", {{"rounds", 2}}}});
    const sheer::Run run = compare_once(spec, *context);
    EXPECT_EQ(run.reference_status, report::ResultStatus::unsupported);
    EXPECT_THAT(run.reference_reason, HasSubstr("40000 fragments"));
    EXPECT_FALSE(run.residual.has_value());
    EXPECT_EQ(run.overdraw.total(), 80000u);
    for (const MethodResult& result : run.results) {
        EXPECT_EQ(result.status, report::ResultStatus::ok) << result.reason;
        EXPECT_EQ(result.samples.size(), 2u);
        EXPECT_FALSE(result.metrics.has_value());
        EXPECT_THAT(result.no_metrics_reason, AllOf(HasSubstr("the reference exact"), HasSubstr("40000 fragments")));
    }
}

TEST(Failures, OfTheDeviceOrTheCallerEndAll) {
    const auto context = make_context("egl");
    EXPECT_THROW(compare_once(spec_of(), *context,
                              [](const std::string& stage) {
                                  if (stage == "measuring f2b") throw std::runtime_error("the caller's own");
                              }),
                 std::runtime_error);
    {
        const BrokenBarrier broken(*context, 0,
                                   [](const gl::Functions&) { throw ContextLost("the device was reset"); });
        EXPECT_THROW(compare_once(spec_of(), *context), ContextLost);
    }
    const sheer::Run run = compare_once(spec_of(), *context);
    EXPECT_EQ(run.results[1].status, report::ResultStatus::ok) << run.results[1].reason;
}

}  // namespace

}  // namespace sheer::test::failures_test
