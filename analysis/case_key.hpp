// The key of a recorded value: the body, its motion, the deformer and the settings. A field that does not apply is empty.
//   const CaseKey key = {.body = "limb", .motion = "bend", .joint = "upper|forearm", .angle_deg = 90.0, .deformer = "pbs"};
// A field has the same name as its column of measurements.csv, its member of a case in claims.json, and its entry in `of` of claims.toml.
#pragma once

#include "analysis/records/typed_table.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace analysis {

struct CaseKey {
    std::string body = {};    // limb, bar, ring, human, man, lady, frankie, or a character of the user's
    std::string motion = {};  // twist, bend, or the name of a clip such as 01_01
    std::string pose = {};    // pose in a clip: crouch, landing, in_the_air
    std::string joint = {};   // the names of the joint's two bones: upper|forearm
    std::optional<double> angle_deg = {};
    std::optional<double> time_s = {};  // time in the clip
    std::string deformer = {}, variant = {};
    std::string reference = {};  // the deformer that the value is compared with
    std::string order = {}, precision = {};
    std::optional<double> vertices = {}, vertices_to = {};  // for a ratio over a range: its first and last setting
    std::optional<double> k_stretch = {}, k_stretch_to = {}, k_bind = {};
    std::optional<double> young_pa = {};
    std::string masses = {};
    std::optional<double> iterations = {}, iterations_to = {};
    std::optional<double> time_step_s = {}, time_step_to_s = {};
    std::string constraint = {};                  // stretch, volume, bind
    std::string initial_guess = {};               // previous_frame, rest_pose, rigid_bind
    std::string tolerance = {};                   // residual: within 5 % of its floor; volume: absolute change within 0.5 %
    std::string load = {}, ladder = {};           // of a stiffness test
    std::string factor = {}, second_factor = {};  // the parameters that a sweep of the stability study varies
    std::string model = {};                       // a row of Table 1 in the paper
    std::string equation = {};                    // an equation of the paper
    std::string gradient_of = {}, reading = {};   // a particle p1 to p4; as_printed, relative_to_p1, derived_gradients
    bool operator==(const CaseKey&) const = default;
    auto operator<=>(const CaseKey&) const = default;  // by the fields in this order; a missing one comes first
};

// A field of the key, which is either a text or a number.
struct CaseKeyField {
    const char* name;
    const char *unit, *meaning;
    enum class Shown {
        alone,
        with_name,
        as_end_of_range
    } shown;  // in text_of(): limb, 90 deg; reference nh_p2; the 1 of k_stretch 0.2 to 1
    std::string CaseKey::*text = nullptr;
    std::optional<double> CaseKey::*number = nullptr;

    bool is_set(const CaseKey& key) const { return text ? !(key.*text).empty() : (key.*number).has_value(); }
};
const std::vector<CaseKeyField>& case_key_fields();           // in the order in which they are written
const CaseKeyField* case_key_field(const std::string& name);  // null if no field has that name

std::string value_text(const CaseKeyField& field, const CaseKey& key);  // without its unit; empty if the field is not set
// The fields that are set, as they are recorded: limb, bend, 90 deg, pbs, reference nh_p2, iterations 12 to 48, time_step 0.01 s.
// paper_figures/case_words.py describes a case in words.
std::string text_of(const CaseKey& key);

// True if every field that is set in `wanted` has the same value in `key`.
bool matches(const CaseKey& key, const CaseKey& wanted);

// One optional column per field, which used_columns() drops if no key sets it.
const Columns<CaseKey>& case_key_columns();

nlohmann::json to_json_of(const CaseKey& key);  // only the fields that are set
// Reads what to_json_of() wrote. InputError for an unknown field, a text where a number is expected, or a number where a text is expected.
CaseKey case_key(const nlohmann::json& object, const std::string& file);

}  // namespace analysis
