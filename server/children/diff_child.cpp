#include "server/children/diff_child.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "renderer/core/exit_codes.h"

namespace sheer {

using nlohmann::json;

DiffAnswer run_diff_child(const DiffQuestion& question, const std::filesystem::path& data, const ChildLimits& limits) {
    json input{{"a", question.a}, {"b", question.b}, {"run", nullptr}, {"allow", question.allow}};
    if (question.run) input["run"] = *question.run;
    const ChildReply reply = ask_child({"diff-stored", "--data", data.string()}, input.dump(), limits);
    if (reply.timed_out) return {.detail = "Comparing the reports takes too long.", .too_slow = true};
    const json line = json::parse(reply.line, nullptr, false);
    if (reply.status.code != exit_ok || !line.is_object()) throw std::runtime_error(ending_text("diff", reply.status));
    if (line.contains("diff")) return {.json = line["diff"].dump()};
    DiffAnswer refused{.detail = line.at("detail"), .allowable = line.at("allowable")};
    for (const json& error : line.at("errors")) refused.errors.push_back({error.at("pointer"), error.at("detail")});
    return refused;
}

}  // namespace sheer
