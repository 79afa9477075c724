#include "experiments/studies/work_precision/deformer_groups.hpp"

#include "experiments/studies/work_precision/compared_deformers.hpp"

#include <algorithm>
#include <stdexcept>

namespace experiments {

const std::vector<DeformerGroup>& deformer_groups()
{
    static const std::vector<DeformerGroup> groups = [] {
        std::vector<DeformerGroup> all;
        const auto add = [&](const std::string& key, const std::string& words, const std::string& deformer) {
            auto found = std::ranges::find(all, key, &DeformerGroup::key);
            if (found == all.end()) found = all.insert(all.end(), DeformerGroup{key, words, {}});
            found->deformers.push_back(deformer);
        };
        for (const ComparedDeformer& entry : compared_deformers()) add(entry.group, entry.words, entry.name);
        add("linear_fem", "linear FEM", "fem_linear");
        for (const char* law : {"fem_corotational", "fem_neo_hookean", "fem_stable_neo_hookean"})
            add("nonlinear_fem", "nonlinear FEM", law);
        return all;
    }();
    return groups;
}

std::vector<DeformerGroup> groups_with(const std::vector<std::string>& external)
{
    std::vector<DeformerGroup> all = deformer_groups();
    for (const std::string& name : external) all.push_back({name, name, {name}, true});
    return all;
}

const DeformerGroup& group_of(const std::string& deformer)
{
    for (const DeformerGroup& group : deformer_groups())
        if (std::count(group.deformers.begin(), group.deformers.end(), deformer)) return group;
    throw std::logic_error("a deformer of no group: " + deformer);
}

const DeformerGroup& group_named(const std::string& key)
{
    for (const DeformerGroup& group : deformer_groups())
        if (group.key == key) return group;
    throw std::logic_error("no group of deformers: " + key);
}

}  // namespace experiments
