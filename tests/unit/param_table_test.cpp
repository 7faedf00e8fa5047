#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "renderer/methods/shared/method.h"
#include "renderer/params/param_table.h"

namespace sheer::test::param_table_test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

enum class Side { left, right };

struct Base {
    bool turned = true;
};

struct Made : Base {
    double share = 0.25;
    int count = 4;
    Side side = Side::right;
    std::array<double, 3> color = {0, 0.5, 1};
};

ParamTable<Made> table() {
    return ParamTable<Made>()
        .number(&Made::share, "share", "a part", "", 0, 1)
        .integer(&Made::count, "count", "how many", "pieces", 2, 8)
        .in_steps_of(2)
        .choice(&Made::side, "side", "which side", {{"left", Side::left}, {"right", Side::right}})
        .color(&Made::color, "color", "what shows behind")
        .with(ParamTable<Base>().boolean(&Base::turned, "turned", "the other way round"));
}

std::string what_is_thrown(const json& object) {
    try {
        table().read(object);
    } catch (const std::logic_error& error) {
        return error.what();
    }
    return "nothing";
}

json good() {
    return {{"share", 0.75}, {"count", 6}, {"side", "left"}, {"color", {1, 0, 0.125}}, {"turned", false}};
}

TEST(ParamTable, TakesDefaultsFromTheStruct) {
    std::vector<FieldError> errors;
    const json defaults = read_fields(json::object(), "", table().params(), errors);
    EXPECT_TRUE(errors.empty());
    EXPECT_EQ(defaults,
              json({{"share", 0.25}, {"count", 4}, {"side", "right"}, {"color", {0.0, 0.5, 1.0}}, {"turned", true}}));
    const Made made = table().read(defaults);
    EXPECT_EQ(made.share, 0.25);
    EXPECT_EQ(made.count, 4);
    EXPECT_EQ(made.side, Side::right);
    EXPECT_THAT(made.color, ElementsAre(0, 0.5, 1));
    EXPECT_TRUE(made.turned);
}

TEST(ParamTable, ReadsEachKind) {
    const Made made = table().read(good());
    EXPECT_EQ(made.share, 0.75);
    EXPECT_EQ(made.count, 6);
    EXPECT_EQ(made.side, Side::left);
    EXPECT_THAT(made.color, ElementsAre(1, 0, 0.125));
    EXPECT_FALSE(made.turned);
}

TEST(ParamTable, DescribesRangesUnitsAndChoices) {
    const std::vector<Param> params = table().params();
    EXPECT_EQ(params[0].max, 1);
    EXPECT_EQ(params[1].unit, "pieces");
    EXPECT_EQ(params[1].step, 2);
    EXPECT_THAT(params[2].choices, ElementsAre("left", "right"));
    EXPECT_EQ(params[4].name, "turned");
}

TEST(ParamTable, AnUnknownChoiceNamesItself) {
    json object = good();
    object["side"] = "middle";
    EXPECT_THAT(what_is_thrown(object), HasSubstr("side has the unknown choice \"middle\""));
}

TEST(ParamTable, NamesMissingParametersAndThoseOfAnotherType) {
    for (const char* name : {"share", "count", "side", "color", "turned"}) {
        json missing = good();
        missing.erase(name);
        EXPECT_THAT(what_is_thrown(missing), HasSubstr(std::string(name) + " is missing"));
        json wrong = good();
        wrong[name] = json::object();
        EXPECT_THAT(what_is_thrown(wrong), HasSubstr(std::string("parameter ") + name));
    }
    json short_color = good();
    short_color["color"] = {1, 0};
    EXPECT_THAT(what_is_thrown(short_color), HasSubstr("color is not an array of 3"));
}

TEST(ParamTable, ChangesOneRangeOfACopy) {
    const ParamTable<Made> original = table();
    EXPECT_EQ(original.with_min("share", 0.125).params()[0].min, 0.125);
    EXPECT_EQ(original.params()[0].min, 0);
    EXPECT_THROW(original.with_min("shore", 0.125), std::logic_error);
}

TEST(ParamTable, RefusesADefaultThatCannotBeChosen) {
    EXPECT_THROW(ParamTable<Made>().choice(&Made::side, "side", "which side", {{"left", Side::left}}),
                 std::logic_error);
}

TEST(Methods, SayWhichParameterSaturates) {
    std::vector<std::string> saturating;
    for (const MethodInfo& method : all_methods()) {
        const Param* param = method.saturation();
        if (param == nullptr) continue;
        saturating.push_back(method.id);
        EXPECT_EQ(param->kind, Param::Kind::number) << method.id;
        EXPECT_EQ(param->max, 1) << method.id;
        EXPECT_EQ(method.saturation_of({{param->name, 0.5}}), 0.5) << method.id;
    }
    EXPECT_THAT(saturating, ElementsAre("depth_marks", "f2bd", "f2bg", "f2bh", "f2bx"));
    EXPECT_EQ(find_method("b2f")->saturation_of(json::object()), std::nullopt);

    MethodInfo wrong;
    wrong.saturation_parameter = "threshold";
    EXPECT_THROW(wrong.saturation(), std::logic_error);
}

}  // namespace
}  // namespace sheer::test::param_table_test
