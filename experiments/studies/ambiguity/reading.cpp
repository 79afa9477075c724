#include "experiments/studies/ambiguity/reading.hpp"

#include "experiments/deformers/deformer.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/settings/option_fields.hpp"

#include <fmt/format.h>

#include <functional>
#include <map>

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

// Apart from what `take_over` takes from the baseline.
template <typename TakeOver>
bool same_apart_from(Reading reading, const Reading& baseline, const TakeOver& take_over)
{
    take_over(reading);
    reading.place = baseline.place;
    reading.name = baseline.name;
    reading.baseline = baseline.baseline;
    return to_json(reading) == to_json(baseline);
}

std::string of_projections(const Reading& reading, const Reading& baseline)
{
    if (has_memory(reading)) return "each projection is taken by itself, from the LBS shape";
    const bool of_bones = same_apart_from(reading, baseline, [&](Reading& r) {
        r.bind_point = baseline.bind_point;
        r.options.bind_on_bone = baseline.options.bind_on_bone;
        r.options.k_bind = baseline.options.k_bind;
    });
    if (of_bones) return "bind is to a bone, which takes momentum and is no part of the value";
    const bool of_order = same_apart_from(reading, baseline, [&](Reading& r) { r.options.class_order = baseline.options.class_order; });
    return of_order ? "each class is taken by itself" : "";
}

std::string of_jolts(const Reading& reading, const Reading& baseline)
{
    if (same_apart_from(reading, baseline, [&](Reading& r) { r.options.gravity_m_s2 = baseline.options.gravity_m_s2; }))
        return "jolted flesh has no weight";
    const bool of_bones = same_apart_from(reading, baseline, [&](Reading& r) {
        r.bind_point = baseline.bind_point;
        r.blended_bones = baseline.blended_bones;
    });
    return of_bones ? "a jolt moves all bones alike" : "";
}

std::string of_frames(const Reading& reading, const Reading& baseline)
{
    const bool of_factors = same_apart_from(reading, baseline, [&](Reading& r) {
        r.options.k_stretch = baseline.options.k_stretch;
        r.options.k_volume = baseline.options.k_volume;
        r.options.k_bind = baseline.options.k_bind;
        r.options.stiffness_form = baseline.options.stiffness_form;
        r.options.gravity_m_s2 = baseline.options.gravity_m_s2;
        if (r.options.jiggle && r.options.jiggle->k_bind.value_or(1.0) > 0.0) r.options.jiggle = baseline.options.jiggle;
    });
    return of_factors ? "another factor is no more work" : "";
}

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
    if (same_apart_from(reading, baseline, [](Reading&) {})) return "the scene is so by itself";
    const bool is_posed = claim == "C03" || claim == "C12" || claim == "C04" || claim == "C05";
    if (is_posed && reading.options.jiggle) return "measured where nothing jiggles";
    if (is_posed && reading.substeps > 1) return "nothing remembers the last step";
    if ((claim == "C03" || claim == "C12") && has_memory(reading)) return "the start is what is compared";
    if (claim == "C01" && reading.blended_bones == baseline.blended_bones) return "LBS alone is measured";
    if (claim == "C07") return of_projections(reading, baseline);
    if (claim == "C09") return of_jolts(reading, baseline);
    if (claim == "C10") return of_frames(reading, baseline);
    return "";
}

}  // namespace experiments
