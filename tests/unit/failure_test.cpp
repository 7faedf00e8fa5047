// What the renderer reports of an error: the texts of our own errors, nothing of others.
#include "server/cli/rendering/failure.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>

#include "renderer/core/errors.h"

namespace sheer::cli::failure_test {

namespace {

using nlohmann::json;

TEST(Failure, OurOwnErrorsAreForTheCaller) {
    const Failure spec = describe_failure(SpecError({{"/scene", "is missing"}, {"/methods/0", "must be a method"}}));
    EXPECT_EQ(spec.exit_code, 2);
    EXPECT_TRUE(spec.is_for_caller);
    EXPECT_EQ(spec.message.at("error").at("kind"), "spec");
    EXPECT_EQ(spec.message.at("error").at("errors"), json::parse(R"([{"pointer": "/scene", "detail": "is missing"},
                              {"pointer": "/methods/0", "detail": "must be a method"}])"));
    EXPECT_EQ(describe_failure(Unsupported("no images")).message,
              json::parse(R"({"error": {"kind": "unsupported", "detail": "no images", "errors": []}})"));
    EXPECT_EQ(describe_failure(RenderError("line 3: ';' expected")).message,
              json::parse(R"({"error": {"kind": "render", "detail": "line 3: ';' expected", "errors": []}})"));
    EXPECT_EQ(describe_failure(RenderError("")).exit_code, 3);
}

TEST(Failure, OtherTextsAreNotSent) {
    const std::filesystem::filesystem_error file("cannot rename", "/srv/secret/path", std::error_code());
    const std::runtime_error library("libfoo 1.2: /srv/secret");
    for (const std::exception* error : std::array<const std::exception*, 2>{&file, &library}) {
        const Failure failure = describe_failure(*error);
        EXPECT_FALSE(failure.is_for_caller);
        EXPECT_EQ(failure.exit_code, 3);
        EXPECT_EQ(failure.message.dump().find("secret"), std::string::npos);
        EXPECT_FALSE(failure.message.at("error").at("detail").get<std::string>().empty());
    }
    EXPECT_EQ(describe_failure(std::bad_alloc()).message.at("error").at("detail"), "The renderer ran out of memory.");
}

}  // namespace

}  // namespace sheer::cli::failure_test
