#include "experiments/studies/shared/reference_family.hpp"

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/settings/option_fields.hpp"

#include <algorithm>

namespace experiments {

std::vector<EnsembleMember> family()
{
    return {{.name = "smooth"},
            {.name = "stiffer_springs", .spring_factor = 100.0},
            {.name = "thinner_bones", .core_radius = 0.5},
            {.name = "stiffer_springs_thinner_bones", .spring_factor = 100.0, .core_radius = 0.5},
            {.name = "nu_0.3", .poisson = 0.3},
            {.name = "nu_0.49", .poisson = 0.49, .formulation = reference_fem::Formulation::mean_dilatation}};
}

std::size_t place_among_further(const std::string& member)
{
    const std::vector<EnsembleMember> all = family();
    return static_cast<std::size_t>(std::ranges::find(all, member, &EnsembleMember::name) - all.begin()) - 1;
}

const analysis::Columns<EnsembleMember>& family_member_columns()
{
    static const analysis::Columns<EnsembleMember> columns = {
        {"member", &EnsembleMember::name, "", "name of the reference in the family"},
        {"spring_factor", &EnsembleMember::spring_factor, "", "q of the attachment"},
        {"core_radius", &EnsembleMember::core_radius, "", "radius of the bones' capsules over the limb's"},
        {"poisson", &EnsembleMember::poisson, "", "Poisson's ratio"}};
    return columns;
}

nlohmann::json to_json(const EnsembleMember& member)
{
    static const auto fields = OptionFields<EnsembleMember>("member")
                                   .record("name", &EnsembleMember::name)
                                   .record("spring_factor", &EnsembleMember::spring_factor)
                                   .record("core_radius", &EnsembleMember::core_radius)
                                   .record("poisson", &EnsembleMember::poisson)
                                   .record("formulation", &EnsembleMember::formulation)
                                   .complete();
    return fields.json(member);
}

DeformerSpec flesh_of(DeformerSpec flesh, const EnsembleMember& member)
{
    auto& options = options_of<FemOptions>(flesh);
    options.attachment = FemAttachment::smooth;
    options.spring_factor = member.spring_factor;
    options.core_radius = member.core_radius;
    options.poisson = member.poisson;
    options.formulation = member.formulation;
    return flesh;
}

}  // namespace experiments
