#include "pbs/rig/skin_weights.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/number_text.hpp"

#include <algorithm>
#include <cmath>

namespace pbs {
namespace {

constexpr double sum_tolerance =
    1e-3;  // weights of 8 bits, four per point, sum to one within 4/255 at worst and 1e-3 where they are rounded well

}  // namespace

void SkinWeights::add_point(const std::vector<JointShare>& shares)
{
    std::vector<JointShare> merged;
    for (const JointShare& share : shares) {
        const auto same = std::find_if(merged.begin(), merged.end(), [&](const JointShare& other) { return other.joint == share.joint; });
        if (same == merged.end())
            merged.push_back(share);
        else
            same->weight += share.weight;
    }
    points_.push_back(merged);
}

Weights SkinWeights::normalised(const std::string& file, const std::string& mesh, std::vector<std::string>& remarks) const
{
    Weights skin;
    skin.first.push_back(0);
    int without_weight = 0, other_sums = 0;
    for (std::size_t p = 0; p < points_.size(); ++p) {
        double sum = 0.0;
        for (const JointShare& share : points_[p]) {
            if (!(share.weight >= 0.0 && std::isfinite(share.weight)))
                throw InputError(file, 0, "mesh " + mesh + ", weight of point " + std::to_string(p), number_text(share.weight),
                                 "expected a finite number of 0 or more");
            sum += share.weight;
        }
        if (!(sum > 0.0)) {
            ++without_weight;
            skin.bone.push_back(0);
            skin.weight.push_back(1.0);
        } else {
            other_sums += std::abs(sum - 1.0) > sum_tolerance;
            for (const JointShare& share : points_[p]) {
                if (share.weight == 0.0) continue;
                skin.bone.push_back(share.joint);
                skin.weight.push_back(share.weight / sum);
            }
        }
        skin.first.push_back(static_cast<int>(skin.bone.size()));
    }
    if (without_weight > 0 && without_weight == static_cast<int>(points_.size()))
        throw InputError(file, 0, "mesh " + mesh + ", weights", "0", "expected a point with a weight: the mesh has a skin");
    const std::string of_mesh = " of the " + std::to_string(points_.size()) + " points of mesh " + mesh;
    if (without_weight > 0)
        remarks.push_back(std::to_string(without_weight) + of_mesh + " have no weight; they follow the first joint of the skin");
    if (other_sums > 0)
        remarks.push_back("the weights of " + std::to_string(other_sums) + of_mesh + " do not sum to one; they were divided by their sum");
    return skin;
}

}  // namespace pbs
