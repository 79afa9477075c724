#include "experiments/studies/ambiguity/reading.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "experiments/deformers/deformer.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/option_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

namespace experiments {
namespace {

using Change = std::function<void(Reading&)>;

class Readings {
public:
    Readings(const std::string& baseline, const pbs::PbsOptions& options) { add_baseline(baseline, options); }

    void add_baseline(const std::string& baseline, const pbs::PbsOptions& options)
    {
        baseline_ = {.place = "", .name = baseline, .baseline = baseline, .options = options};
        all.push_back(baseline_);
    }

    void add(const std::string& place, const std::string& name, const Change& change)
    {
        Reading reading = baseline_;
        reading.place = place;
        reading.name = name;
        change(reading);
        all.push_back(reading);
    }

    void add_values(const std::string& place, const std::string& key, double pbs::PbsOptions::*value, const std::vector<double>& values)
    {
        for (const double other : values)
            add(place, fmt::format("{}_{:g}", key, other), [&](Reading& reading) { reading.options.*value = other; });
    }

    std::vector<Reading> all;

private:
    Reading baseline_;
};

pbs::PbsOptions not_jiggling(pbs::PbsOptions options)
{
    options.jiggle.reset();
    return options;
}

// Table 1, Man: k_stretch 0.9 in the zone, 1 elsewhere.
pbs::PbsOptions jiggling(pbs::PbsOptions options)
{
    options.k_stretch = 1.0;
    options.jiggle = pbs::Jiggle{.k_stretch = 0.9};
    return options;
}

void add_class_orders(Readings& readings)
{
    for (const auto& [order, name] : OptionNames<pbs::ClassOrder>::table)
        if (order != pbs::ClassOrder::bind_stretch_volume)
            readings.add("class_order", name, [&](Reading& r) { r.options.class_order = order; });
}

// The settings in which two readings differ, by their names in the record, without the name of the reading.
std::set<std::string> differences(const Reading& one, const Reading& other)
{
    const nlohmann::json a = to_json(one).flatten(), b = to_json(other).flatten();
    std::set<std::string> names;
    const auto compare = [&](const nlohmann::json& from, const nlohmann::json& to) {
        for (const auto& [path, value] : from.items()) {
            const bool is_option = path.starts_with("/pbs/options/");
            const std::string name = path.substr(is_option ? 13 : 1), setting = name.substr(0, name.find('/'));
            if (setting != "place" && setting != "name" && setting != "baseline" && setting != "pbs" &&
                to.value(path, nlohmann::json()) != value)
                names.insert(setting);
        }
    };
    compare(a, b);
    compare(b, a);
    return names;
}

// The settings that do not matter to the values of a claim, each set for a reason of its own.
struct WithoutEffect {
    std::string claim;
    std::set<std::string> settings;
    std::string reason;
};
const std::vector<WithoutEffect> without_effect = {
    {"C07", {"bind_point", "bind_on_bone", "k_bind"}, "bind is to a bone, which takes momentum and is no part of the value"},
    {"C07", {"class_order"}, "each class is taken by itself"},
    {"C09", {"gravity_m_s2"}, "jolted flesh has no weight"},
    {"C09", {"bind_point", "blended_bones"}, "a jolt moves all bones alike"},
    {"C10", {"k_stretch", "k_volume", "k_bind", "stiffness", "gravity_m_s2", "jiggle"}, "another factor is no more work"}};

}  // namespace

nlohmann::json to_json(const Reading& reading)
{
    static const auto fields =
        OptionFields<Reading>("reading")
            .record("place", &Reading::place)
            .record("name", &Reading::name)
            .record("baseline", &Reading::baseline)
            .derived("pbs",
                     [](const Reading& of) { return to_json(DeformerSpec{.name = "", .kind = "pbs", .label = "", .options = of.options}); })
            .record("bind_point", &Reading::bind_point)
            .record("blended_bones", &Reading::blended_bones)
            .record("zone_mean", &Reading::zone_mean)
            .record("substeps", &Reading::substeps);
    return fields.json(reading);
}

bool has_memory(const Reading& reading)
{
    return reading.options.jiggle || reading.options.lbs_entry == pbs::LbsEntry::increment;
}

std::string title_of_place(const std::string& place)
{
    static const std::map<std::string, std::string> titles = {{"nearest_bone", "Sec. 3.6: projection on the nearest bone"},
                                                              {"vertex_on_bone", "Sec. 3.6: a vertex on the bone"},
                                                              {"n_joints", "Eq. 2: n_joints"},
                                                              {"stiffness_form", "Eq. 8-9: stiffness in each iteration"},
                                                              {"masses", "Eq. 5: masses"},
                                                              {"class_order", "Algorithm 1, lines 11-13: order of the classes"},
                                                              {"k_stretch_outside_zone", "unstated: k_stretch outside the zone"},
                                                              {"k_volume", "unstated: k_volume"},
                                                              {"k_bind", "unstated: k_bind"},
                                                              {"lbs_entry", "where LBS enters Algorithm 1"},
                                                              {"jiggling_zone", "Sec. 4: jiggling zone"},
                                                              {"bind_in_zone", "Table 1: bind in the zone"},
                                                              {"jiggling", "Table 1: jiggling"},
                                                              {"step_and_frame", "Sec. 4: step and frame"},
                                                              {"gravity", "unstated: gravity"}};
    const auto title = titles.find(place);
    return title == titles.end() ? place : title->second;
}

std::vector<Reading> readings_of_a_step(const pbs::PbsOptions& own)
{
    Readings readings(own_reading, not_jiggling(own));
    readings.add("nearest_bone", "reprojected", [](Reading& r) { r.bind_point = BindPoint::reprojected; });
    readings.add("vertex_on_bone", "without_bind", [](Reading& r) { r.options.bind_on_bone = pbs::BindOnBone::unbound; });
    readings.add("n_joints", "bones_at_either_end", [](Reading& r) { r.blended_bones = BlendedBones::either_end; });
    readings.add("stiffness_form", "exponent", [](Reading& r) { r.options.stiffness_form = pbs::StiffnessForm::exponent; });
    readings.add("masses", "lumped", [](Reading& r) { r.options.masses = pbs::Masses::lumped; });
    add_class_orders(readings);
    readings.add_values("k_stretch_outside_zone", "k_stretch", &pbs::PbsOptions::k_stretch, {0.05, 0.5, 0.9, 1.0});
    readings.add_values("k_volume", "k_volume", &pbs::PbsOptions::k_volume, {0.5, 0.9});
    readings.add_values("k_bind", "k_bind", &pbs::PbsOptions::k_bind, {0.1, 0.5});
    return readings.all;
}

std::vector<Reading> readings_of_motion(const pbs::PbsOptions& own)
{
    const auto integrate_all = [](Reading& r) { r.options.lbs_entry = pbs::LbsEntry::increment; };
    Readings readings(own_reading, not_jiggling(own));
    readings.add("lbs_entry", "increment", integrate_all);
    readings.add("lbs_entry", "increment_without_gravity", [&](Reading& r) {
        integrate_all(r);
        r.options.gravity_m_s2.setZero();
    });
    readings.add_baseline(jiggling_reading, jiggling(own));
    readings.add("jiggling_zone", "by_bone", [](Reading& r) { r.zone_mean = ZoneMean::of_bone; });
    for (const double k_bind : {0.0, 0.1, 0.5})
        readings.add("bind_in_zone", fmt::format("k_bind_{:g}_in_zone", k_bind), [&](Reading& r) { r.options.jiggle->k_bind = k_bind; });
    readings.add("jiggling", "k_stretch_0.9_everywhere", [](Reading& r) { r.options.k_stretch = r.options.jiggle->k_stretch; });
    for (const double k_stretch : {0.6, 0.7})
        readings.add("jiggling", fmt::format("k_stretch_{:g}_in_zone", k_stretch),
                     [&](Reading& r) { r.options.jiggle->k_stretch = k_stretch; });
    for (const int substeps : {2, 4})
        readings.add("step_and_frame", fmt::format("substeps_{}", substeps), [&](Reading& r) { r.substeps = substeps; });
    readings.add("gravity", "without_gravity", [](Reading& r) { r.options.gravity_m_s2.setZero(); });
    return readings.all;
}

std::string untouched_because(const std::string& claim, const Reading& reading, const Reading& baseline)
{
    const std::set<std::string> differing = differences(reading, baseline);
    if (differing.empty()) return "the scene is so by itself";
    const bool is_posed = claim == "C03" || claim == "C12" || claim == "C04" || claim == "C05";
    if (is_posed && reading.options.jiggle) return "measured where nothing jiggles";
    if (is_posed && reading.substeps > 1) return "nothing remembers the last step";
    if ((claim == "C03" || claim == "C12") && has_memory(reading)) return "the start is what is compared";
    if (claim == "C01" && reading.blended_bones == baseline.blended_bones) return "LBS alone is measured";
    if (claim == "C07" && has_memory(reading)) return "each projection is taken by itself, from the LBS shape";
    const bool lacks_bind = reading.options.jiggle && reading.options.jiggle->k_bind == 0.0;
    if (claim == "C10" && lacks_bind) return "";  // a factor of zero leaves a class out, which is less work
    for (const WithoutEffect& known : without_effect)
        if (known.claim == claim && std::ranges::includes(known.settings, differing)) return known.reason;
    return "";
}

namespace {

std::vector<bool> zone_of(const pbs::Character& character, const Reading& reading)
{
    if (!reading.options.jiggle) return {};
    return reading.zone_mean == ZoneMean::of_bone ? pbs::jiggle_zone_by_bone(character.binding) : pbs::jiggle_zone(character.binding);
}

pbs::Motion motion_of(const pbs::Character& character, const Scene& scene, int substeps)
{
    MotionSpec spec = scene.motion;
    if (!spec.clip.empty()) spec.time_step_s /= substeps;
    return make_motion(spec, character.skeleton, scene.file);
}

analysis::CaseRecord record_of(const Scene& scene, const std::string& deformer)
{
    analysis::CaseRecord record;
    record.scene = scene.name;
    record.deformer = deformer;
    return record;
}

void add_frame(analysis::CaseRecord& record, int frame, double time_s, const pbs::Motion& motion, const analysis::FrameMetrics& metrics)
{
    record.frame.push_back(frame);
    record.time_s.push_back(time_s);
    if (!motion.angle_deg.empty()) record.angle_deg.push_back(motion.angle_deg[frame]);
    record.volume_change_pct.push_back(metrics.volume_change_pct);
    record.volume_abs_change_pct.push_back(metrics.volume_abs_change_pct);
    record.inverted_tets.push_back(metrics.inverted_tets);
}

}  // namespace

pbs::Weights weights_of(const pbs::Character& character, const Reading& reading)
{
    return reading.blended_bones == BlendedBones::either_end ? pbs::either_end_weights(character.binding, character.skeleton)
                                                             : character.weights;
}

pbs::Positions bind_points_of(const pbs::Character& character, const Reading& reading, const pbs::Pose& pose, const pbs::Positions& lbs)
{
    return reading.bind_point == BindPoint::reprojected ? pbs::reprojected_bind_points(character.binding, character.skeleton, pose, lbs)
                                                        : pbs::posed_bind_points(character.binding, pose);
}

void ReadDeformer::reset(const pbs::Character& character)
{
    character_ = &character;
    skinning_.emplace(character.mesh.rest, weights_of(character, reading_));
    solver_ = std::make_unique<pbs::PbsSolver>(character.mesh, character.binding.distance, zone_of(character, reading_), reading_.options);
}

pbs::StepSummary ReadDeformer::advance(const pbs::Pose& pose, double dt_s)
{
    skinning_->linear(pose, lbs_);
    return solver_->advance(lbs_, bind_points_of(*character_, reading_, pose, lbs_), dt_s);
}

ReadMotion move(const pbs::Character& character, const Scene& scene, const Reading& reading)
{
    const pbs::Motion motion = motion_of(character, scene, reading.substeps);
    const analysis::MeshMetrics mesh_metrics(character.mesh.rest, character.mesh.tets);
    ReadDeformer moving(reading);
    moving.reset(character);
    ReadMotion moved;
    moved.pbs = record_of(scene, "pbs");
    moved.pbs.iterations = reading.options.iterations;
    moved.lbs = record_of(scene, "lbs");
    for (int step = 0; step < static_cast<int>(motion.steps.size()); ++step) {
        const bool is_frame = step % motion.steps_per_frame == 0;
        if (!is_frame && !moving.has_memory()) continue;
        stop_if_interrupted();
        moving.advance(motion.steps[step], motion.time_step_s);
        if (!is_frame) continue;
        const int frame = step / motion.steps_per_frame;
        add_frame(moved.pbs, frame, step * motion.time_step_s, motion, mesh_metrics.measure(moving.positions()));
        add_frame(moved.lbs, frame, step * motion.time_step_s, motion, mesh_metrics.measure(moving.lbs()));
        moved.shapes.push_back(moving.positions());
        moved.finite = moved.finite && moving.positions().allFinite();
    }
    return moved;
}

}  // namespace experiments
