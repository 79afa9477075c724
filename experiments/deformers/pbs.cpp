// LBS, then position based dynamics: the paper's two-layered deformer (Algorithm 1), XPBD, which costs what PBS costs
// (n iterations, or n substeps with one iteration each) and whose jiggling vertices are those of PBS, and the code that
// the paper's first author published.
#include "experiments/deformers/deformer_kind.hpp"
#include "pbs/author/author_solver.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "pbs/solver/xpbd_solver.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace experiments {

pbs::Positions bind_points_of(const pbs::PbsOptions& options, const pbs::Character& character, const pbs::Pose& pose,
                              const pbs::Positions& lbs)
{
    return options.bind_point == pbs::BindPoint::reprojected
               ? pbs::reprojected_bind_points(character.binding, character.skeleton, pose, lbs)
               : pbs::posed_bind_points(character.binding, pose);
}

namespace {

std::vector<bool> zone_of(const pbs::PbsOptions& options, const pbs::BoneBinding& binding)
{
    if (!options.jiggle) return {};
    return options.jiggle->zone_mean == pbs::ZoneMean::of_bone ? pbs::jiggle_zone_by_bone(binding)
                                                               : pbs::jiggle_zone(binding);
}

std::vector<bool> zone_of(const pbs::XpbdOptions& options, const pbs::BoneBinding& binding)
{
    return options.jiggle ? pbs::jiggle_zone(binding) : std::vector<bool>{};
}

// Blends, and projects what LBS leaves. The positions are the solver's.
template <typename Options, typename Solver>
class ProjectingDeformer : public Deformer {
public:
    explicit ProjectingDeformer(const Options& options) : options_(options) {}
    void reset(const pbs::Character& character) override
    {
        character_ = &character;
        next_start_.reset();
        skinning_.emplace(character.mesh.rest, begins_at_lbs() ? character.weights : smooth_weights_of(character));
        solver_ = std::make_unique<Solver>(character.mesh, character.binding.distance,
                                           zone_of(options_, character.binding), options_);
    }
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override
    {
        const pbs::Stopwatch stopwatch;
        if (next_start_)
            start_ = *std::exchange(next_start_, {});
        else if (begins_at_lbs())
            skinning_->linear(pose, start_);
        else
            skinning_->dual_quaternion(pose, start_);
        pbs::StepSummary summary = solver_->advance(start_, bind_points(pose, start_), dt_s);
        summary.seconds = stopwatch.seconds();
        summary.work.vertex_visits += start_.rows();
        return summary;
    }
    void start_from(const pbs::Positions& shape) override { next_start_ = shape; }
    const pbs::Positions& positions() const override { return solver_->positions(); }
    bool has_memory() const override { return bool(options_.jiggle); }

protected:
    bool begins_at_lbs() const { return options_.start == pbs::StartShape::lbs; }
    pbs::Positions bind_points(const pbs::Pose& pose, const pbs::Positions& lbs) const
    {
        if constexpr (std::is_same_v<Options, pbs::PbsOptions>) return bind_points_of(options_, *character_, pose, lbs);
        return pbs::posed_bind_points(character_->binding, pose);
    }

