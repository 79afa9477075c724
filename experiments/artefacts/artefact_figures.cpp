#include "experiments/artefacts/artefact_figures.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {
namespace {

constexpr double deepest_bend_deg = 110.0;

using Extreme = double SectionExtremesOverRest::*;

// The sizes of one group in one pose at one joint: its own first.
std::vector<double> sizes(const std::vector<ArtefactSample>& samples, const std::string& group, std::size_t pose, std::size_t joint,
                          Extreme extreme)
{
    std::vector<double> sizes;
    for (const ArtefactSample& sample : samples)
        if (sample.group == group && sample.pose == pose && sample.joint == joint) sizes.push_back(sample.extremes.*extreme);
    return sizes;
}

double least(const std::vector<double>& values)
{
    return *std::min_element(values.begin(), values.end());
}

double most(const std::vector<double>& values)
{
    return *std::max_element(values.begin(), values.end());
}

std::string of_text(const ArtefactCase& of, const ArtefactBody& body, std::size_t pose, std::size_t joint)
{
    return fmt::format("{}, {}, {}", body.posed.character().name, of.poses[pose].name, body.joints[joint].name);
}

// The claim's own quantity is that of pbs; the others' carry their names.
std::string quantity_of(const std::string& quantity, const std::string& group)
{
    return group == "pbs" ? quantity : quantity + ", " + group;
}

template <typename Add>
void for_each_pose_and_joint(const ArtefactCase& of, const ArtefactBody& body, const Add& add)
{
    for (std::size_t pose = 0; pose < of.poses.size(); ++pose)
        for (std::size_t joint = 0; joint < body.joints.size(); ++joint) add(pose, joint);
}

}  // namespace

std::vector<analysis::Measurement> candy_wrapper_figures(const ArtefactCase& of, const ArtefactBody& body,
                                                         const std::vector<ArtefactSample>& samples)
{
    std::vector<analysis::Measurement> figures;
    for_each_pose_and_joint(of, body, [&](std::size_t pose, std::size_t joint) {
        for (const std::string group : {"pbs", "lbs", "dqs", "reference"})
            for (const auto& [quantity, extreme] :
                 {std::pair{"smallest section radius over rest", &SectionExtremesOverRest::smallest_radius},
                  {"smallest section area over rest", &SectionExtremesOverRest::smallest_area}}) {
                const std::vector<double> values = sizes(samples, group, pose, joint, extreme);
                if (values.empty()) continue;
                figures.push_back({"C04", quantity_of(quantity, group), of_text(of, body, pose, joint), values.front(), least(values),
                                   most(values), "1"});
            }
    });
    return figures;
}

std::vector<analysis::Measurement> bulge_figures(const ArtefactCase& of, const ArtefactBody& body,
                                                 const std::vector<ArtefactSample>& samples)
{
    std::vector<analysis::Measurement> figures;
    for_each_pose_and_joint(of, body, [&](std::size_t pose, std::size_t joint) {
        if (body.sections[joint].bend_deg(body.posed.pose(pose)) > deepest_bend_deg) return;
        for (const auto& [quantity, extreme] :
             {std::pair{"largest section radius over the reference's", &SectionExtremesOverRest::largest_radius},
              {"largest section area over the reference's", &SectionExtremesOverRest::largest_area}}) {
            const std::vector<double> reference = sizes(samples, "reference", pose, joint, extreme);
            if (reference.empty()) continue;
            for (const std::string group : {"pbs", "lbs", "dqs"}) {
                const std::vector<double> values = sizes(samples, group, pose, joint, extreme);
                if (values.empty()) continue;
                figures.push_back({"C05", quantity_of(quantity, group), of_text(of, body, pose, joint), values.front() / reference.front(),
                                   least(values) / most(reference), most(values) / least(reference), "1"});
            }
        }
    });
    return figures;
}

}  // namespace experiments
