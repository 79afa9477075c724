#include "experiments/studies/ambiguity/reading.hpp"

#include "experiments/deformers/deformer_spec.hpp"
#include "experiments/deformers/pbs/pbs_option_names.hpp"
#include "experiments/deformers/registry.hpp"

#include <fmt/format.h>

#include <functional>

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
            add(place, fmt::format("{} {:g}", key, other), [&](Reading& reading) { reading.options.*value = other; });
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
            readings.add("Algorithm 1, lines 11-13: order of the classes", name, [&](Reading& r) { r.options.class_order = order; });
}

}  // namespace

nlohmann::json to_json(const Reading& reading)
{
    const DeformerSpec spec{.name = "", .kind = "pbs", .label = "", .options = reading.options};
    return {{"place", reading.place},
            {"name", reading.name},
            {"baseline", reading.baseline},
            {"pbs", to_json(spec)},
            {"bind_point", reading.bind_point == BindPoint::carried ? "carried" : "reprojected"},
            {"blended_bones", reading.blended_bones == BlendedBones::nearest_end ? "nearest_end" : "either_end"},
            {"zone_mean", reading.zone_mean == ZoneMean::of_all ? "of_all" : "of_bone"},
            {"substeps", reading.substeps}};
}

std::vector<Reading> readings_of_a_step(const pbs::PbsOptions& own)
{
    Readings readings(own_reading, not_jiggling(own));
    readings.add("Sec. 3.6: projection on the nearest bone", "projected anew on the posed bone",
                 [](Reading& r) { r.bind_point = BindPoint::reprojected; });
    readings.add("Sec. 3.6: a vertex on the bone", "without a bind constraint",
                 [](Reading& r) { r.options.bind_on_bone = pbs::BindOnBone::unbound; });
    readings.add("Eq. 2: n_joints", "all bones touching either end", [](Reading& r) { r.blended_bones = BlendedBones::either_end; });
    readings.add("Eq. 8-9: stiffness in each iteration", "exponent 1 / iterations",
                 [](Reading& r) { r.options.stiffness_form = pbs::StiffnessForm::exponent; });
    readings.add("Eq. 5: masses", "lumped", [](Reading& r) { r.options.masses = pbs::Masses::lumped; });
    add_class_orders(readings);
    readings.add_values("unstated: k_stretch outside the zone", "k_stretch", &pbs::PbsOptions::k_stretch, {0.05, 0.5, 0.9, 1.0});
    readings.add_values("unstated: k_volume", "k_volume", &pbs::PbsOptions::k_volume, {0.5, 0.9});
    readings.add_values("unstated: k_bind", "k_bind", &pbs::PbsOptions::k_bind, {0.1, 0.5});
    return readings.all;
}

std::vector<Reading> readings_of_motion(const pbs::PbsOptions& own)
{
    const auto integrate_all = [](Reading& r) { r.options.lbs_entry = pbs::LbsEntry::increment; };
    Readings readings(own_reading, not_jiggling(own));
    readings.add("where LBS enters Algorithm 1", "all integrated, moved by the LBS increment", integrate_all);
    readings.add("where LBS enters Algorithm 1", "the same without gravity", [&](Reading& r) {
        integrate_all(r);
        r.options.gravity_m_s2.setZero();
    });
    readings.add_baseline(jiggling_reading, jiggling(own));
    readings.add("Sec. 4: jiggling zone", "by bone", [](Reading& r) { r.zone_mean = ZoneMean::of_bone; });
    for (const double k_bind : {0.0, 0.1, 0.5})
        readings.add("Table 1: bind in the zone", fmt::format("k_bind {:g} there", k_bind),
                     [&](Reading& r) { r.options.jiggle->k_bind = k_bind; });
    readings.add("Table 1: jiggling", "k_stretch 0.9 everywhere", [](Reading& r) { r.options.k_stretch = r.options.jiggle->k_stretch; });
    for (const double k_stretch : {0.6, 0.7})
        readings.add("Table 1: jiggling", fmt::format("k_stretch {:g} in the zone", k_stretch),
                     [&](Reading& r) { r.options.jiggle->k_stretch = k_stretch; });
    for (const int substeps : {2, 4})
        readings.add("Sec. 4: step and frame", fmt::format("{} substeps", substeps), [&](Reading& r) { r.substeps = substeps; });
    readings.add("unstated: gravity", "none", [](Reading& r) { r.options.gravity_m_s2.setZero(); });
    return readings.all;
}

}  // namespace experiments