    Options options_;
    const pbs::Character* character_ = nullptr;
    std::optional<pbs::BlendSkinning<double>> skinning_;
    std::optional<pbs::Positions> next_start_;

private:
    std::unique_ptr<Solver> solver_;
    pbs::Positions start_;
};

class PbsDeformer : public ProjectingDeformer<pbs::PbsOptions, pbs::PbsSolver> {
public:
    using ProjectingDeformer::ProjectingDeformer;
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override
    {
        if (next_start_) foreseen_.clear();  // the frames were foreseen with another start
        if (next_ < foreseen_.size()) return advance_ahead(dt_s);
        ahead_.reset();
        return ProjectingDeformer::advance(pose, dt_s);
    }
    // With several threads, on a mesh whose steps cannot be shared among them, frames are projected in parallel,
    // sixteen per thread. The results are equal to the bit to those of single frames.
    void foresee(const std::vector<pbs::Pose>& poses) override
    {
        foreseen_ = works_ahead() ? poses : std::vector<pbs::Pose>{};
        next_ = 0;
        ahead_.reset();
    }
    const pbs::Positions& positions() const override
    {
        return ahead_ ? ahead_->positions(done_ahead_ - 1) : ProjectingDeformer::positions();
    }
    bool has_memory() const override { return options_.jiggle || options_.lbs_entry == pbs::LbsEntry::increment; }

private:
    bool works_ahead() const
    {
        const bool another_reading = options_.class_order != pbs::ClassOrder::bind_stretch_volume ||
                                     options_.lbs_entry != pbs::LbsEntry::start ||
                                     options_.bind_on_bone != pbs::BindOnBone::pinned;
        const bool other_constraints = options_.bind_to != pbs::BindTo::bone_distance ||
                                       options_.volume_of != pbs::VolumeOf::tets || options_.k_stretch_length_m != 0.0;
        const bool each_its_own = another_reading || other_constraints || options_.contact || options_.jiggle ||
                                  options_.sleep || options_.stop_residual > 0.0 || options_.record_iterations ||
                                  !begins_at_lbs();
        return options_.threads > 1 && options_.order == pbs::Order::ordered && !each_its_own &&
               !pbs::shared_among_threads(static_cast<int>(character_->mesh.rest.rows()));
    }
    // Returns the next of the frames that are done, or else of a new lot.
    pbs::StepSummary advance_ahead(double dt_s)
    {
        if (!ahead_ || done_ahead_ == static_cast<int>(steps_ahead_.size())) {
            const pbs::Stopwatch stopwatch;
            const std::size_t lot =
                std::min(static_cast<std::size_t>(options_.threads) * pbs::poses_at_once, foreseen_.size() - next_);
            std::vector<pbs::Positions> lbs(lot), bind_points(lot);
            for (std::size_t i = 0; i < lot; ++i) {
                skinning_->linear(foreseen_[next_ + i], lbs[i]);
                bind_points[i] = bind_points_of(options_, *character_, foreseen_[next_ + i], lbs[i]);
            }
            if (!ahead_ || lot != steps_ahead_.size())
                ahead_ = std::make_unique<pbs::PosesSolver>(character_->mesh, character_->binding.distance,
                                                            std::vector<bool>{},
                                                            std::vector<pbs::PbsOptions>(lot, options_));
            steps_ahead_ = ahead_->advance(lbs, bind_points, dt_s);
            for (pbs::StepSummary& step : steps_ahead_) {
                step.seconds = stopwatch.seconds() / double(lot);
                step.work.vertex_visits += character_->mesh.rest.rows();
            }
            done_ahead_ = 0;
        }
        ++next_;
        return steps_ahead_[done_ahead_++];
    }

    // coming poses; empty: they are not known, or working ahead does not pay
    std::vector<pbs::Pose> foreseen_;
    std::size_t next_ = 0;                       // the next one of them
    std::unique_ptr<pbs::PosesSolver> ahead_;    // the frames of foreseen_ from next_ - done_ahead_
    std::vector<pbs::StepSummary> steps_ahead_;  // of these frames
    int done_ahead_ = 0;
};

using pbs::XpbdOptions;
using XpbdDeformer = ProjectingDeformer<XpbdOptions, pbs::XpbdSolver>;

// Position based skinning as in the code that the paper's first author published in 2018
// (pbs/author/author_solver.hpp). pbs_author.md lists where that code departs from the paper; `pbskin explain
// pbs_author` prints it. It has its own weights, whatever those of the scene are, and its own time step, whatever the
// frame rate.
class PbsAuthorDeformer : public Deformer {
public:
    explicit PbsAuthorDeformer(const pbs::AuthorOptions& options) : options_(options) {}
    void reset(const pbs::Character& character) override
    {
        solver_.emplace(character.mesh, character.skeleton, character.binding, options_);
    }
    pbs::StepSummary advance(const pbs::Pose& pose, double /*dt_s*/) override { return solver_->advance(pose); }
    const pbs::Positions& positions() const override { return solver_->positions(); }
    bool has_memory() const override { return true; }

private:
    pbs::AuthorOptions options_;
    std::optional<pbs::AuthorSolver> solver_;
};

// Both kinds of XPBD share one table of a scene; iterations, gravity and jiggle are those of PBS.
void read_with_pbs(const SceneValues& values, const std::string& /*table*/, XpbdOptions& options, DeformerSpec& spec)
{
    options.iterations = values.integer("pbs.iterations");
    options.gravity_m_s2 = read_option<pbs::Vec3>(values, "pbs.gravity_m_s2");
    options.jiggle = values.has_table("pbs.jiggle");
    if (options.jiggle) spec.variant = "jiggle";
}

void read_small_steps(const SceneValues& values, const std::string& table, XpbdOptions& options, DeformerSpec& spec)
{
    read_with_pbs(values, table, options, spec);
    options.substeps = std::max(options.iterations, 1);
    options.iterations = 1;
}

DeformerKind kind_of_xpbd(const std::string& name, const std::string& meaning, CheckOptions<XpbdOptions> check)
{
    const auto fields =
        OptionFields<XpbdOptions>("xpbd")
            .add("young_pa", &XpbdOptions::young_pa,
                 {.unit = "Pa", .range = {above_zero}, .meaning = "Young's modulus of xpbd and xpbd_small_steps"})
            .add("poisson", &XpbdOptions::poisson,
                 {.range = {0.25, 0.499999},
                  .meaning = "Poisson's ratio; springs alone have 1/4, volume constraints raise it"})
            .add("density_kg_m3", &XpbdOptions::density_kg_m3,
                 {.unit = "kg/m^3", .range = {above_zero}, .meaning = "density, lumped"})
            .add("order", &XpbdOptions::order,
                 {.meaning =
                      "order of projection within a class: plain is the order of the file; ordered and spread are "
                      "those of pbs"})
            .add("precision", &XpbdOptions::precision,
                 {.meaning = "floating point of the projections and their multipliers"})
            .add("start", &XpbdOptions::start, {.meaning = start_meaning})
            .record("iterations", &XpbdOptions::iterations)
            .record("substeps", &XpbdOptions::substeps)
            .record("gravity_m_s2", &XpbdOptions::gravity_m_s2)
            .record("jiggle", &XpbdOptions::jiggle)
            .record("keep_multipliers", &XpbdOptions::keep_multipliers)
            .complete(1);  // except for threads
    DeformerKind kind = kind_of<XpbdDeformer>(name, meaning, fields, check);
    kind.traits = [](const DeformerSpec& spec) {
        const auto& options = options_of<XpbdOptions>(spec);
        DeformerTraits traits = traits_from(options, spec);
        traits.iterations = options.iterations * options.substeps;
        if (!traits.packed) traits.threads = 1;
        return traits;
    };
    return kind;
}

}  // namespace

