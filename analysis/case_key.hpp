// What a value on record is of: the body, how it moves, by which deformer, with which settings. A field that does not apply is empty.
//   const CaseKey key = {.body = "limb", .motion = "bend", .joint = "upper|forearm", .angle_deg = 90.0, .deformer = "pbs"};
// A field has the same name as a column of measurements.csv, as a member of a case in claims.json, and in `of` of a claim in claims.toml.
#pragma once

#include "analysis/records/csv_table.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace analysis {

struct CaseKey {
    std::string body = {};    // limb, bar, ring, human, man, lady, frankie, or a character of the user's
    std::string motion = {};  // twist, bend, or the name of a clip: 01_01
    std::string pose = {};    // of a clip: crouch, landing, in_the_air
    std::string joint = {};   // the names of its two bones: upper|forearm
    std::optional<double> angle_deg = {};
    std::optional<double> time_s = {};  // of the clip
    std::string deformer = {}, variant = {};
    std::string reference = {};  // the deformer that the value is compared with
    std::string order = {}, precision = {};
    std::optional<double> vertices = {}, vertices_to = {};  // where the value is a ratio over a range: its first and last setting
    std::optional<double> k_stretch = {}, k_stretch_to = {}, k_bind = {};
    std::optional<double> young_pa = {};
    std::string masses = {};
    std::optional<double> iterations = {}, iterations_to = {};
    std::optional<double> time_step_s = {}, time_step_to_s = {};
    std::string constraint = {};                  // stretch, volume, bind
    std::string initial_guess = {};               // previous_frame, rest_pose, rigid_bind
    std::string tolerance = {};                   // residual: within 5 % of its floor; volume: absolute change within 0.5 %
    std::string load = {}, ladder = {};           // of a test of stiffness
    std::string factor = {}, second_factor = {};  // what a sweep of the stability study varies
    std::string model = {};                       // a row of the paper's Table 1
    std::string equation = {};                    // of the paper
    std::string gradient_of = {}, reading = {};   // the particle p1 to p4; as_printed, relative_to_p1, derived_gradients
    bool operator==(const CaseKey&) const = default;
};

// Either a text or a number of a key.
struct CaseKeyField {
    const char* name;
    const char* label;  // of the value in text_of(): "{} deg"
    std::string CaseKey::*text = nullptr;
    std::optional<double> CaseKey::*number = nullptr;

    bool is_set(const CaseKey& key) const { return text ? !(key.*text).empty() : (key.*number).has_value(); }
};
const std::vector<CaseKeyField>& case_key_fields();           // in the order in which they are written
const CaseKeyField* case_key_field(const std::string& name);  // null: none of that name

std::string value_text(const CaseKeyField& field, const CaseKey& key);  // without its unit; empty where it is not set
std::string text_of(const CaseKey& key);                                // the labels of all fields that are set: limb, bend, 90 deg

// Every field that is set in `wanted` has that value in `key`.
bool matches(const CaseKey& key, const CaseKey& wanted);

// The fields that any of the keys has, and a key's cells under them; a key that is read back from its cells is the same.
std::vector<const CaseKeyField*> used_fields(const std::vector<const CaseKey*>& keys);
CsvTable::Cell cell_of(const CaseKeyField& field, const CaseKey& key);
CaseKey case_key(const CsvTable& table, int row);  // from the columns that are there; InputError for a number that is none

nlohmann::json to_json_of(const CaseKey& key);  // of the fields that are set
// What to_json_of() wrote. InputError for an unknown field, a text where a number is expected, or the other way round.
CaseKey case_key(const nlohmann::json& object, const std::string& file);

}  // namespace analysis
