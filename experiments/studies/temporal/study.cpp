// README.md describes the clips and records.
//   pbskin reproduce temporal            half a minute
//   pbskin reproduce temporal --full     both clips
#include "analysis/metrics/error_norms.hpp"
#include "analysis/metrics/skin_error.hpp"
#include "analysis/records/record_files.hpp"
#include "analysis/statistics/statistics.hpp"
#include "experiments/deformers/correctives.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/studies/temporal/temporal.hpp"
#include "pbs/skinning/blend.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

namespace experiments {

const analysis::Columns<TemporalFrame> temporal_frame_columns =
    MEMBER_COLUMNS(TemporalFrame, deformer, start, frame, ms, jitter_mm, largest_jitter_mm, error_joint_pct);
const analysis::Columns<TemporalRow> temporal_columns =
    analysis::within(&TemporalRow::of, pose_columns()) +
    MEMBER_COLUMNS(TemporalRow, deformer, start, frames, ms_median, ms_p95, jitter_mm, jitter_p95_mm, largest_jitter_mm,
                   largest_in_frame, pose_mm, compared, error_joint_pct, worse_than_cold_frames);

RECORD_SETTINGS(TemporalCase, of, scene, cold, warm, flesh, compared_every)

namespace {

constexpr int settling_frames = 24;  // in which a deformer with memory leaves the rest pose: they have no jitter

double root_mean_square(const std::vector<double>& values)
{
    return Eigen::VectorXd::Map(values.data(), static_cast<Eigen::Index>(values.size())).norm() /
           std::sqrt(double(values.size()));
}

// x_{t+1} - 2 x_t + x_{t-1} [m], #V x 3.
pbs::Positions second_difference(const std::vector<pbs::Positions>& x, int t)
{
    return x[t + 1] - 2.0 * x[t] + x[t - 1];
}

class ClipMeasuring {
public:
    explicit ClipMeasuring(const TemporalCase& temporal_case)
        : of_(temporal_case),
          character_(pbs::make_character(temporal_case.scene.character)),
          motion_(make_motion(temporal_case.scene.motion, character_.skeleton, temporal_case.scene.file)),
          skin_(character_.mesh.rest, character_.mesh.tets),
          errors_(error_domain(character_, {})),
          nothing_(character_.mesh.rest.rows(), false)
    {
        for (int frame = 0; frame < motion_.frames(); ++frame) lbs_.push_back(blended(character_, pose(frame)));
    }

    TemporalRecords measure()
    {
        solve_flesh();
        for (const DeformerSpec& spec : of_.cold) add(spec, FrameStart::own);
        for (const DeformerSpec& spec : of_.warm)
            for (const FrameStart start : {FrameStart::own, FrameStart::frame_before}) add(spec, start);
        return records_;
    }

private:
    const pbs::Pose& pose(int frame) const
    {
        return motion_.steps[static_cast<std::size_t>(frame) * motion_.steps_per_frame];
    }

    void solve_flesh()
    {
        const auto deformer = make_deformer(of_.flesh);
        deformer->reset(character_);
        for (int frame = 0; frame < motion_.frames(); frame += of_.compared_every) {
            if (deformer->advance(pose(frame), motion_.time_step_s).outcome == pbs::Outcome::finished)
                flesh_.emplace(frame, deformer->positions().topRows(character_.mesh.rest.rows()));
        }
    }

    void add(const DeformerSpec& spec, FrameStart start)
    {
        const auto deformer = make_deformer(spec);
        deformer->reset(character_);
        std::vector<pbs::Positions> shapes;
        const std::size_t first = records_.frames.size();
        for (int frame = 0; frame < motion_.frames(); ++frame) {
            const double start_s = process_cpu_s();
            if (start == FrameStart::frame_before && frame > 0)
                deformer->start_from(carried_by_lbs(shapes.back(), character_, pose(frame - 1), pose(frame)));
            deformer->advance(pose(frame), motion_.time_step_s);
            TemporalFrame& row = records_.frames.emplace_back(
                TemporalFrame{spec.label, start, frame, 1e3 * (process_cpu_s() - start_s)});
            shapes.push_back(deformer->positions());
            if (const auto flesh = flesh_.find(frame); flesh != flesh_.end())
                row.error_joint_pct = errors_.measure(shapes.back(), flesh->second).joint_pct;
        }
        if (!std::ranges::all_of(shapes, [](const pbs::Positions& shape) { return shape.allFinite(); }))
            records_.breakdown += spec.label + " is not finite. ";
        for (int frame = settling_frames; frame + 1 < motion_.frames(); ++frame) {
            const analysis::SkinError apart =
                skin_.measure(second_difference(shapes, frame), second_difference(lbs_, frame), nothing_);
            TemporalFrame& row = records_.frames[first + frame];
            row.jitter_mm = apart.rms_mm;
            row.largest_jitter_mm = apart.largest_mm;
        }
        records_.summary.push_back(summed_up(first));
    }

