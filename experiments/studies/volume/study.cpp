// The volume study (claims C01, C02): how much volume each deformer loses, by pose, and at which bones and joints.
//
//   limb_twist   0 - 180 deg    o=======o~~~~~~~o)  the forearm turns about its own axis
//   limb_bend    0 - 150 deg    o=======o           the forearm turns about z, also with Eq. 12-20 as printed
//   BODY_CLIP                                       CMU's clips on the installed bodies
//   BODY_range_MOVEMENT                             joints through their range of motion, for the held-out cases
//
// README.md describes the runs, deformers and records. Besides the scene's own order of projection PBS has each other order and precision,
// so that the report can say whether the verdict depends on it.
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/run/region_record.hpp"
#include "experiments/scene/movements.hpp"
#include "experiments/studies/study.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

namespace experiments {
namespace {

// The change of a bone or joint of a body, from the regions.csv of a run.
struct RegionOfRun {
    std::string run;  // its name in reports
    RegionChange region;
};

void add_iterations(std::vector<DeformerSpec>& deformers, const DeformerSpec& pbs)
{
    for (const int iterations : {1, 2, 4, 8, 12, 48, 96, 192, 384}) {  // in addition to the scene's own 24
        DeformerSpec spec = pbs;
        options_of<pbs::PbsOptions>(spec).iterations = iterations;
        spec.label += "_" + std::to_string(iterations);
        deformers.push_back(spec);
    }
}

void add_order(std::vector<DeformerSpec>& deformers, DeformerSpec pbs, pbs::Order order, pbs::Precision precision)
{
    auto& options = options_of<pbs::PbsOptions>(pbs);
    if (order == options.order && precision == options.precision) return;
    pbs.name = "pbs_orders";
    pbs.label += "_" + name_of(options.order = order) + "_" + name_of(options.precision = precision);
    deformers.push_back(pbs);
}

void add_orders(std::vector<DeformerSpec>& deformers, const DeformerSpec& pbs)
{
    for (const auto order : {pbs::Order::plain, pbs::Order::ordered, pbs::Order::grouped})
        for (const auto precision : {pbs::Precision::f32, pbs::Precision::f64}) add_order(deformers, pbs, order, precision);
}

void add_papers_order(std::vector<DeformerSpec>& deformers, const DeformerSpec& pbs)
{
    add_order(deformers, pbs, pbs::Order::plain, pbs::Precision::f64);
}

// Table 1's "jiggling" is k_stretch in the zone; outside it is 1 here. in_the_papers_order: a second time, as C02b is judged.
void add_jiggle(std::vector<DeformerSpec>& deformers, DeformerSpec pbs, double k_in_zone)
{
    auto& options = options_of<pbs::PbsOptions>(pbs);
    pbs.label += "_jiggle";
    pbs.variant = "jiggle";
    options.k_stretch = 1.0;
    options.jiggle = pbs::Jiggle{k_in_zone};
    deformers.push_back(pbs);
    pbs.name = "pbs_orders";
    pbs.label += "_plain_f64";
    options.order = pbs::Order::plain;
    options.precision = pbs::Precision::f64;
    deformers.push_back(pbs);
}

void add_printed_forms(std::vector<DeformerSpec>& deformers, const DeformerSpec& pbs)
{
    for (const auto form :
         {pbs::VolumeForm::labels_relative, pbs::VolumeForm::labels_absolute, pbs::VolumeForm::sign, pbs::VolumeForm::as_printed}) {
        DeformerSpec spec = pbs;
        spec.name = "pbs_printed";
        options_of<pbs::PbsOptions>(spec).volume_form = form;
        options_of<pbs::PbsOptions>(spec).order = pbs::Order::plain;
        spec.variant = name_of(form);
        spec.label += "_" + spec.variant;
        deformers.push_back(spec);
    }
}

StudyRun run_of(const StudyCase& of, const std::string& name, const Overrides& overrides)
{
    static const std::map<std::string, std::function<void(std::vector<DeformerSpec>&, const DeformerSpec&)>> adders = {
        {"iterations", add_iterations}, {"orders", add_orders}, {"papers_order", add_papers_order}, {"printed_forms", add_printed_forms}};
    StudyRun run{.name = name, .scene = of.scene(overrides), .cost_s = of.cost_s};
    run.scene.name = name;
    run.beside = of.value("beside", false);
    run.bad_frames_are_results = of.value("goes_on", false);
    const DeformerSpec pbs = *find_deformer_with<pbs::PbsOptions>(run.scene);
    for (const auto& added : of.value<std::vector<std::string>>("add", {})) adders.at(added)(run.scene.deformers, pbs);
    if (of.has("k_in_zone")) add_jiggle(run.scene.deformers, pbs, of.value<double>("k_in_zone"));
    return run;
}

StudyPlan plan(bool full)
{
    return plan_of_cases("volume", full, [](const StudyCase& of, StudyPlan& plan) {
        if (!of.value("through_movements", false)) {
            plan.runs.push_back(run_of(of, of.name, {}));
            return;
        }
        for (const std::string& movement : movements_of(pbs::make_character(of.scene().character).skeleton))
            plan.runs.push_back(run_of(of, of.name + "_" + movement, {fmt::format("motion.movements=['{}']", movement)}));
    });
}

bool conclude(const FinishedRuns& finished)
{
    static const analysis::Columns<RegionOfRun> columns =
        analysis::Columns<RegionOfRun>{{"run", &RegionOfRun::run}} + analysis::within(&RegionOfRun::region, region_columns);
    std::vector<RegionOfRun> all;
    for (const std::string& file : finished.files("regions.csv")) {
        const std::string run = std::filesystem::path(file).parent_path().filename().string();
        for (const RegionChange& region : rows_of(region_columns, analysis::read_csv(file))) all.push_back({run, region});
    }
    finished.write("regions.csv", columns, all);
    return !finished.none();
}

}  // namespace

Study volume_study()
{
    return {"volume", plan, quick_and_full, conclude};
}

}  // namespace experiments
