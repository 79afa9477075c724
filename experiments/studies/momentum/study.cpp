// C07: do projections conserve linear and angular momentum? Measured are single projections, and a pass over each class in every order,
// from the LBS shape of a bent limb and of the human's crouch, in both precisions, with equal and unequal masses. Eq. 8-9 as printed, for
// m_i = 1, are measured for comparison, as is the momentum that the bones take up from the bind constraints.
// Writes DIR/momentum/CASE/measurements.csv.
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/momentum/momentum_drift.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/study.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/verdicts/measurement.hpp"

namespace experiments {
namespace {

struct Setting {
    std::string name;
    pbs::Masses known, counted;  // the masses that the projection uses, and those of the momentum
};
const std::vector<Setting> settings = {{"equal", pbs::Masses::unit, pbs::Masses::unit},
                                       {"unequal", pbs::Masses::lumped, pbs::Masses::lumped},
                                       {"unequal_by_eq_8_9", pbs::Masses::unit, pbs::Masses::lumped}};

RECORD_SETTINGS(Setting, name, known, counted)

struct MomentumCase {
    std::string name;
    Scene scene;
    int frame = 0;
};

RECORD_SETTINGS_AND(MomentumCase, .constant("masses", option_json(settings)), name, scene, frame)

const std::pair<ProjectedClass, const char*> classes[] = {
    {ProjectedClass::stretch, "stretch"}, {ProjectedClass::volume, "volume"}, {ProjectedClass::bind, "bind"}};

// The bones take up the momentum of bind constraints, which is no part of the claim.
void add(std::vector<analysis::Measurement>& rows, ProjectedClass projected, const std::string& suffix, const analysis::CaseKey& of,
         const MomentumDrift& drift)
{
    const std::string bones = projected == ProjectedClass::bind ? "_taken_by_bones" : "";
    for (const auto& [quantity, value] : {std::pair{"linear_drift", drift.linear}, {"angular_drift", drift.angular}})
        rows.push_back({"C07", quantity + suffix + bones, of, value, value, value, "1"});
}

std::string measure_drift(const MomentumCase& of, const std::string& folder)
{
    const pbs::Character character = pbs::make_character(of.scene.character);
    const pbs::Motion motion = make_motion(of.scene.motion, character.skeleton, of.scene.file);
    const pbs::Pose& pose = motion.steps.at(static_cast<std::size_t>(of.frame) * motion.steps_per_frame);
    pbs::PbsOptions options = options_of<pbs::PbsOptions>(spec_of(of.scene, "pbs"));
    options.jiggle.reset();
    std::vector<analysis::Measurement> rows;
    for (const auto& [precision, precision_name] : OptionNames<pbs::Precision>::table)
        for (const Setting& setting : settings)
            for (const auto& [projected, class_name] : classes) {
                options.precision = precision;
                options.masses = setting.known;
                analysis::CaseKey key = {.body = of.name, .precision = precision_name, .masses = setting.name, .constraint = class_name};
                add(rows, projected, "", key, drift_of_projections(character, pose, options, projected, setting.counted));
                for (const pbs::Order order : {pbs::Order::ordered, pbs::Order::grouped, pbs::Order::plain}) {
                    options.order = order;
                    key.order = name_of(order);
                    add(rows, projected, "_of_a_pass", key, drift_of_a_pass(character, pose, options, projected, setting.counted));
                }
            }
    analysis::measurement_table(rows).write(analysis::path_in(folder, "measurements.csv"));
    return {};
}

StudyPlan plan(bool full)
{
    return plan_of_cases("momentum", full, [](const StudyCase& of, StudyPlan& plan) {
        plan.runs.push_back(work_run<MomentumCase>(of.name, {of.name, of.scene(), of.value<int>("frame")}, of.cost_s, measure_drift));
    });
}

}  // namespace

Study momentum_study()
{
    return {"momentum", plan};
}

}  // namespace experiments
