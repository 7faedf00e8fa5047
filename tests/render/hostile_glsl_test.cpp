// Programs put together from hostile pieces: each is refused with a reason, or drawn as it is meant. Never drawn
// wrong. SHEER_SEED repeats a day's; SHEER_SEEDS is how many there are, 100 by default.
#include <cstdlib>
#include <ctime>
#include <iostream>

#include "renderer/core/random.h"
#include "renderer/counting/loop_check.h"
#include "tests/render/render_test.h"

namespace sheer::test::hostile_glsl_test {

namespace {

using nlohmann::json;

enum class Meant { drawn, endless, refused };

struct Piece {
    Meant meant;
    /// N stands for a number from 2 to 30, NAME for a name that no other piece has.
    const char* text;
};

/// None of those that are drawn changes the result; together they stay below the limit of iterations.
constexpr Piece pieces[] = {
    {Meant::drawn, "for (int NAME = 0; NAME < N; ++NAME) sum += 0.0 * tint.r;"},
    {Meant::drawn, "for (float NAME = 0.0; NAME < 1.0; NAME += 0.1) for (uint k = N u; k > 0u; --k) sum += 0.0;"},
    {Meant::drawn, "float NAME = sum / (tint.a - tint.a); if (NAME > 2.0) sum = 1.0;"},
    {Meant::drawn, "float NAME = sqrt(-1.0 - tint.r); if (NAME == NAME && NAME > 0.0) sum = 1.0;"},
    {Meant::drawn,
     "float NAME = pow(-tint.a, 0.5) + log(0.0 * tint.r) + inversesqrt(0.0 * tint.g) + mod(1.0, 0.0 * tint.b);"},
    {Meant::drawn, "int NAME = 2147483647; NAME += int(tint.a) + N; sum += 0.0 * float(NAME / -1);"},
    {Meant::drawn, "int NAME = -2147483647 - 1; NAME /= int(gl_FragCoord.x * 0.0) - 1; sum += 0.0 * float(NAME);"},
    {Meant::drawn, "uint NAME = 1u << (uint(tint.a * 8.0) + N u); sum += 0.0 * float(NAME & 1u);"},
    {Meant::drawn, "float NAME[N]; for (int k = 0; k < N; ++k) NAME[k] = tint.r; sum += 0.0 * NAME[N - 1];"},
    {Meant::drawn, "float NAME[4000]; NAME[int(uv.x * 3999.0)] = tint.r; sum += 0.0 * min(NAME[7], 0.0);"},
    {Meant::drawn, "mat4 NAME = inverse(mat4(0.0)); if (NAME[1][2] > 2.0 && NAME[1][2] < 1.0) sum = 1.0;"},
    {Meant::drawn, "mat3 NAME = mat3(tint.r * 1e38) * mat3(1e38); if (NAME[0].x < -1.0) sum = 1.0;"},
    {Meant::drawn, "vec2 NAME = uv / vec2(0.0 * tint.a); sum += 0.0 * min(sample_texture(N, NAME).r, 1.0);"},
    {Meant::drawn, "sum += 0.0 * sample_texture(-2147483647, uv * 1e30).g;"},
    {Meant::drawn, "float NAME = dFdx(sum / 1e-45) + fwidth(log(-tint.r)); if (NAME > 3.0) sum = 1.0;"},
    {Meant::drawn, "switch (int(v_primitive) * N) { case 0: sum += 0.0; case N: break; default: sum *= 1.0; }"},
    {Meant::drawn, "{ { { { { { if (tint.r > 2.0) { if (tint.g > 2.0) { sum = 1.0; } } } } } } } }"},
    {Meant::drawn, "struct S_NAME { float a[3]; mat2 b; }; S_NAME NAME; NAME.a[1] = tint.r; sum += 0.0 * NAME.a[1];"},
    {Meant::drawn, "double NAME = double(tint.r) * 1.0e300lf; sum += NAME < 0.0lf ? 1.0 : 0.0;"},
    {Meant::drawn,
     "bool NAME = any(isnan(tint)) || any(isinf(vec4(1.0) / 1e-30 / 1e-30 * 0.0)); sum += 0.0 * float(NAME);"},
    {Meant::drawn, "const float NAME[4] = float[4](1.0, 2.0, 3.0, 4.0); sum += 0.0 * NAME[int(v_primitive) & 3];"},
    {Meant::drawn,
     "sum += 0.0 * float(bitfieldExtract(-N, 3, N)) + 0.0 * float(findMSB(0)) + 0.0 * ldexp(1.0, 1000 + N);"},
    {Meant::drawn, "precise float NAME = fma(tint.r, 1e38, 1e38) * 0.0; if (NAME > 1.0) sum = 1.0;"},
    {Meant::drawn, "do { sum += 0.0; if (tint.a > 2.0) continue; break; } while (true);"},
    {Meant::drawn, "for (int NAME = 0;; ++NAME) { if (NAME > N) break; sum -= 0.0; }"},

    {Meant::endless, "for (;;) {}"},
    {Meant::endless, "while (true);"},
    {Meant::endless, "do { sum += 0.0; } while (tint.a >= 0.0);"},
    {Meant::endless, "float NAME = 0.0; while (NAME < 1.0) NAME += 1e-30;"},
    {Meant::endless, "float NAME = 16777216.0; while (NAME < 16777300.0) NAME += 0.5;"},
    {Meant::endless, "for (float NAME = 1.0; NAME != 0.35; NAME += 0.0625) sum += 0.0;"},
    {Meant::endless, "float NAME = tint.r / (tint.r - tint.r); while (!(NAME < NAME)) sum += 0.0;"},
    {Meant::endless, "for (uint NAME = N u; NAME >= 0u; --NAME) sum += 0.0;"},
    {Meant::endless, "int NAME = 1; while (NAME != 0) NAME = NAME * 3;"},
    {Meant::endless, "for (int NAME = 0; NAME < 9; ++NAME) { if (NAME == 5) NAME = 0; }"},
    {Meant::endless, "for (int NAME = 0; NAME < 100; ++NAME) for (int k = 0; k < 100; ++k) sum += 0.0;"},
    {Meant::endless, "for (int NAME = 0; NAME < N; ++NAME) while (uv.x < 2.0) { if (NAME > 99) break; }"},
    {Meant::endless,
     "bool NAME = true; while (NAME) { for (int k = 0; k < N; ++k) { if (k > 40) NAME = false; continue; } }"},
    {Meant::endless, "switch (int(v_primitive) * 0) { case 0: while (uv.x >= 0.0) { sum *= 1.0; } break; }"},

    {Meant::refused, "#define while if\n"},
    {Meant::refused, "discard;"},
    {Meant::refused, "if (tint.a > 2.0) { discard; }"},
    {Meant::refused, "gl_FragDepth = 0.0;"},
    {Meant::refused, "return tint; } void other() {"},
    {Meant::refused, "}"},
    {Meant::refused, "float NAME[4097];"},
    {Meant::refused, "vec4 NAME[1025];"},
    {Meant::refused, "float NAME[9 * 1000];"},
    {Meant::refused,
     "float NAME[4000]; float a_NAME[4000]; float b_NAME[4000]; float c_NAME[4000]; float d_NAME[4000];"},
    {Meant::refused, "int NAME = gl_SampleID;"},
    {Meant::refused, "int NAME = gl_PrimitiveID;"},
    {Meant::refused, "float sheer_NAME = 1.0;"},
    {Meant::refused, "int NAME = 1 / 0;"},
    {Meant::refused, "int NAME = (-2147483647 - 1) / -1;"},
    {Meant::refused, "int NAME = N; sum += float(9 / NAME++);"},
    {Meant::refused, "while (bool NAME = true) {}"},
    {Meant::refused, "sum += real_work(uv, tint).r;"},
    {Meant::refused, "sum += no_such_function(tint);"},
    {Meant::refused, "tint = 1.0;"},
    {Meant::refused, "float \xc3\xa9 = 1.0;"},
    {Meant::refused, "sum = sum + ;"},
};

std::string replaced_all(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

std::string written(const Piece& piece, Random& random, int number) {
    std::string text = replaced_all(piece.text, "NAME", "v" + std::to_string(number));
    const std::string n = std::to_string(2 + random.below(29));
    text = replaced_all(text, "N u", n + "u");
    return replaced_all(text, "N", n);
}

struct Program {
    std::string body = "float sum = 0.0;\n";
    Meant meant = Meant::drawn;
};

/// Up to five pieces, of which at most one is not drawn.
Program made_up(Random& random) {
    Program program;
    const auto count = static_cast<int>(1 + random.below(5));
    for (int i = 0; i < count; ++i) {
        const Piece* piece = &pieces[random.below(std::size(pieces))];
        while (piece->meant != Meant::drawn && program.meant != Meant::drawn)
            piece = &pieces[random.below(std::size(pieces))];
        if (piece->meant != Meant::drawn) program.meant = piece->meant;
        program.body += written(*piece, random, i) + "\n";
    }
    program.body += "return vec4(tint.rgb, tint.a + (sum > 0.5 ? 1.0 : 0.0));";
    return program;
}

json layers(const json& shading) {
    return {{"type", "layers"},
            {"shading", shading},
            {"texture", {{"size", 16}}},
            {"layers",
             {{{"rect", {0.5, 0.25, 1, 1}}, {"depth", 0.25}, {"color", {1, 0.5, 0.25}}, {"alpha", 0.5}},
              {{"rect", {0.25, 0.25, 1, 0.75}}, {"depth", 0.75}, {"color", {0.5, 0, 1}}, {"alpha", 0.25}}}}};
}

class HostileGlsl : public testing::Test {
  protected:
    /// The error that a report with this body ends with, or "" if its picture is that of the plain layers.
    std::string outcome(const std::string& body) {
        const Spec plain = make_spec(layers("constant"), {"b2f", "f2bd"});
        try {
            const Spec spec = make_spec(layers({{"glsl", body}}), {"b2f", "f2bd"});
            Stage stage(*m_context, spec, PixelFormat::rgba8), expected(*m_context, plain, PixelFormat::rgba8);
            check_loops(m_context->gl(), stage.scene(), spec.image);
            for (const MethodSpec& method : spec.methods)
                if (greatest_difference(stage.picture(method), expected.picture(method)) != 0)
                    return method.id + " drew another picture";
            return "";
        } catch (const SpecError& error) {
            EXPECT_EQ(error.errors().at(0).pointer, "/scene/shading/glsl");
            return error.errors().at(0).detail;
        }
    }

    std::unique_ptr<gl::Context> m_context = make_context("egl");
};

bool is_endless(const std::string& outcome) {
    return outcome.find("do not end within") != std::string::npos;
}

bool is_as_meant(Meant meant, const std::string& outcome) {
    if (meant == Meant::drawn) return outcome.empty();
    if (meant == Meant::endless) return is_endless(outcome);
    return !outcome.empty() && !is_endless(outcome) && outcome.find("another picture") == std::string::npos;
}

TEST_F(HostileGlsl, EachPieceIsWhatItIsMeantToBe) {
    Random random(1);
    for (const Piece& piece : pieces) {
        const std::string body = "float sum = 0.0;\n" + written(piece, random, 1) +
                                 "\nreturn vec4(tint.rgb, tint.a + (sum > 0.5 ? 1.0 : 0.0));";
        const std::string seen = outcome(body);
        EXPECT_TRUE(is_as_meant(piece.meant, seen)) << body << "\n: " << seen;
    }
}

TEST_F(HostileGlsl, ProgramsAreRefusedOrDrawnAsTheyAreMeant) {
    const char* const given_seed = std::getenv("SHEER_SEED");
    const char* const given_count = std::getenv("SHEER_SEEDS");
    const auto seed =
        given_seed ? std::strtoull(given_seed, nullptr, 10) : static_cast<std::uint64_t>(std::time(nullptr) / 86'400);
    std::cout << "SHEER_SEED=" << seed << '\n';
    Random random(seed);
    for (int i = 0; i < (given_count ? std::atoi(given_count) : 100); ++i) {
        const Program program = made_up(random);
        const std::string seen = outcome(program.body);
        EXPECT_TRUE(is_as_meant(program.meant, seen)) << program.body << "\n: " << seen;
    }
}

}  // namespace

}  // namespace sheer::test::hostile_glsl_test
