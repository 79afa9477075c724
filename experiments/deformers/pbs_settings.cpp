#include "experiments/deformers/deformer_options.hpp"
#include "experiments/settings/option_fields.hpp"

namespace experiments {
namespace {

using pbs::PbsOptions;

void add_keys(OptionFields<PbsOptions>& fields)
{
    fields.add("iterations", &PbsOptions::iterations, {.range = {0, 1e6}, .meaning = "N_iterations of Algorithm 1"})
        .add(
            "k_stretch", &PbsOptions::k_stretch,
            {.range = {0, 1},
             .is_stated = true,
             .meaning =
                 "stiffness of Eq. 10; the paper leaves it unstated outside the jiggling zone; 0 leaves the class out"})
        .add("k_volume", &PbsOptions::k_volume,
             {.range = {0, 1},
              .is_stated = true,
              .meaning = "stiffness of Eq. 11; the paper leaves it unstated; 0 leaves the class out"})
        .add("k_bind", &PbsOptions::k_bind,
             {.range = {0, 1},
              .is_stated = true,
              .meaning =
                  "stiffness of the bind constraint (Sec. 3.6); the paper leaves it unstated; 0 leaves the class out"})
        .add("gravity_m_s2", &PbsOptions::gravity_m_s2,
             {.unit = "m/s^2",
              .is_stated = true,
              .meaning = "external acceleration on the integrated (jiggling) particles; the paper leaves it unstated"})
        .add("order", &PbsOptions::order,
             {.meaning = "order of projection within a class: plain is the order of the file, as in the paper; ordered "
                         "projects sixteen "
                         "constraints at once that share no vertex; spread is plain code whose constraints come from "
                         "eight distant parts of the file in "
                         "turn, which is faster "
                         "than plain; printed volume_forms need plain or spread"})
        .add("precision", &PbsOptions::precision, {.meaning = "floating point of the projections"})
        .add("masses", &PbsOptions::masses,
             {.meaning = "unit: m_i = 1 (the paper); lumped: a quarter of the rest volume of each tet at the vertex"})
        .add("stop_residual", &PbsOptions::stop_residual,
             {.range = {0}, .meaning = "the step ends when every residual is below this; 0: all iterations are done"})
        .add("sleep", &PbsOptions::sleep,
             {.meaning = "constraints that LBS satisfies, and all around them, are left out for the frame; at its end "
                         "they are checked, and "
                         "the frame is repeated with those that are not satisfied any more; only with the order "
                         "ordered"})
        .add("sleep_tolerance", &PbsOptions::sleep_tolerance,
             {.range = {0, 1},
              .meaning = "the error that a sleeping constraint may have: |l / l0 - 1|, |V / V0 - 1|, and for bind a "
                         "share of the mean edge"})
        .add("contact", &PbsOptions::contact,
             {.meaning = "skin that lies in flesh of another part of the body is pushed out of it, by a constraint "
                         "after the volume "
                         "constraints of each iteration"})
        .add("record_iterations", &PbsOptions::record_iterations,
             {.meaning = "writes iterations.csv: residuals per frame and iteration"});
}

void add_jiggle_keys(OptionFields<PbsOptions>& fields)
{
    constexpr double as_elsewhere = -1.0;
    const auto read_k_stretch = [](PbsOptions& options, const SceneValues& values, const std::string& path) {
        options.jiggle = pbs::Jiggle{values.number(path)};
    };
    const auto read_k_bind = [](PbsOptions& options, const SceneValues& values, const std::string& path) {
        if (values.number(path) != as_elsewhere) options.jiggle->k_bind = values.number(path);
    };
    const auto read_zone_mean = [](PbsOptions& options, const SceneValues& values, const std::string& path) {
        options.jiggle->zone_mean = read_option<pbs::ZoneMean>(values, path);
    };
    const auto write = [](const PbsOptions& options, nlohmann::json& record) {
        if (!options.jiggle) return;
        record["jiggle"] = {{"k_stretch", options.jiggle->k_stretch},
                            {"zone_mean", name_of(options.jiggle->zone_mean)}};
        if (options.jiggle->k_bind) record["jiggle"]["k_bind"] = *options.jiggle->k_bind;
    };
    fields.in_table("jiggle")
        .add("k_stretch", KeyType::number, pbs::Jiggle{}.k_stretch,
             {.range = {0, 1},
              .meaning = "stiffness of edges with both ends in the jiggling zone; without this table nothing jiggles"},
             read_k_stretch, write)
        .add("k_bind", KeyType::number, as_elsewhere,
             {.range = {-1, 1},
              .meaning = "stiffness of the bind constraints of the zone's vertices; -1: that of pbs.k_bind"},
             read_k_bind, nullptr)
        .add("zone_mean", KeyType::text, name_of(pbs::ZoneMean::of_all),
             {.choices = names_of_options<pbs::ZoneMean>(),
              .meaning = "the jiggling zone has the vertices that are farther from their bone than the mean: of_all: "
                         "over all vertices; "
                         "of_bone: over the vertices of the same bone"},
             read_zone_mean, nullptr);
}

void add_variant_keys(OptionFields<PbsOptions>& fields)
{
    fields.in_table("variant")
        .add("stiffness", &PbsOptions::stiffness_form,
             {.meaning = "per_iteration: the factor k in every iteration, as printed; exponent: 1 - (1 - k)^(1 / "
                         "iterations) instead (Mueller "
                         "2006), so that a lone constraint is left with 1 - k of its error whatever their number"})
        .add("class_order", &PbsOptions::class_order,
             {.meaning =
                  "the order of the classes in an iteration; bind_stretch_volume is that of Algorithm 1, lines 11-13"})
        .add("lbs_entry", &PbsOptions::lbs_entry,
             {.meaning = "where LBS enters Algorithm 1: start: what does not jiggle begins every step at its LBS "
                         "position; increment: all "
                         "particles are integrated, and moved by the change of LBS since the last step"})
        .add("bind_on_bone", &PbsOptions::bind_on_bone,
             {.meaning = "a vertex on its bone is pinned to it, or unbound: it has no bind constraint"})
        .add("bind_point", &PbsOptions::bind_point,
             {.meaning = "the point on the bone that a vertex is bound to: carried: its projection at rest, which the "
                         "bone carries along; "
                         "reprojected: the projection of its LBS position on the posed bone, anew in each step"})
        .add("volume_form", &PbsOptions::volume_form,
             {.meaning = "the volume correction: derived from Eq. 11, or with errors of the print (labels_relative, "
                         "labels_absolute: Eq. "
                         "12-14 with the printed particles; sign: Eq. 17-20; as_printed: all)"});
}

void add_improvement_keys(OptionFields<PbsOptions>& fields)
{
    fields.in_table("improved")
        .add("start", &PbsOptions::start, {.meaning = start_meaning})
        .add("bind_to", &PbsOptions::bind_to,
             {.meaning = "what a vertex is bound to: bone_distance: its rest distance from its bone, as in the paper, "
                         "which leaves the turn "
                         "about the bone free; blended_position: its position by LBS, which resists that turn, for a "
                         "k_bind well below 1"})
        .add("volume_of", &PbsOptions::volume_of,
             {.meaning = "whose volumes are constrained: tets: each tet's, as in the paper; regions: the sum over each "
                         "region of the mesh; "
                         "tets_and_regions: both, in this order; only tets with sleep, and with a printed volume_form"})
        .add("region_tets", &PbsOptions::region_tets,
             {.range = {1, 1e6}, .meaning = "tets in a region of volume_of, about; regions grow over shared faces"})
        .add("k_stretch_length_m", &PbsOptions::k_stretch_length_m,
             {.unit = "m",
              .range = {0, 1e6},
              .meaning = "the edge length at which k_stretch holds; an edge of rest length l has k_e with k_e / (1 - "
                         "k_e) = k / (1 - k) "
                         "(k_stretch_length_m / l)^2, so that the stiffness does not depend on the mesh; 0: k_stretch "
                         "for every edge, as "
                         "in the paper"});
}

// The last option that differs from the paper's Algorithm 1 names the variant.
std::string variant_of(const PbsOptions& options)
{
    const PbsOptions paper;
    if (options.k_stretch_length_m != paper.k_stretch_length_m) return "k_by_edge_length";
    if (options.volume_of != paper.volume_of) return std::string("volume_of_") + name_of(options.volume_of);
    if (options.contact) return "contact";
    if (options.start != paper.start) return name_of(options.start);
    if (options.bind_to != paper.bind_to) return name_of(options.bind_to);
    if (options.volume_form != paper.volume_form) return name_of(options.volume_form);
    if (options.bind_point != paper.bind_point) return name_of(options.bind_point);
    if (options.bind_on_bone != paper.bind_on_bone) return name_of(options.bind_on_bone);
    if (options.lbs_entry != paper.lbs_entry) return name_of(options.lbs_entry);
    if (options.class_order != paper.class_order) return name_of(options.class_order);
    if (options.stiffness_form != paper.stiffness_form) return name_of(options.stiffness_form);
    return options.jiggle ? "jiggle" : "default";
}

}  // namespace

const OptionFields<PbsOptions>& pbs_fields()
{
    static const OptionFields<PbsOptions> fields = [] {
        OptionFields<PbsOptions> declared("pbs");
        add_keys(declared);
        add_jiggle_keys(declared);
        add_variant_keys(declared);
        add_improvement_keys(declared);
        return declared.complete(1);  // except for threads
    }();
    return fields;
}

void check_pbs(const SceneValues& values, const std::string& table, PbsOptions& options, DeformerSpec& spec)
{
    if (options.sleep && options.order != pbs::Order::ordered)
        values.refuse(table + ".sleep", "expected false with order plain or spread, which project all");
    // the printed forms have plain code alone
    if (options.volume_form != pbs::VolumeForm::derived && options.order == pbs::Order::ordered) {
        if (values.given(table + ".order"))
            values.refuse(table + ".order", "expected plain or spread with a printed volume_form");
        options.order = pbs::Order::plain;
    }
    if (options.volume_of != pbs::VolumeOf::tets && (options.sleep || options.volume_form != pbs::VolumeForm::derived))
        values.refuse(table + ".improved.volume_of", "expected tets with sleep or a printed volume_form");
    spec.variant = variant_of(options);
}

}  // namespace experiments