DeformerKind pbs_kind()
{
    DeformerKind kind = kind_of<PbsDeformer>(
        "pbs", "the paper: LBS, then bind, stretch and volume constraints (Algorithm 1)", pbs_fields(), check_pbs);
    kind.traits = [](const DeformerSpec& spec) {
        const auto& options = options_of<pbs::PbsOptions>(spec);
        DeformerTraits traits = traits_from(options, spec);
        traits.sleeps = options.sleep;
        traits.is_negative_control = options.volume_form != pbs::VolumeForm::derived;
        return traits;
    };
    return kind;
}

DeformerKind xpbd_kind()
{
    return kind_of_xpbd("xpbd",
                        "LBS, then extended position based dynamics (Macklin 2016) with an elastic material; "
                        "multipliers are kept through a step",
                        read_with_pbs);
}

DeformerKind xpbd_small_steps_kind()
{
    DeformerKind kind = kind_of_xpbd(
        "xpbd_small_steps",
        "xpbd with as many substeps as xpbd has iterations, of one iteration each (Macklin 2019): equal cost",
        read_small_steps);
    kind.keys.clear();  // those of xpbd
    return kind;
}

DeformerKind pbs_author_kind()
{
    using Options = pbs::AuthorOptions;
    DeformerKind kind = kind_of<PbsAuthorDeformer>(
        "pbs_author",
        "PBS as in the code that the paper's first author published in 2018, which departs from the paper",
        OptionFields<Options>("pbs_author")
            .add("iterations", &Options::iterations, {.range = {0, 1e6}, .meaning = "iterations per frame"})
            .add("time_step_s", &Options::time_step_s,
                 {.unit = "s",
                  .range = {above_zero},
                  .meaning = "h, whatever the time between two frames is; without gravity it cancels"})
            .add("gravity_m_s2", &Options::gravity_m_s2,
                 {.unit = "m/s^2",
                  .meaning =
                      "acceleration of every particle; the published code has (0, -9.81, 0) in its own unit of length"})
            .add("length_unit_m", &Options::length_unit_m,
                 {.unit = "m",
                  .range = {1e-6, 1e6},
                  .meaning = "unit of length of the threshold 1e-6, below which the sum of a tet's squared volume "
                             "gradients leaves it out"})
            .add("k_compression", &Options::k_compression,
                 {.range = {0, 1}, .meaning = "stiffness of edges and binds that are shorter than at rest"})
            .add("k_stretch", &Options::k_stretch,
                 {.range = {0, 1}, .meaning = "stiffness of all other edges and binds"})
            .add("k_volume_inverted", &Options::k_volume_inverted,
                 {.range = {0, 6}, .meaning = "stiffness of tets with negative volume; as k_volume"})
            .add("k_volume", &Options::k_volume,
                 {.range = {0, 6},
                  .meaning = "stiffness of all other tets; a projection removes k_volume / 6 of the error, since the "
                             "gradients lack 1/6"})
            .complete());
    kind.traits = [](const DeformerSpec& spec) {
        return DeformerTraits{.order = "first_fit", .iterations = options_of<Options>(spec).iterations};
    };
    return kind;
}

}  // namespace experiments
