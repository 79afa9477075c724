#include "experiments/deformers/pbs/pbs_settings.hpp"

namespace experiments {
namespace {

using pbs::PbsOptions;

void add_keys(OptionFields<PbsOptions>& fields)
{
    fields.add("iterations", &PbsOptions::iterations, {.lowest = 0, .highest = 1e6, .meaning = "N_iterations of Algorithm 1"})
        .add("k_stretch", &PbsOptions::k_stretch,
             {.lowest = 0,
              .highest = 1,
              .is_stated = true,
              .meaning = "stiffness of Eq. 10; the paper leaves it unstated outside the jiggling zone; 0 leaves the class out"})
        .add("k_volume", &PbsOptions::k_volume,
             {.lowest = 0,
              .highest = 1,
              .is_stated = true,
              .meaning = "stiffness of Eq. 11; the paper leaves it unstated; 0 leaves the class out"})
        .add("k_bind", &PbsOptions::k_bind,
             {.lowest = 0,
              .highest = 1,
              .is_stated = true,
              .meaning = "stiffness of the bind constraint (Sec. 3.6); the paper leaves it unstated; 0 leaves the class out"})
        .add("gravity_m_s2", &PbsOptions::gravity_m_s2,
             {.unit = "m/s^2",
              .is_stated = true,
              .meaning = "external acceleration on the integrated (jiggling) particles; the paper leaves it unstated"})
        .add("order", &PbsOptions::order,
             {.meaning =
                  "order of projection within a class: plain is file order, as the paper reads; ordered takes sixteen constraints that "
                  "share "
                  "no vertex side by side; grouped the same with neighbouring constraints in groups, the quickest; printed volume_forms "
                  "know plain alone"})
        .add("precision", &PbsOptions::precision, {.meaning = "floating point of the projections"})
        .add("masses", &PbsOptions::masses,
             {.meaning = "unit: m_i = 1 (the paper); lumped: a quarter of the rest volume of each tet around"})
        .add("stop_residual", &PbsOptions::stop_residual, {.lowest = 0, .meaning = "stop when every residual is below; 0: all iterations"})
        .add(
            "sleep", &PbsOptions::sleep,
            {.meaning = "let constraints that LBS satisfies, and all around them, sleep for the frame; at its end they are looked at again "
                        "and the frame is redone with those that are not satisfied any more; orders ordered and grouped"})
        .add("sleep_tolerance", &PbsOptions::sleep_tolerance,
             {.lowest = 0,
              .highest = 1,
              .meaning = "what a sleeping constraint may be off: |l / l0 - 1|, |V / V0 - 1|, bind in shares of the mean edge"})
        .add("record_iterations", &PbsOptions::record_iterations, {.meaning = "write iterations.csv: residuals per frame and iteration"});
}

// Studies set the zone's k_bind too.
void add_jiggle_keys(OptionFields<PbsOptions>& fields)
{
    const auto read = [](PbsOptions& options, const SceneValues& values, const std::string& path) {
        options.jiggle = pbs::Jiggle{values.number(path)};
    };
    const auto write = [](const PbsOptions& options, nlohmann::json& record) {
        if (options.jiggle) record["jiggle"] = {{"k_stretch", options.jiggle->k_stretch}};
        if (options.jiggle && options.jiggle->k_bind) record["jiggle"]["k_bind"] = *options.jiggle->k_bind;
    };
    fields.in_table("jiggle").add(
        "k_stretch", KeyType::number, pbs::Jiggle{}.k_stretch,
        {.lowest = 0,
         .highest = 1,
         .meaning = "stiffness of edges with both ends in the jiggling zone; jiggle is off unless this table is there"},
        read, write);
}

void add_variant_keys(OptionFields<PbsOptions>& fields)
{
    fields.in_table("variant")
        .add("stiffness", &PbsOptions::stiffness_form,
             {.meaning =
                  "per_iteration: the factor k in every iteration, as printed; exponent: 1 - (1 - k)^(1 / iterations) instead (Mueller "
                  "2006), so that a lone constraint is left with 1 - k of its error whatever their number"})
        .add("class_order", &PbsOptions::class_order,
             {.meaning = "in which order an iteration takes the classes; bind_stretch_volume is Algorithm 1's, lines 11-13"})
        .add("lbs_entry", &PbsOptions::lbs_entry,
             {.meaning =
                  "where LBS enters Algorithm 1: start: what does not jiggle starts every step at its LBS position; increment: all is "
                  "integrated, and moved by what LBS has moved since the last step"})
        .add("bind_on_bone", &PbsOptions::bind_on_bone,
             {.meaning = "a vertex on its bone: pinned to it, or unbound: without a bind constraint"})
        .add("volume_form", &PbsOptions::volume_form,
             {.meaning = "the volume correction: derived from Eq. 11, or with errors of print (labels_relative, labels_absolute: Eq. 12-14 "
                         "under the printed particles; sign: Eq. 17-20; as_printed: all)"});
}

// The last option that differs from the paper's Algorithm 1 names the variant.
std::string variant_of(const PbsOptions& options)
{
    const PbsOptions paper;
    if (options.volume_form != paper.volume_form) return name_of(options.volume_form);
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
        return declared;
    }();
    return fields;
}

void read_pbs(const SceneValues& values, const std::string& table, DeformerSpec& spec)
{
    PbsOptions options = pbs_fields().read(values, table);
    if (options.sleep && options.order == pbs::Order::plain)
        values.refuse(table + ".sleep", "expected false with order plain, which projects all");
    if (options.volume_form != pbs::VolumeForm::derived) {  // the printed forms are written in the plain order alone
        if (values.given(table + ".order") && options.order != pbs::Order::plain)
            values.refuse(table + ".order", "expected plain with a printed volume_form");
        options.order = pbs::Order::plain;
    }
    spec.variant = variant_of(options);
    spec.options = options;
}

}  // namespace experiments
