#include "pbs/solver/pbs_solver.hpp"

#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/packed/parallel.hpp"
#include "pbs/packed/vertex_order.hpp"
#include "pbs/solver/algorithm_1.hpp"
#include "pbs/solver/batched/pose_projection.hpp"

#include <algorithm>
#include <variant>

namespace pbs {

bool shared_among_threads(int vertices)
{
    return vertices_a_slab(vertices) < vertices;
}

struct PbsSolver::Implementation {
    std::variant<Algorithm1<float>, Algorithm1<double>> algorithm;
};

PbsSolver::PbsSolver(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone,
                     const PbsOptions& options, const std::vector<bool>& held)
    : implementation_(options.precision == Precision::f32
                          ? std::make_unique<Implementation>(
                                Implementation{Algorithm1<float>(mesh, bind_distance, jiggle_zone, options, held)})
                          : std::make_unique<Implementation>(
                                Implementation{Algorithm1<double>(mesh, bind_distance, jiggle_zone, options, held)}))
{
}

PbsSolver::~PbsSolver() = default;

StepSummary PbsSolver::advance(const Positions& lbs_positions, const Positions& bind_points, double dt_s)
{
    return std::visit([&](auto& algorithm) { return algorithm.advance(lbs_positions, bind_points, dt_s); },
                      implementation_->algorithm);
}

const Positions& PbsSolver::positions() const
{
    return std::visit([](const auto& algorithm) -> const Positions& { return algorithm.positions(); },
                      implementation_->algorithm);
}

class PosesSolver::Implementation {
public:
    virtual ~Implementation() = default;
    virtual std::vector<StepSummary> advance(const std::vector<Positions>& lbs_positions,
                                             const std::vector<Positions>& bind_points, double dt_s) = 0;
    virtual const Positions& positions(int pose) const = 0;
};

namespace {

// Every class that any of the poses has, with stiffness one.
PbsOptions of_any(const std::vector<PbsOptions>& options)
{
    PbsOptions any = options.front();
    any.stiffness_form = StiffnessForm::per_iteration;
    any.k_stretch = any.k_volume = any.k_bind = 0.0;
    if (any.jiggle) any.jiggle->k_stretch = 0.0;
    for (const PbsOptions& pose : options) {
        if (pose.k_stretch > 0.0) any.k_stretch = 1.0;
        if (pose.k_volume > 0.0) any.k_volume = 1.0;
        if (pose.k_bind > 0.0) any.k_bind = 1.0;
        if (pose.jiggle && pose.jiggle->k_stretch > 0.0) any.jiggle->k_stretch = 1.0;
    }
    return any;
}

template <typename T>
const T& of_pose(const std::vector<T>& values, std::size_t pose)
{
    return values.size() == 1 ? values.front() : values[pose];
}

void check_count(const char* field, std::size_t count, std::size_t poses)
{
    if (count != 1 && count != poses)
        throw InputError("pbs", 0, field, std::to_string(count),
                         "expected one per pose, " + std::to_string(poses) + ", or one for all");
}

void check_poses(const std::vector<PbsOptions>& options)
{
    const auto refuse = [](const char* field, const std::string& rule) { throw InputError("pbs", 0, field, "", rule); };
    if (options.empty()) refuse("poses", "expected one or more");
    for (const PbsOptions& pose : options) {
        if (pose.order != Order::ordered) refuse("order", "expected ordered for many poses at once");
        if (pose.order != options[0].order || pose.precision != options[0].precision ||
            pose.masses != options[0].masses)
            refuse("poses", "expected one order, precision and kind of masses for all");
        if (pose.jiggle.has_value() != options[0].jiggle.has_value()) refuse("jiggle", "expected in all poses or none");
        if (pose.volume_form != VolumeForm::derived) refuse("volume_form", "expected derived for many poses at once");
        if (pose.class_order != ClassOrder::bind_stretch_volume || pose.lbs_entry != LbsEntry::start ||
            pose.bind_on_bone != BindOnBone::pinned || (pose.jiggle && pose.jiggle->k_bind))
            refuse("poses",
                   "expected Algorithm 1's own reading (class_order, lbs_entry, bind_on_bone, jiggle.k_bind) for many "
                   "at once");
        if (pose.bind_to != BindTo::bone_distance || pose.volume_of != VolumeOf::tets || pose.k_stretch_length_m != 0.0)
            refuse("poses",
                   "expected the paper's constraints (bind_to, volume_of, k_stretch_length_m) for many at once");
        if (pose.contact) refuse("contact", "expected false for many poses at once");
        if (pose.stop_residual > 0.0 || pose.record_iterations || pose.sleep)
            refuse("poses", "expected no stop_residual, record_iterations or sleep for many at once");
    }
}

// Implementation: the private class of PosesSolver.
template <typename Implementation, typename Scalar>
class PosesAlgorithm1 : public Implementation {
public:
    PosesAlgorithm1(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone,
                    const std::vector<PbsOptions>& options, const std::vector<bool>& held)
        : options_(options), parallel_(options.front().threads)
    {
        for (const PbsOptions& pose : options) {
            check_options(pose);
            particles_.emplace_back(mesh.rest, jiggle_zone, pose);
        }
        const bool jiggle = options.front().jiggle.has_value();
        const ConstraintSet<Scalar> constraints =
            make_constraint_set<Scalar>(mesh, bind_distance, jiggle_zone, of_any(options), held);
        program_ = make_pose_program(constraints, mesh.tets, jiggle ? jiggle_zone : std::vector<bool>{});
        work_an_iteration_ = {.tet_visits = static_cast<std::int64_t>(constraints.volume.size()),
                              .projections = static_cast<std::int64_t>(
                                  constraints.bind.size() + constraints.stretch.size() + constraints.volume.size())};
        for (std::size_t first = 0; first < options.size(); first += poses_a_block) {
            const std::size_t last = std::min(first + poses_a_block, options.size());
            blocks_.emplace_back(program_, std::vector<PbsOptions>(options.begin() + first, options.begin() + last));
        }
    }

