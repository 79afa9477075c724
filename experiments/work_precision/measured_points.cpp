#include "experiments/work_precision/measured_points.hpp"

#include "analysis/frame_metrics.hpp"
#include "experiments/cases/motion_case.hpp"
#include "experiments/deformers/option_names.hpp"
#include "experiments/frame_measurement.hpp"
#include "experiments/interruption.hpp"
#include "experiments/work_precision/posed_deformer.hpp"
#include "experiments/work_precision/reached_reference.hpp"
#include "pbs/geometry/meshing.hpp"
#include "pbs/geometry/topology.hpp"

#include <fmt/format.h>

#include <deque>
#include <map>

namespace experiments {
namespace {

using Cell = analysis::CsvTable::Cell;

const std::vector<std::string> columns = {"body",
                                          "pose",
                                          "deformer",
                                          "setting",
                                          "iterations",
                                          "k_stretch",
                                          "order",
                                          "precision",
                                          "substeps",
                                          "element_order",
                                          "vertices",
                                          "tets",
                                          "outcome",
                                          "reach_ms",
                                          "rounds",
                                          "ms_median",
                                          "ms_q1",
                                          "ms_q3",
                                          "error_joint_pct",
                                          "error_l2_pct",
                                          "error_linf_m",
                                          "volume_change_pct",
                                          "volume_abs_change_pct",
                                          "inverted",
                                          "reference",
                                          "reference_error_joint_pct",
                                          "reference_error_l2_pct",
                                          "below_reference_error",
                                          "reference_self_intersects",
                                          "solver_pct",
                                          "model_pct",
                                          "discretisation_pct",
                                          "not_converged_pct"};

// The two poses a frame goes between, on the case's skeleton.
PosePair poses_of(const WorkPrecisionCase& of, const pbs::Skeleton& skeleton)
{
    const pbs::Motion motion = make_motion(of.scene.motion, skeleton, of.scene.file);
    const auto pose = [&](int frame) { return motion.steps.at(static_cast<std::size_t>(frame) * motion.steps_per_frame); };
    return {pose(of.frame), pose(of.frame > 0 ? of.frame - 1 : of.frame + 1), motion.time_step_s};
}

std::vector<Cell> cells_of(const PointSetting& setting)
{
    const DeformerSpec& spec = setting.spec;
    std::vector<Cell> cells(6, std::nullopt);  // iterations, k_stretch, order, precision, substeps, element_order
    if (spec.kind == "delta_mush") cells[0] = spec.delta_mush.iterations;
    if (spec.kind == "xpbd") cells[0] = spec.xpbd.iterations, cells[4] = spec.xpbd.substeps;
    if (spec.kind == "fem") cells[5] = spec.fem.element_order;
    if (spec.kind == "pbs")
        cells = {spec.pbs.iterations,         spec.pbs.k_stretch, name_of(spec.pbs.order),
                 name_of(spec.pbs.precision), setting.substeps,   std::nullopt};
    return cells;
}

class CaseMeasuring {
public:
    explicit CaseMeasuring(const WorkPrecisionCase& of)
        : of_(of),
          base_(std::make_shared<pbs::Character>(pbs::make_character(of.scene.character))),
          poses_(poses_of(of, base_->skeleton)),
          ruler_(error_domain(*base_, {})),
          settings_(point_settings(of.scene, of.range)),
          measured_{analysis::CsvTable(columns), ""}
    {
        meshes_.emplace(0, BodyMesh(base_));
        for (const int vertices : of.range.other_vertices) meshes_.emplace(vertices, BodyMesh(of.scene.character, vertices, *base_));
    }

    MeasuredPoints measure()
    {
        for (const PointSetting& setting : settings_) reach(setting);
        reference_ = choose_reference(points_, ruler_);
        reference_self_intersects_ =
            reference_.point && pbs::self_intersects(reference_.point->on_base, pbs::boundary_of(base_->mesh.tets));
        const std::vector<std::optional<Spread>> times = time_all();
        for (std::size_t i = 0; i < points_.size(); ++i) add_row(points_[i], times[i]);
        return measured_;
    }

private:
    void reach(const PointSetting& setting)
    {
        stop_if_interrupted();
        const BodyMesh& mesh = meshes_.at(setting.vertices);
        PosedDeformer& deformer = deformers_.emplace_back(setting, mesh.character(), poses_);
        ReachedPoint point{&setting, &mesh, deformer.reach(), {}};
        point.on_base = mesh.on_base(point.shape.positions);
        if (!point.shape.finished && setting.spec.kind != "fem") measured_.breakdown += setting.deformer + " is not finite. ";
        points_.push_back(std::move(point));
    }

    // Of those that reached the pose; the nonlinear laws by turns among themselves, the others among themselves.
    std::vector<std::optional<Spread>> time_all()
    {
        std::vector<std::optional<Spread>> times(points_.size());
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
            for (std::size_t k = 0; k < which.size(); ++k) times[which[k]] = spread_of(samples[k][0]);
        }
        return times;
    }

