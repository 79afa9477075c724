#include "experiments/studies/shared/bodies.hpp"

#include "pbs/character/bodies.hpp"
#include "pbs/geometry/input_error.hpp"

namespace experiments {

std::vector<std::string> installed_bodies(std::vector<analysis::LeftOut>& left_out)
{
    std::vector<std::string> installed;
    for (const pbs::NamedBody& body : pbs::named_bodies()) {
        if (!body.is_character) continue;
        try {
            pbs::require_body(body.name);
            installed.push_back(body.name);
        } catch (const pbs::InputError& error) {
            left_out.push_back({body.name, error.what()});
        }
    }
    return installed;
}

void for_each_installed_body(std::vector<analysis::LeftOut>& left_out, const std::function<void(const std::string& body)>& plan)
{
    for (const std::string& body : installed_bodies(left_out)) {
        try {
            plan(body);
        } catch (const pbs::InputError& error) {
            left_out.push_back({body, error.what()});
        }
    }
}

}  // namespace experiments
