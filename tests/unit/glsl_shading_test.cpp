#include "renderer/glsl/own_shading.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/spec/spec.h"

namespace sheer::glsl_shading_test {

namespace {

using nlohmann::json;

/// The function made from `body`, without the lines before and after it.
std::string rewritten(const std::string& body) {
    const std::string begin = "#line 100000\nvec4 sheer_own_work(vec2 uv, vec4 tint) { ", end = " }\n#line 1\n";
    const std::string function = make_glsl_shading(body).function;
    EXPECT_TRUE(function.starts_with(begin) && function.ends_with(end)) << function;
    return function.substr(begin.size(), function.size() - begin.size() - end.size());
}

struct Rewriting {
    std::string name, body, expected;
};

void PrintTo(const Rewriting& row, std::ostream* out) {
    *out << row.body;
}

class Rewritings : public testing::TestWithParam<Rewriting> {};

TEST_P(Rewritings, KeepTheLinesAndCountTheLoops) {
    EXPECT_EQ(rewritten(GetParam().body), GetParam().expected);
}

const std::vector<Rewriting>& rewritings() {
    static const std::vector<Rewriting> all = {
        {"no_loop", "return tint;", "return tint;"},
        {"for", "for (int i = 0; i < 3; ++i) x();", "for (int i = 0;( i < 3) && sheer_next(); ++i) x();"},
        {"for_without_condition", "for (;;) {}", "for (;sheer_next();) {}"},
        {"for_with_spaces_as_condition", "for (;\n ;) {}", "for (;sheer_next()\n ;) {}"},
        {"for_with_brackets", "for (int a[2] = {1, 2}; f(a[0], (1)) < 2; g(1, 2)) {}",
         "for (int a[2] = {1, 2};( f(a[0], (1)) < 2) && sheer_next(); g(1, 2)) {}"},
        {"or_binds_weaker", "while (a || b) c;", "while ((a || b) && sheer_next()) c;"},
        {"comma", "while (a, b) c;", "while ((a, b) && sheer_next()) c;"},
        {"do", "do { a; } while (b);", "do { a; } while ((b) && sheer_next());"},
        {"nested", "for (;a;) while (b) do c; while (d);",
         "for (;(a) && sheer_next();) while ((b) && sheer_next()) do c; while ((d) && sheer_next());"},
        {"names_that_hold_keywords", "int meanwhile, for_ = 1, _for; x.format;",
         "int meanwhile, for_ = 1, _for; x.format;"},
        {"letters_of_a_number", "x = 1.0for (;;);", "x = 1.0for (;;);"},
        {"comments", "a; // while (\nb; /* for\n( */ c;", "a; \nb;  \n c;"},
        {"comment_between", "while/**/(a/*)*/)/**/b;", "while ((a ) && sheer_next()) b;"},
        {"comment_in_comment", "/* // */ a; // /* \nb;", "  a; \nb;"},
        {"not_a_comment", "a = b / / 3;", "a = b / / 3;"},
        {"division_by_a_literal", "a = b / 3 + c % 2u - d / 1.5e-3 * e / .5;",
         "a = b / 3 + c % 2u - d / 1.5e-3 * e / .5;"},
        {"division", "a = b / c;", "a = b * sheer_sign(c) / sheer_magnitude(c);"},
        {"division_by_less_than_0", "a = b / -1;", "a = b * sheer_sign(-1) / sheer_magnitude(-1);"},
        {"remainder_of_members", "a = b%c.xy[0]+1;", "a = b*sheer_sign(c.xy[0]) % sheer_magnitude(c.xy[0])+1;"},
        {"division_by_a_call", "a /f(b, c).x;", "a *sheer_sign(f(b, c).x) / sheer_magnitude(f(b, c).x);"},
        {"division_of_a_division", "a/b/c;",
         "a*sheer_sign(b) / sheer_magnitude(b)*sheer_sign(c) / sheer_magnitude(c);"},
        {"division_by_a_division", "a/(b/c);",
         "a*sheer_sign((b*sheer_sign(c) / sheer_magnitude(c))) / "
         "sheer_magnitude((b*sheer_sign(c) / sheer_magnitude(c)));"},
        {"division_and_assignment", "a.x /= b + c, d;", "a.x = a.x * sheer_sign(b + c) / sheer_magnitude(b + c), d;"},
        {"division_over_lines", "a /\nb;", "a *\nsheer_sign(b) / sheer_magnitude(b);"},
        {"division_in_a_loop", "while (a / b) c;",
         "while ((a * sheer_sign(b) / sheer_magnitude(b)) && sheer_next()) c;"},
        {"comparison_in_a_divisor", "a / (b == c ? d : e);",
         "a * sheer_sign((b == c ? d : e)) / sheer_magnitude((b == c ? d : e));"},
        {"array_size", "const int n = 12; float a[n / 4];", "const int n = 12; float a[n / 4];"},
        {"array_index", "x = a[100000 * 3]; float b[4096];", "x = a[100000 * 3]; float b[4096];"},
        {"listed_array", "float a[] = float[](1.0, 2.0);", "float a[] = float[](1.0, 2.0);"},
        {"what_is_the_same_for_all", "x = gl_FragCoord.x; y = gl_FrontFacing; z = gl_MaxDrawBuffers;",
         "x = gl_FragCoord.x; y = gl_FrontFacing; z = gl_MaxDrawBuffers;"},
        {"line_ends", "a;\r\nb;\rc;\n\nd;", "a;\nb;\nc;\n\nd;"},
        {"backslash_in_a_comment", "a; // \\\nb;", "a; \nb;"},
    };
    return all;
}

INSTANTIATE_TEST_SUITE_P(All, Rewritings, testing::ValuesIn(rewritings()),
                         [](const testing::TestParamInfo<Rewriting>& row) { return row.param.name; });

TEST(GlslShading, StatementsHaveAnEnd) {
    const auto sum = [](int terms) {
        std::string body = "float a = tint.r;\nreturn vec4(a";
        for (int i = 1; i < terms; ++i) body += "+a";
        return body + ");";
    };
    EXPECT_NO_THROW(make_glsl_shading(sum(4000)));
    EXPECT_THROW(make_glsl_shading(sum(5000)), GlslError);
    // Nested divisions are written twice at each level, which must be limited too.
    std::string nested = "return tint";
    for (int i = 0; i < 40; ++i) nested += "/(uv.x";
    EXPECT_THROW(make_glsl_shading(nested + std::string(40, ')') + ";"), GlslError);
    std::string deep = "return tint";
    for (int i = 0; i < 1000; ++i) deep += "/(a";
    EXPECT_THROW(make_glsl_shading(deep + std::string(1000, ')') + ";"), GlslError);
}

TEST(GlslShading, KnowsItsRequirements) {
    EXPECT_FALSE(make_glsl_shading("return tint; // for sample_texture").has_loops);
    EXPECT_TRUE(make_glsl_shading("do {} while (false); return tint;").has_loops);
    EXPECT_FALSE(make_glsl_shading("return my_sample_texture;").is_textured);
    EXPECT_TRUE(make_glsl_shading("return sample_texture(0, uv);").is_textured);
}

struct Refusal {
    std::string name, body, error;
};

void PrintTo(const Refusal& row, std::ostream* out) {
    *out << row.body;
}

class Refusals : public testing::TestWithParam<Refusal> {};

TEST_P(Refusals, NameTheLine) {
    try {
        make_glsl_shading(GetParam().body);
        FAIL() << "was accepted";
    } catch (const GlslError& error) {
        EXPECT_THAT(error.what(), testing::StartsWith(GetParam().error));
    }
}

const std::vector<Refusal>& refusals() {
    static const std::vector<Refusal> all = {
        {"directive", "a;\n  #define b\n", "line 2 has a #"},
        {"directive_after_a_comment", "/*\n\n*/ #if 1", "line 3 has a #"},
        {"pasting", "a ## b", "line 1 has a #"},
        {"closes_the_function", "return tint; }\nvoid f() {", "line 1 has a } that closes nothing"},
        {"brace_left_open", "if (a) {\n b;", "line 1 has a { that is not closed"},
        {"brackets_crossed", "f(\n[)]", "line 2 has a ) but the [ of line 2 is still open"},
        {"brace_in_parentheses", "while (a {) b; }", "line 1 has a ) but the { of line 1 is still open"},
        {"comment_left_open", "a;\nb; /* c }", "line 2 begins a comment that is not closed"},
        {"comment_that_is_too_short", "a; /*/", "line 1 begins a comment that is not closed"},
        {"nul", std::string("a;\n\0b;", 6), "line 2 has the byte 0x00"},
        {"umlaut", "a;\r\r\nb; // \xc3\xa4", "line 3 has the byte 0xc3"},
        {"line_continued", "a; \\\nb;", "line 1 has a \\"},
        {"text", "a = \"}\";", "line 1 has a \""},
        {"discard", "\n\ndiscard;", "line 3 has discard"},
        {"own_depth", "gl_FragDepth = 0.5;", "line 1 has gl_FragDepth"},
        {"sample", "int n = 0;\nn = gl_SampleID;", "line 2 has gl_SampleID"},
        {"sample_position", "vec2 p = gl_SamplePosition;", "line 1 has gl_SamplePosition"},
        {"sample_mask", "int m = gl_SampleMaskIn[0];", "line 1 has gl_SampleMaskIn"},
        {"sample_count", "int n = gl_NumSamples;", "line 1 has gl_NumSamples"},
        {"primitive_of_a_batch", "\n\nint n = gl_PrimitiveID;", "line 3 has gl_PrimitiveID"},
        {"layer", "int n = gl_Layer;", "line 1 has gl_Layer"},
        {"helper", "bool h = gl_HelperInvocation;", "line 1 has gl_HelperInvocation"},
        {"at_a_sample", "vec2 p = interpolateAtSample(v_uv, 1);", "line 1 has interpolateAtSample"},
        {"huge_array", "int i = 0;\nfloat a[1000000000];", "line 2 has an array of more than 4096"},
        {"just_too_large", "float a[4097];", "line 1 has an array of more than 4096"},
        {"huge_hexadecimal_array", "uint a[0x7fffffffu];", "line 1 has an array of more than 4096"},
        {"size_beyond_64_bits", "int a[99999999999999999999];", "line 1 has an array of more than 4096"},
        {"array_of_vectors", "vec4 a[1025];", "line 1 has an array of more than 4096"},
        {"array_of_matrices", "const mat4 m[257] = x;", "line 1 has an array of more than 4096"},
        {"nested_array", "float a[65][65];", "line 1 has an array of more than 4096"},
        {"array_on_the_type", "float[100][41] a;", "line 1 has an array of more than 4096"},
        {"array_on_both", "float[100] a[41];", "line 1 has an array of more than 4096"},
        {"second_declarator", "float a = 1.0, b[3], c[5000];", "line 1 has an array of more than 4096"},
        {"array_in_a_struct", "struct S { float x; vec3 a[2000]; };", "line 1 has an array of more than 4096"},
        {"array_of_a_struct", "struct S { vec4 x, y; mat4 m; }; S a[171];", "line 1 has an array of more than 4096"},
        {"struct_of_structs", "struct A { float x[4000]; }; struct B { A a, b; } c;",
         "line 1 has an array of more than"},
        {"array_after_a_struct", "struct { float x; } a[5000];", "line 1 has an array of more than 4096"},
        {"constructor", "float x = float[5000](1.0)[0];", "line 1 has an array of more than 4096"},
        {"constant_size", "const int n = 70;\nconst int m = n * n;\nfloat a[m];",
         "line 3 has an array of more than 4096"},
        {"shifted_size", "float a[1 << 20];", "line 1 has an array of more than 4096"},
        {"many_arrays", "float a[4096], b[4096], c[4096], d[4096], e[1];", "line 1 has arrays of more than 16384"},
        {"array_in_a_loop", "for (int a[9999] = x; ; ) {}", "line 1 has an array of more than 4096"},
        {"unknown_size", "float a[int(uv.x)];", "line 1 has an array of unknown size"},
        {"size_by_a_variable", "int n = 5; float a[n];", "line 1 has an array of unknown size"},
        {"name_used_twice", "const int n = 5; { const int n = 500000; float a[n]; }",
         "line 1 has an array of unknown size"},
        {"by_zero", "int i = 1;\nint j = i / 0;", "line 2 divides by 0"},
        {"remainder_by_zero", "int j = 5 % 0;", "line 1 divides by 0"},
        {"by_unsigned_zero", "uint j = 5u / 0x0u;", "line 1 divides by 0"},
        {"by_a_constant_zero", "const int z = 3 - 3; int j = 5 / z;", "line 1 divides by 0"},
        {"by_zero_in_parentheses", "int j = 5 % (2 - 2);", "line 1 divides by 0"},
        {"assigned_by_zero", "int j = 5; j /= 0;", "line 1 divides by 0"},
        {"overflow", "const int q = (-2147483647 - 1) / -1;", "line 1 divides the least integer by -1"},
        {"remainder_overflow", "int q = -2147483648 % -1;", "line 1 divides the least integer by -1"},
        {"overflow_by_bits", "int q = int(0x80000000u) / (1 - 2);", "line 1 divides the least integer by -1"},
        {"overflow_by_a_shift", "const int a = 1 << 31; const int b = -1; int q = a % b;", "line 1 divides the least"},
        {"change_in_a_divisor", "int j = 5 / i++;", "line 1 changes a variable within a division"},
        {"assignment_in_a_divisor", "int j = 5 / (i = 3);", "line 1 changes a variable within a division"},
        {"fresh_budget", "begin_fragment();", "line 1 has begin_fragment"},
        {"recursion", "return real_work(uv, tint);", "line 1 has real_work"},
        {"own_counter", "sheer_iterations_left = 9;", "line 1 has sheer_iterations_left"},
        {"own_macro", "SHEER_ITERATIONS;", "line 1 has SHEER_ITERATIONS"},
        {"for_without_parenthesis", "for a;", "line 1 has a for without ("},
        {"while_at_the_end", "a; while", "line 1 has a while without ("},
        {"for_with_one_semicolon", "\nfor (a; b) c;", "line 2 has a for without two semicolons"},
        {"for_with_three_semicolons", "for (a; b; c; d) e;", "line 1 has a for without two semicolons"},
        {"declaration_in_while", "while (bool a = b) c;", "line 1 declares a variable"},
        {"declaration_in_for", "for (; const bool a = b;) c;", "line 1 declares a variable"},
    };
    return all;
}

INSTANTIATE_TEST_SUITE_P(All, Refusals, testing::ValuesIn(refusals()),
                         [](const testing::TestParamInfo<Refusal>& row) { return row.param.name; });

/// Messages as the three drivers write them. The user's first line is 100000; messages about our own lines, and
/// warnings, are left out.
TEST(GlslShading, FindsTheUsersLinesInALog) {
    EXPECT_EQ(user_messages("program 'b2f': does not compile:\n"
                            "0:12(3): error: not the user's\n"
                            "0:100002(10): warning: `a' used uninitialized\n"
                            "0:100002(10): error: `b' undeclared\n"
                            "0:100013(2): error: no return in function `sheer_own_work'\n"),
              "line 3: `b' undeclared\nline 14: no return in function `real_work'");
    EXPECT_EQ(user_messages("0(100002) : error C1503: undefined variable \"b\"\n0(9) : error C0000: syntax error\n"),
              "line 3: error C1503: undefined variable \"b\"");
    EXPECT_EQ(user_messages("ERROR: 0:100006: 'b' : undeclared identifier\nERROR: 0:7: 'c' : undeclared\n"),
              "line 7: 'b' : undeclared identifier");
    EXPECT_EQ(user_messages("0:99999(10): error: `b' undeclared"), "");
    EXPECT_EQ(user_messages(""), "");
}

TEST(GlslShading, SaysOnlyTheFirstErrors) {
    std::string log;
    for (int i = 0; i < 1000; ++i) log += "0:100002(10): error: `b' undeclared\n";
    const std::string messages = user_messages(log);
    EXPECT_EQ(std::count(messages.begin(), messages.end(), '\n'), 9);
}

std::vector<FieldError> errors_of(const json& shading) {
    try {
        parse_spec({{"scene", {{"type", "quads"}, {"shading", shading}}}, {"methods", {"b2f"}}});
    } catch (const SpecError& error) {
        return error.errors();
    }
    return {};
}

std::string pointer_of(const json& shading) {
    const auto errors = errors_of(shading);
    return errors.size() == 1 ? errors[0].pointer : std::to_string(errors.size()) + " errors";
}

TEST(GlslShading, IsAChoiceOfEveryScene) {
    EXPECT_TRUE(errors_of({{"glsl", "return tint;"}}).empty());
    EXPECT_EQ(pointer_of("glsl"), "/scene/shading");
    EXPECT_EQ(pointer_of(json::array({"return tint;"})), "/scene/shading");
    EXPECT_THAT(errors_of("glsl")[0].detail, testing::HasSubstr("4x4-textures-math, or an object with glsl"));
    EXPECT_EQ(pointer_of(json::object()), "/scene/shading/glsl");
    EXPECT_EQ(pointer_of({{"glsl", ""}}), "/scene/shading/glsl");
    EXPECT_EQ(pointer_of({{"glsl", 3}}), "/scene/shading/glsl");
    EXPECT_EQ(pointer_of({{"glsl", std::string(max_glsl_bytes + 1, ' ')}}), "/scene/shading/glsl");
    EXPECT_TRUE(errors_of({{"glsl", std::string(max_glsl_bytes, ' ')}}).empty());
    EXPECT_EQ(pointer_of({{"glsl", "return tint;"}, {"hlsl", ""}}), "/scene/shading/hlsl");
    EXPECT_EQ(pointer_of({{"glsl", "}{"}}), "/scene/shading/glsl");
    const Spec spec =
        parse_spec({{"scene", {{"type", "quads"}, {"shading", {{"glsl", "return tint;"}}}}}, {"methods", {"b2f"}}});
    EXPECT_EQ(parse_spec(spec.normalised).normalised, spec.normalised);
}

TEST(GlslShading, IsInTheSchemaAndTheSelfDescription) {
    const json shading = spec_schema()["properties"]["scene"]["oneOf"][0]["properties"]["shading"];
    ASSERT_EQ(shading["anyOf"].size(), 2u);
    EXPECT_THAT(shading["anyOf"][0]["enum"].get<std::vector<std::string>>(), testing::Contains("1-texture"));
    EXPECT_EQ(shading["anyOf"][1]["required"], json({"glsl"}));
    EXPECT_EQ(shading["anyOf"][1]["properties"]["glsl"]["maxLength"], max_glsl_bytes);
    for (const json& scene : describe_scenes())
        for (const json& parameter : scene["parameters"])
            if (parameter["name"] == "shading") {
                EXPECT_EQ(parameter["kind"], "choice");
                EXPECT_EQ(parameter["fields"][0]["name"], "glsl");
            }
}

}  // namespace

}  // namespace sheer::glsl_shading_test