    std::optional<analysis::ErrorNorms> error_of(const ReachedPoint& point) const
    {
        if (!reference_.point || &point == reference_.point || !point.shape.finished) return std::nullopt;
        return ruler_.measure(point.on_base, reference_.point->on_base);
    }

    std::string outcome_of(const ReachedPoint& point) const
    {
        if (&point == reference_.point) return "reference";
        if (point.shape.finished) return "finished";
        return point.shape.positions.allFinite() ? "not_converged" : "not_finite";
    }

    void add_row(const ReachedPoint& point, const std::optional<Spread>& time)
    {
        const pbs::Character& character = point.mesh->character();
        const analysis::FrameMetrics metrics = analysis::Ruler(character.mesh.rest, character.mesh.tets).measure(point.shape.positions);
        const auto error = error_of(point);
        std::vector<Cell> row = {of_.body, of_.pose, point.setting->deformer, point.setting->words};
        const auto add = [&](const std::vector<Cell>& cells) { row.insert(row.end(), cells.begin(), cells.end()); };
        add(cells_of(*point.setting));
        add({static_cast<int>(character.mesh.rest.rows()), static_cast<int>(character.mesh.tets.rows()), outcome_of(point),
             1e3 * point.shape.seconds});
        if (time)
            add({time->rounds, time->median, time->lower, time->upper});
        else
            add(std::vector<Cell>(4, std::nullopt));
        if (error)
            add({error->joint_pct, error->l2_pct, error->linf_m});
        else
            add(std::vector<Cell>(3, std::nullopt));
        add({metrics.volume_change_pct, metrics.volume_abs_change_pct, metrics.inverted_tets});
        add(reference_cells(error));
        add(part_cells(point));
        measured_.table.add_row(row);
    }

    std::vector<Cell> reference_cells(const std::optional<analysis::ErrorNorms>& error) const
    {
        if (!reference_.point) return std::vector<Cell>(5, std::nullopt);
        const std::string name = reference_.point->setting->spec.fem.name;
        if (!reference_.bar) return {name, std::nullopt, std::nullopt, std::nullopt, int(reference_self_intersects_)};
        const Cell below = error ? Cell(int(error->joint_pct <= reference_.bar->joint_pct)) : Cell(std::nullopt);
        return {name, reference_.bar->joint_pct, reference_.bar->l2_pct, below, int(reference_self_intersects_)};
    }

    // PBS on the case's own mesh: solver, model, discretisation, and how far the converged shape is from converged.
    std::vector<Cell> part_cells(const ReachedPoint& point)
    {
        const bool has_parts = point.setting->deformer == "pbs" && point.setting->vertices == 0 && reference_.point && point.shape.finished;
        if (!has_parts) return std::vector<Cell>(4, std::nullopt);
        const auto& [whole, half] = converged(*point.setting);
        const auto joint_pct = [&](const pbs::Positions& a, const pbs::Positions& b) { return ruler_.measure(a, b).joint_pct; };
        return {joint_pct(point.on_base, whole), joint_pct(whole, reference_.point->on_base),
                reference_.bar ? Cell(reference_.bar->joint_pct) : Cell(std::nullopt), joint_pct(whole, half)};
    }

    // By all of the iterations and by half of them.
    const std::pair<pbs::Positions, pbs::Positions>& converged(PointSetting setting)
    {
        const double k_stretch = setting.spec.pbs.k_stretch;
        const auto found = converged_.find(k_stretch);
        if (found != converged_.end()) return found->second;
        setting.spec.pbs.precision = pbs::Precision::f64;
        setting.spec.pbs.order = pbs::Order::ordered;
        setting.substeps = 1;
        const auto after = [&](int iterations) {
            setting.spec.pbs.iterations = iterations;
            return PosedDeformer(setting, *base_, poses_).reach().positions;
        };
        return converged_.emplace(k_stretch, std::make_pair(after(of_.converged_iterations), after(of_.converged_iterations / 2)))
            .first->second;
    }

    const WorkPrecisionCase& of_;
    std::shared_ptr<const pbs::Character> base_;
    PosePair poses_;
    analysis::ErrorRuler ruler_;
    std::vector<PointSetting> settings_;
    std::map<int, BodyMesh> meshes_;  // by wanted size
    std::deque<PosedDeformer> deformers_;
    std::vector<ReachedPoint> points_;
    ReachedReference reference_;
    bool reference_self_intersects_ = false;
    std::map<double, std::pair<pbs::Positions, pbs::Positions>> converged_;  // by k_stretch
    MeasuredPoints measured_;
};

}  // namespace

MeasuredPoints measure_points(const WorkPrecisionCase& of)
{
    return CaseMeasuring(of).measure();
}

}  // namespace experiments
