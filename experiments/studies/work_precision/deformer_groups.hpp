// The deformers of the comparison in groups, as sentences and tables show them.
//   group_of("xpbd_small_steps").words   // XPBD
#pragma once

#include <string>
#include <vector>

namespace experiments {

// Deformers that are one entry in sentences and tables.
struct DeformerGroup {
    std::string key, words;  // linear_fem, linear FEM
    std::vector<std::string> deformers;
    bool is_external = false;  // one deformer of the user's own
};
const std::vector<DeformerGroup>& deformer_groups();
// These groups, followed by one for each of these deformers of the user's own.
std::vector<DeformerGroup> groups_with(const std::vector<std::string>& external);
// std::logic_error for a deformer of no group, or a key of none.
const DeformerGroup& group_of(const std::string& deformer);
const DeformerGroup& group_named(const std::string& key);

}  // namespace experiments
