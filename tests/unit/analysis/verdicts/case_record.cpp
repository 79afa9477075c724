// Reference: the definition (a key is recovered from its cells and from JSON, and every member has one field), and the
// rows of a metrics.csv with the columns of the contract.

#include "analysis/records/tables.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "tests/support/refusal.hpp"

#include <nlohmann/json.hpp>

#include <set>

namespace {

using namespace analysis;

CaseKey bent_limb()
{
    return {.body = "limb",
            .motion = "bend",
            .joint = "upper|forearm",
            .angle_deg = 90.0,
            .deformer = "pbs",
            .k_stretch = 0.2};
}

CaseKey with_every_field()
{
    CaseKey key;
    double number = 0.5;
    for (const CaseKeyField& field : case_key_fields()) {
        if (field.text)
            key.*field.text = field.name;
        else
            key.*field.number = number += 1.0;
    }
    return key;
}

TEST(CaseKey, EachFieldHasANameAndAMemberOfItsOwn)
{
    std::set<std::string> names;
    for (const CaseKeyField& field : case_key_fields()) {
        EXPECT_NE(field.text == nullptr, field.number == nullptr) << field.name;
        names.insert(field.name);
    }
    EXPECT_EQ(names.size(), case_key_fields().size());
    const CaseKey key = with_every_field();
    for (const CaseKeyField& field : case_key_fields())
        if (field.text) {
            EXPECT_EQ(key.*field.text, field.name);
        }
    EXPECT_EQ(case_key_field("joint")->text, &CaseKey::joint);
    EXPECT_EQ(case_key_field("colour"), nullptr);
}

TEST(CaseKey, ComesBackFromItsCellsAndFromJsonWithColumnsForWhatIsSetAlone)
{
    const CaseKey key = with_every_field();
    const CsvTable table = table_of(case_key_columns(), {key});
    EXPECT_EQ(rows_of(case_key_columns(), parse_csv(table.text(), "m.csv")), std::vector{key});
    EXPECT_EQ(case_key(to_json_of(key), "plan.json"), key);
    EXPECT_EQ(to_json_of(CaseKey{.body = "man"}).size(), 1u);
    const CaseKey limb = bent_limb(), body = {.body = "man"};
    EXPECT_EQ(used_columns(case_key_columns(), {body, limb}).names(),
              (std::vector<std::string>{"body", "motion", "joint", "angle_deg", "deformer", "k_stretch"}));
    EXPECT_TRUE(used_columns(case_key_columns(), {}).empty());
}

TEST(CaseKey, WhatIsNoKeyIsRefusedByFileAndField)
{
    for (const auto& [text, part] : {std::pair("[]", "plan.json: of = []: expected an object"),
                                     {R"({"colour": "red"})", "of.colour"},
                                     {R"({"body": 3})", "of.body = 3: expected a text"},
                                     {R"({"angle_deg": "90"})", "expected a number"}})
        test_support::expect_refused(part, [&] { case_key(nlohmann::json::parse(text), "plan.json"); });
}

TEST(CaseKey, MatchesWhatAsksForNoMoreAndNamesWhatIsSet)
{
    EXPECT_TRUE(matches(bent_limb(), {}));
    EXPECT_TRUE(matches(bent_limb(), {.deformer = "pbs", .k_stretch = 0.2}));
    EXPECT_FALSE(matches(bent_limb(), {.deformer = "lbs"}));
    EXPECT_FALSE(matches(bent_limb(), {.k_stretch = 0.9}));
    EXPECT_FALSE(matches(bent_limb(), {.order = "plain"}));
    EXPECT_EQ(text_of(bent_limb()), "limb, bend, upper|forearm, 90 deg, pbs, k_stretch 0.2");
    EXPECT_EQ(text_of({.reference = "nh_p2", .masses = "unit", .equation = "12"}),
              "reference nh_p2, masses unit, equation 12");
    EXPECT_EQ(text_of({.iterations = 12.0, .iterations_to = 48.0, .time_step_s = 0.01}),
              "iterations 12 to 48, time_step 0.01 s");
    EXPECT_EQ(text_of({.time_step_s = 0.02, .time_step_to_s = 0.005}), "time_step 0.02 to 0.005 s");
    EXPECT_EQ(text_of({}), "");
}

const std::string record_head =
    "scene,deformer,variant,order,precision,iterations,threads,frame,time_s,volume_change_pct,volume_abs_change_pct,"
    "inverted_tets";

TEST(CaseRecords, RowsAreGroupedByCase)
{
    const auto table =
        parse_csv(record_head +
                      "\nlimb,lbs,,,,,1,0,0,0,0,0\nlimb,pbs,,ordered,f32,24,1,0,0,0,0,0\nlimb,lbs,,,,,1,1,0.01,-3,4,2\n"
                      "limb,pbs,,ordered,f32,24,1,1,0.01,-0.1,1,0\nlimb,pbs,,plain,f64,24,1,0,0,0,0,0\n",
                  "metrics.csv");
    const auto records = case_records(table, "volume/limb");
    ASSERT_EQ(records.size(), 3u);
    EXPECT_EQ(records[0].deformer, "lbs");
    EXPECT_EQ(records[0].iterations, 0);
    EXPECT_EQ(records[0].volume_change_pct, (std::vector<double>{0.0, -3.0}));
    EXPECT_EQ(records[0].inverted_tets, (std::vector<double>{0.0, 2.0}));
    EXPECT_EQ(records[1].iterations, 24);
    EXPECT_EQ(records[1].time_s, (std::vector<double>{0.0, 0.01}));
    EXPECT_EQ(records[1].run, "volume/limb");
    EXPECT_FALSE(records[1].is_sweep());
    EXPECT_EQ(records[2].frame.size(), 1u);
}

TEST(CaseRecords, AnglesMakeASweepAndThoseOfSomeFramesOnlyOrMissingColumnsAreRefused)
{
    const std::string angles = record_head + ",angle_deg\nlimb,lbs,,,,0,1,0,0,0,0,0,0\nlimb,lbs,,,,0,1,1,0.01,-3,4,2,";
    const auto records = case_records(parse_csv(angles + "10\nwalk,lbs,,,,0,1,0,0,0,0,0,\n", "metrics.csv"), "");
    EXPECT_EQ(records[0].angle_deg, (std::vector<double>{0.0, 10.0}));
    EXPECT_FALSE(records[1].is_sweep());
    for (const std::string& text : {angles + "\n", std::string("scene\nlimb\n")})
        EXPECT_THROW(case_records(parse_csv(text, "m.csv"), ""), pbs::InputError) << text;
}

TEST(CaseRecords, AReferencesFramesThatAreNotReachedAreLeftOutAndCounted)
{
    const auto table =
        parse_csv(record_head +
                      ",outcome\nlimb,snh,,,,,1,0,0,0,0,0,finished\nlimb,snh,,,,,1,1,0.01,-9,9,9,not_converged\n"
                      "limb,pbs,,plain,f32,24,1,1,0.01,-1,1,0,not_converged\n",
                  "metrics.csv");
    const auto records = case_records(table, "");
    EXPECT_EQ(records[0].frame, (std::vector<double>{0.0}));
    EXPECT_EQ(records[0].frames_not_converged, 1);
    EXPECT_EQ(records[1].frame.size(), 1u) << "PBS above its residual still is in its pose";
}

}  // namespace