    std::vector<StepSummary> advance(const std::vector<Positions>& lbs_positions,
                                     const std::vector<Positions>& bind_points, double dt_s) override
    {
        check_count("lbs_positions", lbs_positions.size(), particles_.size());
        check_count("bind_points", bind_points.size(), particles_.size());
        const Stopwatch stopwatch;
        for (std::size_t i = 0; i < particles_.size(); ++i) {
            particles_[i].check_input(of_pose(lbs_positions, i), of_pose(bind_points, i), dt_s);
            particles_[i].predict(of_pose(lbs_positions, i), dt_s);  // (2)-(9)
        }
        // (10)-(14)
        parallel_.for_each(static_cast<int>(blocks_.size()), [&](int block) { project_block(block, bind_points); });
        std::vector<StepSummary> summaries(particles_.size());
        for (std::size_t i = 0; i < particles_.size(); ++i) {
            particles_[i].update(dt_s);  // (15)-(18)
            summaries[i].iterations = options_[i].iterations;
            summaries[i].work = {.tet_visits = options_[i].iterations * work_an_iteration_.tet_visits,
                                 .projections = options_[i].iterations * work_an_iteration_.projections};
            if (!particles_[i].positions().allFinite()) summaries[i].outcome = Outcome::not_finite;
        }
        for (StepSummary& summary : summaries) summary.seconds = stopwatch.seconds() / double(summaries.size());
        return summaries;
    }

    const Positions& positions(int pose) const override { return particles_[pose].positions(); }

private:
    // A pose leaves its block after its own number of iterations; the others go on.
    void project_block(std::size_t block, const std::vector<Positions>& bind_points)
    {
        const std::size_t first = block * poses_a_block, last = std::min(first + poses_a_block, particles_.size());
        PoseBlock<Scalar>& poses = blocks_[block];
        std::vector<Vec3> origin;
        int most = 0;
        for (std::size_t i = first; i < last; ++i) {
            origin.push_back(local_origin<Scalar>(particles_[i].predicted()));
            poses.load(static_cast<int>(i - first), particles_[i].predicted(), of_pose(bind_points, i), origin.back());
            most = std::max(most, options_[i].iterations);
        }
        const auto store_those_done = [&](int iterations) {
            for (std::size_t i = first; i < last; ++i)
                if (options_[i].iterations == iterations)
                    poses.store(static_cast<int>(i - first), origin[i - first], particles_[i].predicted());
        };
        store_those_done(0);
        // (10)
        for (int iteration = 1; iteration <= most; ++iteration) {
            poses.project_bind_constraints();     // (11)
            poses.project_stretch_constraints();  // (12)
            poses.project_volume_constraints();   // (13)
            store_those_done(iteration);
        }  // (14)
    }

    std::vector<PbsOptions> options_;   // of each pose
    WorkCounters work_an_iteration_;    // of a pose; constraints that any of the poses has
    std::vector<Particles> particles_;  // of each pose
    PoseProgram<Scalar> program_;
    std::vector<PoseBlock<Scalar>> blocks_;  // sixteen poses each, the last maybe fewer
    Parallel parallel_;
};

}  // namespace

PosesSolver::PosesSolver(const TetMesh& mesh, const Eigen::VectorXd& bind_distance,
                         const std::vector<bool>& jiggle_zone, const std::vector<PbsOptions>& options,
                         const std::vector<bool>& held)
{
    check_poses(options);
    if (options[0].precision == Precision::f32)
        implementation_ =
            std::make_unique<PosesAlgorithm1<Implementation, float>>(mesh, bind_distance, jiggle_zone, options, held);
    else
        implementation_ =
            std::make_unique<PosesAlgorithm1<Implementation, double>>(mesh, bind_distance, jiggle_zone, options, held);
}

PosesSolver::~PosesSolver() = default;

std::vector<StepSummary> PosesSolver::advance(const std::vector<Positions>& lbs_positions,
                                              const std::vector<Positions>& bind_points, double dt_s)
{
    return implementation_->advance(lbs_positions, bind_points, dt_s);
}

const Positions& PosesSolver::positions(int pose) const
{
    return implementation_->positions(pose);
}

}  // namespace pbs
