#include "pbs/solver/batched/pose_projection.hpp"

#include "pbs/solver/batched/pbs_kernels.hpp"

namespace pbs {

template <typename Scalar>
PoseProgram<Scalar> make_pose_program(const ConstraintSet<Scalar>& constraints, const Tets& tets,
                                      const std::vector<bool>& jiggle_zone)
{
    const BatchedConstraints<Scalar> batched = make_batched_constraints(constraints, tets);
    const std::vector<int>& old_of_new = batched.order.old_of_new;
    const auto w = [&](int i) { return constraints.inverse_mass[old_of_new[i]]; };
    const auto jiggles = [&](int i) { return !jiggle_zone.empty() && jiggle_zone[old_of_new[i]]; };

    PoseProgram<Scalar> program{batched.order, {}, {}, {}};
    batched.stretch.for_each_constraint([&](const auto& vertex, Scalar rest, Scalar one_over_w) {
        if constexpr (std::tuple_size_v<std::decay_t<decltype(vertex)>> == 2) {
            const auto [i, j] = vertex;
            const StiffnessOf stiffness =
                jiggles(i) && jiggles(j) ? StiffnessOf::jiggling_stretch : StiffnessOf::stretch;
            program.edges.push_back(
                {{{std::uint32_t(i), std::uint32_t(j)}, stiffness, rest, {w(i), w(j)}}, one_over_w});
        }
    });
    batched.volume.for_each_constraint([&](const auto& vertex, Scalar rest, Scalar) {
        if constexpr (std::tuple_size_v<std::decay_t<decltype(vertex)>> == 4) {
            const auto [i, j, k, l] = vertex;
            program.tets.push_back({{std::uint32_t(i), std::uint32_t(j), std::uint32_t(k), std::uint32_t(l)},
                                    StiffnessOf::volume,
                                    rest,
                                    {w(i), w(j), w(k), w(l)}});
        }
    });
    if (constraints.bind.empty()) return program;
    program.binds.resize(old_of_new.size(), {});
    for (const BindConstraint<Scalar>& bind : constraints.bind)
        program.binds[batched.order.new_of_old[bind.vertex]] = {
            bind.rest_distance, Scalar(constraints.inverse_mass[bind.vertex] > Scalar(0))};
    return program;
}

template <typename Scalar>
PoseBlock<Scalar>::PoseBlock(const PoseProgram<Scalar>& program, const std::vector<PbsOptions>& poses)
    : program_(&program),
      poses_(3 * program.order.old_of_new.size(), Row{}),
      bind_points_(program.binds.empty() ? 0 : poses_.size(), Row{}),
      stiffness_{}
{
    for (std::size_t lane = 0; lane < poses.size(); ++lane) {
        const PbsOptions& pose = poses[lane];
        const double k[] = {pose.k_stretch, pose.jiggle ? pose.jiggle->k_stretch : pose.k_stretch, pose.k_volume,
                            pose.k_bind};
        for (int which = 0; which < stiffness_classes + 1; ++which)
            stiffness_[which].pose[lane] = Scalar(share_removed(k[which], pose));
    }
}

template <typename Scalar>
void PoseBlock<Scalar>::load(int lane, const Positions& p, const Positions& q, const Vec3& origin)
{
    const std::vector<int>& old_of_new = program_->order.old_of_new;
    for (std::size_t i = 0; i < old_of_new.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) {
            poses_[3 * i + axis].pose[lane] = Scalar(p(old_of_new[i], axis) - origin(axis));
            if (!bind_points_.empty())
                bind_points_[3 * i + axis].pose[lane] = Scalar(q(old_of_new[i], axis) - origin(axis));
        }
}

template <typename Scalar>
void PoseBlock<Scalar>::store(int lane, const Vec3& origin, Positions& p) const
{
    const std::vector<int>& old_of_new = program_->order.old_of_new;
    for (std::size_t i = 0; i < old_of_new.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            p(old_of_new[i], axis) = double(poses_[3 * i + axis].pose[lane]) + origin(axis);
}

template <typename Scalar>
void PoseBlock<Scalar>::project_bind_constraints()
{
    if (program_->binds.empty()) return;
    project_pose_binds(program_->binds.data(), program_->binds.size(), stiffness_[3].pose, bind_points_.front().pose,
                       poses_.front().pose);
}

template <typename Scalar>
void PoseBlock<Scalar>::project_stretch_constraints()
{
    project_pose_edges(program_->edges.data(), program_->edges.size(), stiffness_[0].pose, poses_.data()->pose);
}

template <typename Scalar>
void PoseBlock<Scalar>::project_volume_constraints()
{
    project_pose_tets(program_->tets.data(), program_->tets.size(), stiffness_[0].pose, poses_.data()->pose);
}

template PoseProgram<float> make_pose_program(const ConstraintSet<float>&, const Tets&, const std::vector<bool>&);
template PoseProgram<double> make_pose_program(const ConstraintSet<double>&, const Tets&, const std::vector<bool>&);
template class PoseBlock<float>;
template class PoseBlock<double>;

}  // namespace pbs
