#include "experiments/studies/work_precision/measured_points.hpp"

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/process/interruption.hpp"
#include "experiments/scene/motion_case.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/work_precision/posed_deformer.hpp"
#include "pbs/solver/options.hpp"

#include <deque>
#include <map>

namespace experiments {
namespace {

// The two poses of a timed frame, on the case's skeleton.
PosePair poses_of(const WorkPrecisionCase& of, const pbs::Skeleton& skeleton)
{
    const pbs::Motion motion = make_motion(of.scene.motion, skeleton, of.scene.file);
    const auto pose = [&](int frame) { return motion.steps.at(static_cast<std::size_t>(frame) * motion.steps_per_frame); };
    return {pose(of.frame), pose(of.frame > 0 ? of.frame - 1 : of.frame + 1), motion.time_step_s};
}

class CaseMeasuring {
public:
    explicit CaseMeasuring(const WorkPrecisionCase& of)
        : of_(of),
          base_(std::make_shared<pbs::Character>(pbs::make_character(of.scene.character))),
          poses_(poses_of(of, base_->skeleton)),
          settings_(point_settings(of.scene, of.range)),
          reference_(*base_, reference_flesh(of.scene), poses_.pose, poses_.time_step_s)
    {
        meshes_.emplace(0, BodyMesh(base_));
        if (of.range.refined) meshes_.emplace(refined, BodyMesh::refined(*base_));
        for (const auto* sizes : {&of.range.coarser_vertices, &of.range.finer_vertices})
            for (const int vertices : *sizes) meshes_.emplace(vertices, BodyMesh(of.scene.character, vertices, *base_));
    }

    MeasuredPoints measure()
    {
        for (const PointSetting& setting : settings_) reach(setting);
        const std::vector<FrameTime> times = time_all();
        for (std::size_t i = 0; i < points_.size(); ++i) measured_.rows.push_back(row_of(points_[i], times[i]));
        measured_.rows.push_back(reference_row(of_.of, base_->mesh, reference_));
        return measured_;
    }

private:
    void reach(const PointSetting& setting)
    {
        stop_if_interrupted();
        const BodyMesh& mesh = meshes_.at(setting.refined ? refined : setting.vertices);
        PosedDeformer& deformer = deformers_.emplace_back(setting, mesh.character(), poses_);
        ReachedPoint point{&setting, &mesh, deformer.reach(), {}};
        point.on_base = mesh.on_base(point.shape.positions);
        if (!point.shape.finished && !options_if<FemOptions>(setting.spec)) measured_.breakdown += setting.deformer + " is not finite. ";
        points_.push_back(std::move(point));
    }

    // The times of those that reached the pose. The nonlinear laws take turns among themselves, and so do the others.
    std::vector<FrameTime> time_all()
    {
        std::vector<FrameTime> times(points_.size());
        for (const bool newton : {false, true}) {
            std::vector<std::size_t> which;
            std::vector<TimedVariant> turns;
            for (std::size_t i = 0; i < points_.size(); ++i) {
                if (!points_[i].shape.finished || points_[i].setting->is_newton() != newton) continue;
                which.push_back(i);
                turns.push_back([this, i] {
                    stop_if_interrupted();
                    return deformers_[i].turn();
                });
            }
            const auto samples = take_turns(turns, newton ? of_.newton_rounds : of_.rounds);
            for (std::size_t k = 0; k < which.size(); ++k) times[which[k]] = frame_time(samples[k][0]);
        }
        return times;
    }

    PointRow row_of(const ReachedPoint& point, const FrameTime& time)
    {
        PointValues values{.of = of_.of, .time = time};
        if (point.shape.finished && reference_.is_reached()) {
            values.error = reference_.error_of(point.on_base);
            values.whole_joint_pct = reference_.error_on_whole_body(point.on_base).joint_pct;
            if (point.setting->deformer == "pbs" && point.setting->on_own_mesh()) values.parts = parts_of(point);
        }
        return point_row(point, &reference_, values);
    }

    PbsParts parts_of(const ReachedPoint& point)
    {
        const auto& [whole, half] = converged(*point.setting);
        return {reference_.distance(point.on_base, whole).joint_pct, reference_.error_of(whole).joint_pct,
                reference_.distance(whole, half).joint_pct};
    }

    // After all of the iterations and after half of them.
    const std::pair<pbs::Positions, pbs::Positions>& converged(PointSetting setting)
    {
        auto& options = options_of<pbs::PbsOptions>(setting.spec);
        const double k_stretch = options.k_stretch;
        const auto found = converged_.find(k_stretch);
        if (found != converged_.end()) return found->second;
        options.precision = pbs::Precision::f64;
        options.order = pbs::Order::ordered;
        setting.substeps = 1;
        const auto after = [&](int iterations) {
            options.iterations = iterations;
            return PosedDeformer(setting, *base_, poses_).reach().positions;
        };
        return converged_.emplace(k_stretch, std::make_pair(after(of_.converged_iterations), after(of_.converged_iterations / 2)))
            .first->second;
    }

    const WorkPrecisionCase& of_;
    std::shared_ptr<const pbs::Character> base_;
    PosePair poses_;
    std::vector<PointSetting> settings_;
    PosedReference reference_;
    static constexpr int refined = -1;
    std::map<int, BodyMesh> meshes_;  // by wanted size; 0: the case's own
    std::deque<PosedDeformer> deformers_;
    std::vector<ReachedPoint> points_;
    std::map<double, std::pair<pbs::Positions, pbs::Positions>> converged_;  // by k_stretch
    MeasuredPoints measured_;
};

}  // namespace

nlohmann::json to_json(const WorkPrecisionCase& of)
{
    static const auto fields =
        OptionFields<WorkPrecisionCase>("work_precision")
            .record("of", &WorkPrecisionCase::of)
            .record("scene", &WorkPrecisionCase::scene)
            .record("frame", &WorkPrecisionCase::frame)
            .record("range", &WorkPrecisionCase::range)
            .record("rounds", &WorkPrecisionCase::rounds)
            .record("newton_rounds", &WorkPrecisionCase::newton_rounds)
            .record("converged_iterations", &WorkPrecisionCase::converged_iterations)
            .derived("points",
                     [](const WorkPrecisionCase& one) -> nlohmann::json { return digest_of(point_settings(one.scene, one.range)); })
            .derived("reference", [](const WorkPrecisionCase& one) { return to_json(reference_flesh(one.scene)); })
            .complete();
    return fields.json(of);
}

MeasuredPoints measure_points(const WorkPrecisionCase& of)
{
    return CaseMeasuring(of).measure();
}

}  // namespace experiments
