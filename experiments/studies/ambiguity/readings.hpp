// The readings of the paper, and the changes that each of them makes in the judged values of each claim: the values of
// A and B, and whether the claim's bound judges them otherwise.
//   ReadingComparison comparison{"limb", readings_of(of, "all")};
//   comparison.measure({"C03", "C12"}, [&](const auto& touching) { return values_of(of, touching); });
//   table_of(used_columns(claim_change_columns(), comparison.changes), comparison.changes).write("ambiguity.csv");
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "analysis/verdicts/verdict.hpp"
#include "experiments/characters/character.hpp"
#include "experiments/studies/study.hpp"

#include <nlohmann/json.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace experiments {

inline constexpr const char* own_reading = "as_the_scene";  // the baseline of readings in which nothing jiggles

// A reading of the paper at a place that can be read in more than one way: a set of keys of the scene. Reading A of a
// place is the baseline that a reading names, and B is the reading itself. Substeps are no reading where nothing
// jiggles: every step then begins with LBS, and the step before has no influence.
struct Reading {
    std::string place;  // an identifier; empty: a baseline
    std::string name;
    std::string baseline;
    Overrides overrides = {};      // of the case's scene, with those of the baseline
    nlohmann::json settings = {};  // options of PBS, weights and time step that follow from them

    bool jiggles() const { return settings.contains("jiggle"); }
};

// The baselines and readings of cases.toml, each baseline before its readings. which: all, of_a_step, of_motion. The
// latter are those whose steps depend on the last one, since particles are integrated.
std::vector<Reading> readings_of(const StudyCase& study_case, const std::string& which);

// Why a reading cannot change a claim, from how the claim's values are measured and not from the results; empty where
// it can.
std::string untouched_because(const std::string& claim, const Reading& reading, const Reading& baseline);

// The number of a unit of a claim, for a character that is moved by one reading, and whether it lies within the claim's
// bound.
struct JudgedValue {
    std::string claim, quantity;
    analysis::CaseKey of;
    std::string unit, bound;
    double value = 0.0;
    bool holds = false;
    analysis::Limit limit = analysis::Limit::none;  // where the value only bounds the quantity
};

// The values of the measured claims by one reading.
struct JudgedReading {
    std::vector<JudgedValue> values;
    bool broke_down = false;  // some positions are not finite
    std::vector<ReadingValues::LeftOut> left_out = {};
};

// The units of all claims, one quantity at a time, whatever the order, precision and other settings are that a claim is
// judged in.
std::vector<JudgedValue> judged(const std::vector<analysis::Measurement>& measured);

// A hash of everything that decides whether a value holds: another bound gives another digest.
std::string digest_of(const std::vector<analysis::Claim>& claims);

// verdict_flips: yes, no, not_touched, no_value. A value that B lacks because the reading broke down does not hold, so
// the verdict flips where A's held. Where A or B has no value for another reason, there is no statement about the
// verdict. A quantity that is left out of readings has a row with the reason.
struct ClaimChange {
    std::string body, place, reading_a, reading_b, claim;
    std::string quantity = {};
    analysis::CaseKey of = {};
    std::string unit = {}, bound = {};  // unit: of a, b and change
    std::optional<double> a = {}, b = {}, change = {}, b_over_a = {};
    std::string holds_a = {}, holds_b = {};  // yes, no
    std::string verdict_flips = {}, reason = {};
};
const analysis::Columns<ClaimChange>& claim_change_columns();  // case_body: of the value's case, or its scene

std::vector<ClaimChange> claim_changes(const std::string& body, const std::string& claim, const Reading& reading,
                                       const JudgedReading& a, const JudgedReading& b);
ClaimChange untouched_claim(const std::string& body, const std::string& claim, const Reading& reading,
                            const std::string& reason);

// Readings and their baselines, claim by claim. Only readings that can touch one of the claims are measured, and their
// baselines before them.
struct ReadingComparison {
    using Measure = std::function<std::vector<JudgedReading>(const std::vector<Reading>&)>;  // one per reading

    std::string body;
    std::vector<Reading> readings;
    std::string without_jiggle = {};  // why readings that jiggle cannot touch any claim; empty: they can
    std::vector<ClaimChange> changes = {};
    std::string breakdown = {};  // of readings, if any

    void measure(const std::vector<std::string>& claims, const Measure& measure);
};

// A scene is moved by each reading. The measurements are its volume (C01, C02a) and the time of a frame (C10a).
//   const ReadMotion moved = move(character, scene);
//   volume_changes("limb_bend", reading, a, b, a, {});

// A character that PBS moves through the motion of a scene.
struct ReadMotion {
    analysis::CaseRecord pbs, lbs;       // volume, from which a verdict is computed
    std::vector<pbs::Positions> shapes;  // of PBS, one per frame [m], #V x 3
    bool finite = true;
};
ReadMotion move(const pbs::Character& character, const Scene& scene);

// A row of figures.csv.
struct VolumeChange {
    std::string scene, place, reading_a, reading_b, quantity;
    double a = 0.0, b = 0.0, change = 0.0;
};
extern const analysis::Columns<VolumeChange> volume_change_columns;

// a: moved by the reading's baseline; resting: by the scene's own reading, from which jiggling is measured; zone: #V
std::vector<VolumeChange> volume_changes(const std::string& scene, const Reading& reading, const ReadMotion& a,
                                         const ReadMotion& b, const ReadMotion& resting, const std::vector<bool>& zone);

// C10a: frames per second of processor time, including LBS, of all readings in turns, in the order and precision that
// are judged (plain, f64).
std::vector<JudgedReading> values_of_frames(const StudyCase& study_case, const std::vector<Overrides>& readings);

}  // namespace experiments
