#include "experiments/studies/work_precision/case_split.hpp"

#include <algorithm>
#include <map>

namespace experiments {

std::vector<Half> halves_of(const std::vector<std::string>& bodies)
{
    std::map<std::string, int> poses_before;
    std::vector<Half> halves;
    for (const std::string& body : bodies) {
        const bool is_alone = std::count(bodies.begin(), bodies.end(), body) == 1;
        halves.push_back(is_alone || poses_before[body] % 2 == 1 ? Half::evaluation : Half::training);
        ++poses_before[body];
    }
    return halves;
}

}  // namespace experiments