    // The frames from the first one on. Where they start at the frame before, the same frames with the own start
    // precede them.
    TemporalRow summed_up(std::size_t first) const
    {
        const TemporalFrame& head = records_.frames[first];
        TemporalRow row{of_.of, head.deformer, head.start, motion_.frames()};
        std::vector<double> ms, jitter_mm, pose_mm, errors_pct;
        if (head.start == FrameStart::frame_before) row.worse_than_cold_frames = 0;
        for (std::size_t i = first; i < records_.frames.size(); ++i) {
            const TemporalFrame& frame = records_.frames[i];
            ms.push_back(frame.ms);
            if (frame.jitter_mm) jitter_mm.push_back(*frame.jitter_mm);
            if (frame.largest_jitter_mm > row.largest_jitter_mm) {
                row.largest_jitter_mm = *frame.largest_jitter_mm;
                row.largest_in_frame = frame.frame;
            }
            if (!frame.error_joint_pct) continue;
            errors_pct.push_back(*frame.error_joint_pct);
            if (row.worse_than_cold_frames)
                *row.worse_than_cold_frames +=
                    *frame.error_joint_pct > *records_.frames[i - motion_.frames()].error_joint_pct;
        }
        const pbs::Positions still = pbs::Positions::Zero(character_.mesh.rest.rows(), 3);
        for (int frame = settling_frames; frame + 1 < motion_.frames(); ++frame)
            pose_mm.push_back(skin_.measure(second_difference(lbs_, frame), still, nothing_).rms_mm);
        row.ms_median = analysis::median(ms);
        row.ms_p95 = analysis::quantile(ms, 0.95);
        row.jitter_mm = root_mean_square(jitter_mm);
        row.jitter_p95_mm = analysis::quantile(jitter_mm, 0.95);
        row.pose_mm = root_mean_square(pose_mm);
        row.compared = static_cast<int>(errors_pct.size());
        row.error_joint_pct = analysis::mean(errors_pct);
        return row;
    }

    const TemporalCase& of_;
    pbs::Character character_;
    pbs::Motion motion_;
    analysis::SkinErrorMetrics skin_;
    analysis::ErrorMetrics errors_;
    std::vector<bool> nothing_;                 // no vertex is left out
    std::vector<pbs::Positions> lbs_;           // of each frame
    std::map<int, pbs::Positions> flesh_ = {};  // of the compared frames that were reached
    TemporalRecords records_ = {};
};

std::string measure_and_record(const TemporalCase& temporal_case, const std::string& folder)
{
    const TemporalRecords records = measure_temporal(temporal_case);
    table_of(temporal_frame_columns, records.frames).write(analysis::path_in(folder, "frames.csv"));
    table_of(temporal_columns, records.summary).write(analysis::path_in(folder, "summary.csv"));
    return records.breakdown;
}

StudyPlan plan(bool full)
{
    return plan_of_cases("temporal", full, [](const StudyCase& in_file, StudyPlan& plan) {
        TemporalCase temporal_case{
            .of = in_file.key(), .scene = in_file.scene(), .compared_every = in_file.value<int>("compared_every")};
        const auto warm = in_file.value<std::vector<std::string>>("warm");
        for (const DeformerSpec& spec : temporal_case.scene.deformers)
            if (!options_if<FemOptions>(spec))
                (std::ranges::count(warm, spec.name) ? temporal_case.warm : temporal_case.cold).push_back(spec);
        // not where the references are made anew
        if (std::filesystem::exists(file_of_correctives(temporal_case.of.body)))
            temporal_case.cold.push_back(kept_correctives(temporal_case.of.body));
        temporal_case.flesh = reference_flesh(temporal_case.scene);
        options_of<FemOptions>(temporal_case.flesh).element_order = 1;
        plan.runs.push_back(work_run(in_file.name, temporal_case, in_file.cost_s, measure_and_record));
    });
}

bool conclude(const FinishedRuns& finished)
{
    finished.write("summary.csv", temporal_columns, finished.rows(temporal_columns, "summary.csv"));
    return true;
}

}  // namespace

TemporalRecords measure_temporal(const TemporalCase& temporal_case)
{
    return ClipMeasuring(temporal_case).measure();
}

Study temporal_study()
{
    return {"temporal", plan, full_in_short, conclude, true};
}

}  // namespace experiments
