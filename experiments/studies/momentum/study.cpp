// C07: do projections conserve linear and angular momentum? Measured are single projections, and a pass over each class
// in every order, from the LBS shape of a bent limb and of the human's crouch, in both precisions, with equal and
// unequal masses. Eq. 8-9 as printed, for m_i = 1, are measured for comparison, as is the momentum that the bones take
// up from the bind constraints. Writes DIR/momentum/CASE/measurements.csv.
#include "analysis/records/record_files.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/momentum/momentum_drift.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/constraints/volume_printed.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/particles.hpp"
#include "pbs/solver/projection.hpp"

#include <Eigen/Geometry>

namespace experiments {
namespace {

Eigen::VectorXd masses_of(const pbs::Character& character, pbs::Masses counted)
{
    if (counted == pbs::Masses::unit) return Eigen::VectorXd::Ones(character.mesh.rest.rows());
    return pbs::lumped_volumes(character.mesh.rest, character.mesh.tets);
}

// The momentum of corrections, as a vector sum and as a sum of norms.
struct Momentum {
    pbs::Vec3 linear = pbs::Vec3::Zero(), angular = pbs::Vec3::Zero();
    double linear_sum = 0.0, angular_sum = 0.0;

    void add(const pbs::Vec3& arm, const pbs::Vec3& m_dp)
    {
        linear += m_dp;
        angular += arm.cross(m_dp);
        linear_sum += m_dp.norm();
        angular_sum += arm.norm() * m_dp.norm();
    }
};

// Positions relative to the centre of mass, rounded once to the scalar of the projection. They must be kept in memory:
// where the optimiser sees both a position in double and its rounded value, GCC 12 at -O3 uses the former in place of
// the latter, and the difference to the corrected position then contains the rounding of the initial one.
template <typename Scalar>
std::vector<pbs::Vector3<Scalar>> rounded(const pbs::Positions& positions, const pbs::Vec3& centre)
{
    std::vector<pbs::Vector3<Scalar>> points;
    for (const auto& position : positions.rowwise())
        points.push_back((position.transpose() - centre).template cast<Scalar>());
    return points;
}

// The printed forms hold for m_i = 1 only.
template <typename Scalar>
void project_as(pbs::VolumeForm form, const pbs::VolumeConstraint<Scalar>& tet, const std::vector<Scalar>& w,
                std::array<pbs::Vector3<Scalar>, 4>& p)
{
    using pbs::Printed, pbs::project_printed;
    const auto [i, j, k, l] = tet.vertex;
    switch (form) {
        case pbs::VolumeForm::derived:
            return project(tet, w[i], w[j], w[k], w[l], p[0], p[1], p[2], p[3]);
        case pbs::VolumeForm::labels_relative:
            return project_printed<Printed::labels_relative>(tet, p[0], p[1], p[2], p[3]);
        case pbs::VolumeForm::labels_absolute:
            return project_printed<Printed::labels_absolute>(tet, p[0], p[1], p[2], p[3]);
        case pbs::VolumeForm::sign:
            return project_printed<Printed::sign>(tet, p[0], p[1], p[2], p[3]);
        case pbs::VolumeForm::as_printed:
            return project_printed<Printed::as_printed>(tet, p[0], p[1], p[2], p[3]);
    }
}

template <typename Scalar>
MomentumDrift single_projections(const pbs::Character& character, const pbs::Pose& pose, const pbs::PbsOptions& options,
                                 ProjectedClass projected, const Eigen::VectorXd& mass)
{
    const auto set = pbs::make_constraint_set<Scalar>(character.mesh, character.binding.distance, {}, options);
    const pbs::Positions positions = blended(character, pose);
    const pbs::Vec3 centre = positions.transpose() * mass / mass.sum();
    const auto points = rounded<Scalar>(positions, centre),
               q = rounded<Scalar>(pbs::posed_bind_points(character.binding, pose), centre);
    const auto& w = set.inverse_mass;
    double linear = 0.0, angular = 0.0, linear_sum = 0.0, angular_sum = 0.0;
    const auto add = [&]<std::size_t n>(const std::array<int, n>& vertices, const auto& project_corners) {
        std::array<pbs::Vector3<Scalar>, n> after;
        for (std::size_t i = 0; i < n; ++i) after[i] = points[vertices[i]];
        project_corners(after);
        Momentum own;
        for (std::size_t i = 0; i < n; ++i) {
            const pbs::Vec3 p = points[vertices[i]].template cast<double>();
            own.add(p, mass(vertices[i]) * (after[i].template cast<double>() - p));
        }
        linear += own.linear.norm();
        angular += own.angular.norm();
        linear_sum += own.linear_sum;
        angular_sum += own.angular_sum;
    };
    if (projected == ProjectedClass::stretch)
        for (const auto& edge : set.stretch)
            add(edge.vertex, [&](auto& p) { project(edge, w[edge.vertex[0]], w[edge.vertex[1]], p[0], p[1]); });
    if (projected == ProjectedClass::volume)
        for (const auto& tet : set.volume)
            add(tet.vertex, [&](auto& p) { project_as(options.volume_form, tet, w, p); });
    if (projected == ProjectedClass::bind)
        for (const auto& bind : set.bind)
            add(std::array{bind.vertex}, [&](auto& p) { project(bind, w[bind.vertex], q[bind.vertex], p[0]); });
    return {linear / linear_sum, angular / angular_sum};
}

template <typename Scalar>
MomentumDrift one_pass(const pbs::Character& character, const pbs::Pose& pose, const pbs::PbsOptions& options,
                       ProjectedClass projected, const Eigen::VectorXd& mass)
{
    const auto projection = pbs::make_projection<Scalar>(
        pbs::make_constraint_set<Scalar>(character.mesh, character.binding.distance, {}, options), character.mesh.tets,
        options);
    pbs::Positions before = blended(character, pose), after = before;
    const pbs::Vec3 origin = pbs::local_origin<Scalar>(before);
    projection->load(before, pbs::posed_bind_points(character.binding, pose), origin);
    projection->store(origin, before);  // rounded as in the projection
    if (projected == ProjectedClass::stretch) projection->project_stretch_constraints();
    if (projected == ProjectedClass::volume) projection->project_volume_constraints();
    if (projected == ProjectedClass::bind) projection->project_bind_constraints();
    projection->store(origin, after);

    const pbs::Vec3 centre = before.transpose() * mass / mass.sum();
    Momentum sum;
    for (Eigen::Index i = 0; i < mass.size(); ++i)
        sum.add(before.row(i).transpose() - centre, mass(i) * (after.row(i) - before.row(i)).transpose());
    return {sum.linear.norm() / sum.linear_sum, sum.angular.norm() / sum.angular_sum};
}

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
void add(std::vector<analysis::Measurement>& rows, ProjectedClass projected, const std::string& suffix,
         const analysis::CaseKey& key, const MomentumDrift& drift)
{
    const std::string bones = projected == ProjectedClass::bind ? "_taken_by_bones" : "";
    for (const auto& [quantity, value] : {std::pair{"linear_drift", drift.linear}, {"angular_drift", drift.angular}})
        rows.push_back({"C07", quantity + suffix + bones, key, value, value, value, "1"});
}

std::string measure_drift(const MomentumCase& momentum_case, const std::string& folder)
{
    const PosedCharacter posed(momentum_case.scene, {momentum_case.frame});
    pbs::PbsOptions options = options_of<pbs::PbsOptions>(spec_of(momentum_case.scene, "pbs"));
    options.jiggle.reset();
    std::vector<analysis::Measurement> rows;
    for (const auto& [precision, precision_name] : OptionNames<pbs::Precision>::table)
        for (const Setting& setting : settings)
            for (const auto& [projected, class_name] : classes) {
                options.precision = precision;
                options.masses = setting.known;
                analysis::CaseKey key = {.body = momentum_case.name,
                                         .precision = precision_name,
                                         .masses = setting.name,
                                         .constraint = class_name};
                add(rows, projected, "", key,
                    drift_of_projections(posed.character(), posed.pose(0), options, projected, setting.counted));
                for (const pbs::Order order : {pbs::Order::ordered, pbs::Order::plain}) {
                    options.order = order;
                    key.order = name_of(order);
                    add(rows, projected, "_of_a_pass", key,
                        drift_of_a_pass(posed.character(), posed.pose(0), options, projected, setting.counted));
                }
            }
    analysis::measurement_table(rows).write(analysis::path_in(folder, "measurements.csv"));
    return {};
}

void add_case(const StudyCase& study_case, StudyPlan& plan)
{
    plan.runs.push_back(work_run<MomentumCase>(
        study_case.name,
        {study_case.value("body", study_case.name), study_case.scene(), study_case.value<int>("frame")},
        study_case.cost_s, measure_drift));
}

StudyPlan plan(bool full)
{
    return plan_of_cases("momentum", full, add_case);
}

}  // namespace

MomentumDrift drift_of_projections(const pbs::Character& character, const pbs::Pose& pose,
                                   const pbs::PbsOptions& options, ProjectedClass projected, pbs::Masses counted)
{
    const Eigen::VectorXd mass = masses_of(character, counted);
    return options.precision == pbs::Precision::f32
               ? single_projections<float>(character, pose, options, projected, mass)
               : single_projections<double>(character, pose, options, projected, mass);
}

MomentumDrift drift_of_a_pass(const pbs::Character& character, const pbs::Pose& pose, const pbs::PbsOptions& options,
                              ProjectedClass projected, pbs::Masses counted)
{
    const Eigen::VectorXd mass = masses_of(character, counted);
    return options.precision == pbs::Precision::f32 ? one_pass<float>(character, pose, options, projected, mass)
                                                    : one_pass<double>(character, pose, options, projected, mass);
}

Study momentum_study()
{
    return {"momentum", plan, quick_and_full, nullptr, false, nullptr, add_case};
}

}  // namespace experiments
