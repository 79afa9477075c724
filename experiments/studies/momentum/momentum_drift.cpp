#include "experiments/studies/momentum/momentum_drift.hpp"

#include "pbs/constraints/volume_printed.hpp"
#include "pbs/geometry/tet_volume.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/particles.hpp"
#include "pbs/solver/projection.hpp"

#include <Eigen/Geometry>

namespace experiments {
namespace {

pbs::Positions blended(const pbs::Character& character, const pbs::Pose& pose)
{
    pbs::Positions positions;
    pbs::linear_blend_skinning(character.mesh.rest, character.weights, pose, positions);
    return positions;
}

Eigen::VectorXd masses_of(const pbs::Character& character, pbs::Masses counted)
{
    if (counted == pbs::Masses::unit) return Eigen::VectorXd::Ones(character.mesh.rest.rows());
    return pbs::lumped_volumes(character.mesh.rest, character.mesh.tets);
}

// Momentum of corrections with and without direction.
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

// What single projections leave, one after the other added up without direction.
class SingleProjections {
public:
    SingleProjections(const pbs::Vec3& centre, const Eigen::VectorXd& mass) : centre_(centre), mass_(mass) {}

    template <typename Scalar, std::size_t n>
    void add(const std::array<int, n>& vertex, const std::array<pbs::Vector3<Scalar>, n>& before,
             const std::array<pbs::Vector3<Scalar>, n>& after)
    {
        Momentum own;
        for (std::size_t i = 0; i < n; ++i) {
            const pbs::Vec3 p = before[i].template cast<double>();
            own.add(p - centre_, mass_(vertex[i]) * (after[i].template cast<double>() - p));
        }
        linear_ += own.linear.norm();
        angular_ += own.angular.norm();
        linear_sum_ += own.linear_sum;
        angular_sum_ += own.angular_sum;
    }

    MomentumDrift drift() const { return {linear_ / linear_sum_, angular_ / angular_sum_}; }

private:
    pbs::Vec3 centre_;
    const Eigen::VectorXd& mass_;
    double linear_ = 0.0, angular_ = 0.0, linear_sum_ = 0.0, angular_sum_ = 0.0;
};

// The printed forms are for m_i = 1.
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
    const pbs::Positions positions = blended(character, pose), q = pbs::posed_bind_points(character.binding, pose);
    const pbs::Vec3 centre = positions.transpose() * mass / mass.sum();
    const auto point = [&](const pbs::Positions& of, int i) -> pbs::Vector3<Scalar> {
        return (of.row(i).transpose() - centre).template cast<Scalar>();
    };
    const auto& w = set.inverse_mass;
    SingleProjections sum(pbs::Vec3::Zero(), mass);
    for (const auto& edge : set.stretch) {
        if (projected != ProjectedClass::stretch) break;
        const auto [i, j] = edge.vertex;
        const std::array before = {point(positions, i), point(positions, j)};
        auto after = before;
        project(edge, w[i], w[j], after[0], after[1]);
        sum.add(edge.vertex, before, after);
    }
    for (const auto& tet : set.volume) {
        if (projected != ProjectedClass::volume) break;
        const auto [i, j, k, l] = tet.vertex;
        const std::array before = {point(positions, i), point(positions, j), point(positions, k), point(positions, l)};
        auto after = before;
        project_as(options.volume_form, tet, w, after);
        sum.add(tet.vertex, before, after);
    }
    for (const auto& bind : set.bind) {
        if (projected != ProjectedClass::bind) break;
        const std::array before = {point(positions, bind.vertex)};
        auto after = before;
        project(bind, w[bind.vertex], point(q, bind.vertex), after[0]);
        sum.add(std::array{bind.vertex}, before, after);
    }
    return sum.drift();
}

template <typename Scalar>
MomentumDrift one_pass(const pbs::Character& character, const pbs::Pose& pose, const pbs::PbsOptions& options, ProjectedClass projected,
                       const Eigen::VectorXd& mass)
{
    const auto projection = pbs::make_projection<Scalar>(
        pbs::make_constraint_set<Scalar>(character.mesh, character.binding.distance, {}, options), character.mesh.tets, options);
    pbs::Positions before = blended(character, pose), after = before;
    const pbs::Vec3 origin = pbs::local_origin<Scalar>(before);
    projection->load(before, pbs::posed_bind_points(character.binding, pose), origin);
    projection->store(origin, before);  // rounded as the projection has them
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

}  // namespace

MomentumDrift drift_of_projections(const pbs::Character& character, const pbs::Pose& pose, const pbs::PbsOptions& options,
                                   ProjectedClass projected, pbs::Masses counted)
{
    const Eigen::VectorXd mass = masses_of(character, counted);
    return options.precision == pbs::Precision::f32 ? single_projections<float>(character, pose, options, projected, mass)
                                                    : single_projections<double>(character, pose, options, projected, mass);
}

MomentumDrift drift_of_a_pass(const pbs::Character& character, const pbs::Pose& pose, const pbs::PbsOptions& options,
                              ProjectedClass projected, pbs::Masses counted)
{
    const Eigen::VectorXd mass = masses_of(character, counted);
    return options.precision == pbs::Precision::f32 ? one_pass<float>(character, pose, options, projected, mass)
                                                    : one_pass<double>(character, pose, options, projected, mass);
}

}  // namespace experiments
