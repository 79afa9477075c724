// The registration of the finite element reference.

#include "experiments/deformers/deformer_kind.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/process/machine.hpp"

namespace experiments {
namespace {

void add_material_fields(OptionFields<FemOptions>& fields)
{
    fields.key("name", KeyType::text, "fem", {.meaning = "the name this reference has in the records"})
        .add("model", &FemOptions::model,
             {.meaning = "constitutive model; linear strain is fictitious by 1 - cos of the rotation and "
                         "st_venant_kirchhoff gives way under "
                         "compression: both are negative controls at large rotations"})
        .add("element_order", &FemOptions::element_order,
             {.range = {1, 2}, .meaning = "polynomial order of the simplices"})
        .add("formulation", &FemOptions::formulation,
             {.meaning = "how volume enters: displacement; mean_dilatation (one volume constraint per tet), which "
                         "equals displacement on order 1; "
                         "taylor_hood (order 2 with a continuous pressure, the most accurate near nu = 1/2; for the "
                         "linear model, quasi-static)"})
        .add("young_pa", &FemOptions::young_pa,
             {.unit = "Pa",
              .range = {above_zero, 1e15},
              .meaning = "Young's modulus; cancels where displacements alone drive the body"})
        .add("poisson", &FemOptions::poisson, {.range = {0, 0.4999999}, .meaning = "Poisson's ratio"})
        .add("density_kg_m3", &FemOptions::density_kg_m3,
             {.unit = "kg/m^3", .range = {0, 1e6}, .meaning = "density, for gravity and dynamics"})
        .add("gravity_m_s2", &FemOptions::gravity_m_s2, {.unit = "m/s^2", .meaning = "gravity on the reference"})
        .add("dynamics", &FemOptions::dynamics,
             {.meaning = "time integration: quasi_static (equilibrium in every frame), newmark (average acceleration), "
                         "generalized_alpha"});
    const auto read_rayleigh = [](FemOptions& options, const SceneValues& values, const std::string& path) {
        const std::vector<double> rayleigh = values.numbers(path);
        if (rayleigh.size() != 2) values.refuse(path, "expected two numbers, [mass, stiffness]");
        options.rayleigh_mass_1_s = rayleigh[0];
        options.rayleigh_stiffness_s = rayleigh[1];
    };
    const auto write_rayleigh = [](const FemOptions& options, nlohmann::json& record) {
        record["rayleigh"] = {options.rayleigh_mass_1_s, options.rayleigh_stiffness_s};
    };
    fields.add(
        "rayleigh", KeyType::numbers, {FemOptions{}.rayleigh_mass_1_s, FemOptions{}.rayleigh_stiffness_s},
        {.unit = "1/s, s",
         .range = {0, 1e6},
         .meaning = "Rayleigh damping [mass, stiffness]: C = mass M + stiffness K(rest); without dynamics, zero"},
        read_rayleigh, write_rayleigh, 2);
}

void add_attachment_fields(OptionFields<FemOptions>& fields)
{
    fields.add(
        "attachment", &FemOptions::attachment,
        {.meaning = "smooth: springs whose density decreases smoothly to zero from the bone's axis to the surface of a "
                    "capsule around it; "
                    "embedded: bones as rigid capsules tied to the flesh by stiff springs; nodes: whole tets inside "
                    "the capsules "
                    "prescribed; bind: the paper's bind constraint as an energy on every vertex, for nonlinear models; "
                    "held: as smooth, and "
                    "each bone also holds, by stiff springs, the tets that it alone moves, as a skull holds a head; of "
                    "a model, bones that the "
                    "motion never moves apart are one bone for this, and loose parts follow linear blend skinning"});
    // The value 0 of the next two stands for the attachment's own, which records state.
    fields.add("core_radius", &FemOptions::core_radius,
               {.range = {0, 1},
                .meaning = "attachments smooth, embedded, nodes and held: radius of the bone's capsule, a factor on "
                           "the local limb radius, without a "
                           "unit; 0: 0.7 with attachments smooth and held, otherwise 0.35. Both are choices of this "
                           "project. The study ensemble compares "
                           "smooth springs with 0.7 and 0.5"});
    fields.add("spring_factor", &FemOptions::spring_factor,
               {.range = {0, 1e9},
                .meaning = "attachments smooth, embedded, bind and held: q, a factor without a unit: the density of "
                           "the springs is q E / r^2 [N/m^4], r "
                           "the capsule's radius (smooth and held: the density on the axis) or the local limb radius "
                           "(bind); 0: 10 with attachments "
                           "smooth and held, otherwise 1e4. Both are choices of this project. The study ensemble "
                           "compares smooth springs with 10 and "
                           "100; doubling 1e4 with attachment embedded changes no reported value"});
    fields.derived("core_radius", [](const FemOptions& options) { return options.used_core_radius(); })
        .derived("spring_factor", [](const FemOptions& options) { return options.used_spring_factor(); })
        .add("attachment_kernel", &FemOptions::attachment_kernel,
             {.meaning = "attachments smooth and held, s = distance to the axis / r: biweight: density (1 - s^2)^2 "
                         "across the bone (Tukey's "
                         "biweight: A. E. Beaton, J. W. Tukey, Technometrics 16, 1974) and a cubic step at its ends, "
                         "once continuously "
                         "differentiable; wendland: (1 - s)^4 (4 s + 1) (H. Wendland, Adv. Comput. Math. 4, 1995) and "
                         "a step of degree 5, "
                         "twice so"})
        .add("attachment_ends", &FemOptions::attachment_ends,
             {.unit = "r",
              .range = {0.01, 100},
              .meaning = "attachments smooth and held: the length, in radii of the capsule, over which the density "
                         "rises from 0 at each end "
                         "of it; at most half of the capsule's length. The default is a choice of this project"})
        .add("attachment_samples", &FemOptions::attachment_samples,
             {.range = {1, 4},
              .meaning = "attachments smooth, embedded and held: multiplies the 40 stations along a bone, the 8 rings "
                         "of sample points "
                         "across it and the 24 points of a ring"});
}

void add_contact_fields(OptionFields<FemOptions>& fields)
{
    fields
        .add("contact", &FemOptions::contact,
             {.meaning = "frictionless contact of the surface with itself, by a barrier between its triangles (M. Li "
                         "et al., Incremental Potential "
                         "Contact, ACM TOG 39(4), 2020), so that no equilibrium intersects itself; false with model "
                         "linear and with dynamics "
                         "generalized_alpha, whose state at the end of a step is extrapolated"})
        .derived("contact", [](const FemOptions& options) { return options.has_contact(); })
        .add("contact_range", &FemOptions::contact_range,
             {.unit = "r",
              .range = {1e-4, 1},
              .meaning = "contact: the distance below which the surface presses on itself, over the mean r of the "
                         "local limb radii; at most half "
                         "of the distance at rest. The default is a choice of this project"})
        .add("contact_stiffness", &FemOptions::contact_stiffness,
             {.unit = "E",
              .range = {1e-4, 1e4},
              .meaning = "contact: the stiffness of the barrier over Young's modulus E: at 0.57 of the range the "
                         "pressure is E. The default is "
                         "a choice of this project"});
}

void add_solver_fields(OptionFields<FemOptions>& fields)
{
    fields
        .add("solver", &FemOptions::solver,
             {.meaning = "cholmod; umfpack, for comparison, with the linear model"})
        .add("most_newton_steps", &FemOptions::most_newton_steps,
             {.range = {0, 1e9},
              .meaning = "nonlinear model, dynamics quasi_static: no further solve on the way to a stage of a pose "
                         "begins after this number of "
                         "Newton steps, and the pose is not reached; the linear elements of nested_start have four "
                         "times as many; 0: no limit"})
        .add("nested_start", &FemOptions::nested_start,
             {.meaning = "nonlinear model, with element_order 2 or a refined character: in the first pose and where a "
                         "bone turns by more than 15 "
                         "degrees from the last pose, Newton's iterations start from the solution with order 1 or of "
                         "the unrefined character. "
                         "This leads to the same solution in fewer steps"});
}

// The rules that involve more than one key.
void check(const SceneValues& values, const std::string& table, FemOptions& options, DeformerSpec& /*spec*/)
{
    const bool linear = options.model == reference_fem::Model::linear;
    const bool quasi_static = options.dynamics == reference_fem::Dynamics::quasi_static;
    const bool damped = options.rayleigh_mass_1_s > 0.0 || options.rayleigh_stiffness_s > 0.0;
    const bool may_be_taylor_hood = linear && quasi_static && options.element_order == 2 && options.poisson > 0.0;
    const bool may_be_nested =
        !options.nested_start ||
        (!linear && quasi_static && (options.element_order == 2 || values.integer("character.refine") != 0));
    const auto given = [&](const char* key) { return values.given(table + "." + key); };
    const auto refuse_if = [&](bool is_wrong, const char* key, const char* expected) {
        if (is_wrong) values.refuse(table + "." + key, expected);
    };
    refuse_if(linear && options.attachment == FemAttachment::bind, "attachment",
              "expected smooth, embedded or nodes with model linear, or held, which includes smooth: the bind "
              "constraint is not linear");
    refuse_if(!options.has_capsules() && given("core_radius"), "core_radius",
              "expected attachment smooth, embedded or nodes, which have capsules, or held, which includes smooth");
    refuse_if(!options.has_spring_factor() && given("spring_factor"), "spring_factor",
              "expected attachment smooth, embedded or bind: prescribed nodes have no springs; held includes smooth");
    for (const char* key : {"attachment_kernel", "attachment_ends"})
        refuse_if(!options.is_smooth() && given(key), key,
                  "expected attachment smooth, which alone has it, or held, which includes smooth");
    refuse_if(!options.has_sample_points() && given("attachment_samples"), "attachment_samples",
              "expected attachment smooth or embedded, which have sample points, or held, which includes smooth");
    refuse_if(options.core_radius > 0.0 && options.core_radius < 0.01, "core_radius", "expected 0, or 0.01 to 1");
    refuse_if(options.spring_factor > 0.0 && options.spring_factor < 1e-3, "spring_factor",
              "expected 0, or 0.001 to 1e9");
    refuse_if(!linear && options.solver != reference_fem::LinearSolver::cholmod, "solver",
              "expected cholmod with a nonlinear model: Newton needs to know where a matrix is not positive definite");
    refuse_if(options.formulation == reference_fem::Formulation::taylor_hood && !may_be_taylor_hood, "formulation",
              "expected taylor_hood only with model linear, dynamics quasi_static, element_order 2, poisson > 0 and a "
              "direct solver");
    refuse_if(quasi_static && damped, "rayleigh", "expected [0, 0] with dynamics quasi_static: nothing moves there");
    refuse_if(!may_be_nested, "nested_start",
              "expected false unless element_order is 2 or character.refine > 0, the model nonlinear and dynamics "
              "quasi_static");
    refuse_if(given("contact") && options.contact && !options.has_contact(), "contact",
              "expected false with model linear and with generalized_alpha, whose state at the end of a step is "
              "extrapolated");
    for (const char* key : {"contact_range", "contact_stiffness"})
        refuse_if(!options.has_contact() && given(key), key,
                  "expected contact = true with a nonlinear model, which alone has it");
    refuse_if(!quasi_static && !(options.density_kg_m3 > 0.0), "density_kg_m3", "expected a density > 0 with dynamics");
}

}  // namespace

const OptionFields<FemOptions>& fem_fields()
{
    static const OptionFields<FemOptions> fields = [] {
        OptionFields<FemOptions> declared("fem", true);
        add_material_fields(declared);
        add_attachment_fields(declared);
        add_contact_fields(declared);
        add_solver_fields(declared);
        return declared.complete();
    }();
    return fields;
}

DeformerKind fem_kind()
{
    DeformerKind kind = kind_of<void>(
        "fem",
        "finite elements on the same tets (deal.II, CHOLMOD): small-strain (fictitious strain 1 - cos(rotation)), "
        "corotational, "
        "neo-Hookean (also "
        "stable), St Venant-Kirchhoff; in equilibrium or in time; a frame that is not reached is marked not_converged",
        fem_fields(), check);
    kind.needs_list = true;
    // Loads deal.II and some 200 shared objects, when a scene first uses a reference.
    kind.make = [](const DeformerSpec& spec) {
        const auto make = load_module_with_blas("pbskin_fem").function<decltype(pbskin_make_fem)>("pbskin_make_fem");
        return std::unique_ptr<Deformer>(make(options_of<FemOptions>(spec)));
    };
    kind.traits = [](const DeformerSpec& spec) {
        const bool linear = options_of<FemOptions>(spec).model == reference_fem::Model::linear;
        return DeformerTraits{.has_small_strain = linear, .is_negative_control = linear, .solves_equations = true};
    };
    return kind;
}

}  // namespace experiments
