#include "pbs/solver/pbs_solver.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/packed/vertex_order.hpp"
#include "pbs/solver/algorithm_1.hpp"

#include <variant>

namespace pbs {

bool shared_among_threads(int vertices)
{
    return vertices_a_slab(vertices) < vertices;
}

using AnyAlgorithm1 = std::variant<Algorithm1<float>, Algorithm1<double>>;

class PbsSolver::Implementation {
public:
    AnyAlgorithm1 algorithm;
};

PbsSolver::PbsSolver(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone,
                     const PbsOptions& options, const std::vector<bool>& held)
{
    const auto build = [&]() -> AnyAlgorithm1 {
        if (options.precision == Precision::f32) return Algorithm1<float>(mesh, bind_distance, jiggle_zone, options, held);
        return Algorithm1<double>(mesh, bind_distance, jiggle_zone, options, held);
    };
    implementation_ = std::make_unique<Implementation>(Implementation{build()});
}

PbsSolver::~PbsSolver() = default;

StepSummary PbsSolver::advance(const Positions& lbs_positions, const Positions& bind_points, double dt_s)
{
    return std::visit([&](auto& algorithm) { return algorithm.advance(lbs_positions, bind_points, dt_s); }, implementation_->algorithm);
}

const Positions& PbsSolver::positions() const
{
    return std::visit([](const auto& algorithm) -> const Positions& { return algorithm.positions(); }, implementation_->algorithm);
}

using AnyPosesAlgorithm1 = std::variant<PosesAlgorithm1<float>, PosesAlgorithm1<double>>;

class PosesSolver::Implementation {
public:
    AnyPosesAlgorithm1 algorithm;
};

namespace {

void check_poses(const std::vector<PbsOptions>& options)
{
    const auto refuse = [](const char* field, const std::string& rule) { throw InputError("pbs", 0, field, "", rule); };
    if (options.empty()) refuse("poses", "expected one or more");
    for (const PbsOptions& pose : options) {
        if (pose.order == Order::plain) refuse("order", "expected ordered or grouped for many poses at once");
        if (pose.order != options[0].order || pose.precision != options[0].precision || pose.masses != options[0].masses)
            refuse("poses", "expected one order, precision and kind of masses for all");
        if (pose.jiggle.has_value() != options[0].jiggle.has_value()) refuse("jiggle", "expected in all poses or none");
        if (pose.volume_form != VolumeForm::derived) refuse("volume_form", "expected derived for many poses at once");
        if (pose.class_order != ClassOrder::bind_stretch_volume || pose.lbs_entry != LbsEntry::start ||
            pose.bind_on_bone != BindOnBone::pinned || (pose.jiggle && pose.jiggle->k_bind))
            refuse("poses", "expected Algorithm 1's own reading (class_order, lbs_entry, bind_on_bone, jiggle.k_bind) for many at once");
        if (pose.bind_to != BindTo::bone_distance || pose.volume_of != VolumeOf::tets || pose.k_stretch_length_m != 0.0)
            refuse("poses", "expected the paper's constraints (bind_to, volume_of, k_stretch_length_m) for many at once");
        if (pose.stop_residual > 0.0 || pose.record_iterations || pose.sleep)
            refuse("poses", "expected no stop_residual, record_iterations or sleep for many at once");
    }
}

}  // namespace

PosesSolver::PosesSolver(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone,
                         const std::vector<PbsOptions>& options, const std::vector<bool>& held)
{
    check_poses(options);
    const auto build = [&]() -> AnyPosesAlgorithm1 {
        if (options[0].precision == Precision::f32) return PosesAlgorithm1<float>(mesh, bind_distance, jiggle_zone, options, held);
        return PosesAlgorithm1<double>(mesh, bind_distance, jiggle_zone, options, held);
    };
    implementation_ = std::make_unique<Implementation>(Implementation{build()});
}

PosesSolver::~PosesSolver() = default;

std::vector<StepSummary> PosesSolver::advance(const std::vector<Positions>& lbs_positions, const std::vector<Positions>& bind_points,
                                              double dt_s)
{
    return std::visit([&](auto& algorithm) { return algorithm.advance(lbs_positions, bind_points, dt_s); }, implementation_->algorithm);
}

const Positions& PosesSolver::positions(int pose) const
{
    return std::visit([&](const auto& algorithm) -> const Positions& { return algorithm.positions(pose); }, implementation_->algorithm);
}

}  // namespace pbs
