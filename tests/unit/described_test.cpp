// Structs as JSON: written, read and described by a schema from one list of members. Expected documents are written by
// hand.
#include "renderer/params/described.h"

#include <gmock/gmock.h>

#include "renderer/results/report.h"

namespace sheer::described_test {

enum class Mood { calm, stormy };

struct Place {
    std::string name;
    std::array<double, 2> at{};

    bool operator==(const Place&) const = default;
};

struct Base {
    int count = 7;
};

struct Voyage : Base {
    std::vector<Place> places;
    std::optional<double> depth_m;
    std::string note;
    std::string captain;
    OrReason<Place> wreck;
    std::map<std::string, bool> flags;
    Mood mood = Mood::calm;
    std::optional<Place> port;
    nlohmann::json cargo = nlohmann::json::object();
};

}  // namespace sheer::described_test

namespace sheer {

template <>
struct Words<described_test::Mood> {
    static constexpr std::pair<described_test::Mood, const char*> all[] = {{described_test::Mood::calm, "calm"},
                                                                           {described_test::Mood::stormy, "stormy"}};
};

template <>
const Description<described_test::Place>& description_of() {
    using described_test::Place;
    static const auto description = Description<Place>("Place", "where it was")
                                        .member(&Place::name, "name", "of the place")
                                        .member(&Place::at, "at", "x, y in km");
    return description;
}

template <>
const Description<described_test::Base>& description_of() {
    static const auto description =
        Description<described_test::Base>("Base", "").member(&described_test::Base::count, "count", "of sailors");
    return description;
}

template <>
const Description<described_test::Voyage>& description_of() {
    using described_test::Voyage;
    static const auto description = Description<Voyage>("Voyage", "where it went")
                                        .with(description_of<described_test::Base>())
                                        .member(&Voyage::places, "places", "")
                                        .member(&Voyage::depth_m, "depth_m", "")
                                        .maybe(&Voyage::note, "note", "")
                                        .text_or_null(&Voyage::captain, "captain", "")
                                        .member(&Voyage::wreck, "wreck", "")
                                        .member(&Voyage::flags, "flags", "")
                                        .member(&Voyage::mood, "mood", "")
                                        .maybe(&Voyage::port, "port", "")
                                        .json(&Voyage::cargo, "cargo", "", [](SchemaBook&) {
                                            return nlohmann::json{{"type", "object"}};
                                        });
    return description;
}

namespace described_test {
namespace {

using nlohmann::json;

const json empty = json::parse(R"({"count": 7, "places": [], "depth_m": null, "captain": null, "wreck": null,
                                   "flags": {}, "mood": "calm", "cargo": {}})");
const json full = json::parse(R"({"count": 9, "places": [{"name": "a", "at": [1, 2.5]}], "depth_m": 4.5, "note": "n",
                                  "captain": "Ahab", "wreck": {"name": "w", "at": [0, 0]}, "flags": {"white": true},
                                  "mood": "stormy", "port": {"name": "p", "at": [3, 4]}, "cargo": {"oil": [1]}})");

TEST(Described, WritesEveryMember) {
    EXPECT_EQ(to_document(Voyage{}), empty);
    Voyage voyage;
    voyage.wreck.reason = "none was found";
    json told = empty;
    told["wreck_reason"] = "none was found";
    EXPECT_EQ(to_document(voyage), told);
}

TEST(Described, ReadsWhatItWrote) {
    for (const json& document : {empty, full}) EXPECT_EQ(to_document(from_document<Voyage>(document)), document);
    const auto voyage = from_document<Voyage>(full);
    EXPECT_EQ(voyage.count, 9);
    EXPECT_EQ(voyage.places, (std::vector<Place>{{"a", {1, 2.5}}}));
    EXPECT_EQ(voyage.wreck->name, "w");
    EXPECT_EQ(voyage.mood, Mood::stormy);
}

TEST(Described, MissingMembersKeepTheirDefaultsAndUnknownOnesAreIgnored) {
    EXPECT_EQ(to_document(from_document<Voyage>(json::parse(R"({"newer": 1})"))), empty);
}

TEST(Described, AWrongValueIsNamedByItsPointer) {
    const auto wrong = [](const char* patch) {
        json document = full;
        document.merge_patch(json::parse(patch));
        try {
            from_document<Voyage>(document);
            return std::string("nothing is wrong");
        } catch (const DocumentError& error) {
            return std::string(error.what());
        }
    };
    EXPECT_EQ(wrong(R"({"count": 1.5})"), "/count must be a whole number, not 1.5");
    EXPECT_EQ(wrong(R"({"places": [{"name": "a"}, {"name": 3}]})"), "/places/1/name must be a string, not 3");
    EXPECT_EQ(wrong(R"({"places": [{"at": [1]}]})"), "/places/0/at must be an array of 2, not [1]");
    EXPECT_EQ(wrong(R"({"wreck": []})"), "/wreck must be an object, not []");
    EXPECT_EQ(wrong(R"({"flags": {"a/b": 0}})"), "/flags/a~1b must be true or false, not 0");
    EXPECT_EQ(wrong(R"({"mood": "wild"})"), "/mood has the unknown value \"wild\"");
    EXPECT_EQ(wrong(R"({"depth_m": "deep"})"), "/depth_m must be a number, not \"deep\"");
}

TEST(Described, TheSchemaDescribesTheOutput) {
    SchemaBook book("#/$defs/");
    EXPECT_EQ(schema_in<Voyage>(book), json({{"$ref", "#/$defs/Voyage"}}));
    const json& schema = book.schemas().at("Voyage");
    EXPECT_EQ(schema["additionalProperties"], false);
    EXPECT_EQ(schema["required"], json({"count", "places", "depth_m", "captain", "wreck", "flags", "mood", "cargo"}));
    const json expected = json::parse(R"({
        "count": {"type": "integer", "description": "of sailors"},
        "places": {"type": "array", "items": {"$ref": "#/$defs/Place"}},
        "depth_m": {"type": ["number", "null"]},
        "note": {"type": "string"},
        "captain": {"type": ["string", "null"]},
        "wreck": {"anyOf": [{"$ref": "#/$defs/Place"}, {"type": "null"}]},
        "wreck_reason": {"type": "string", "description": "why wreck is null"},
        "flags": {"type": "object", "additionalProperties": {"type": "boolean"}},
        "mood": {"enum": ["calm", "stormy"]},
        "port": {"$ref": "#/$defs/Place"},
        "cargo": {"type": "object"}})");
    EXPECT_EQ(schema["properties"], expected);
    EXPECT_EQ(book.schemas().at("Place")["properties"]["at"],
              json::parse(R"({"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2,
                              "description": "x, y in km"})"));
    EXPECT_EQ(book.schemas().size(), 2u);
}

TEST(Described, AnEmptyReportIsReadAgain) {
    const json document = to_document(report::Report{});
    EXPECT_EQ(to_document(from_document<report::Report>(document)), document);
}

}  // namespace
}  // namespace described_test

}  // namespace sheer
