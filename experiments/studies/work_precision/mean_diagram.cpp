#include "experiments/studies/work_precision/mean_diagram.hpp"

#include <algorithm>

namespace experiments {
namespace {

std::optional<double> mean_of(const std::vector<Diagram>& poses, std::optional<double> Diagram::*value)
{
    double sum = 0.0;
    for (const Diagram& pose : poses) {
        if (!(pose.*value)) return std::nullopt;
        sum += *(pose.*value);
    }
    return sum / double(poses.size());
}

// The same setting in every pose; nothing where it has no error in one of them.
std::optional<DiagramPoint> mean_of(const std::vector<Diagram>& poses, const DiagramPoint& setting)
{
    constexpr std::optional<double> DiagramPoint::*known_or_not[] = {&DiagramPoint::ms_q1,
                                                                     &DiagramPoint::ms_q3,
                                                                     &DiagramPoint::l2_pct,
                                                                     &DiagramPoint::linf_m,
                                                                     &DiagramPoint::volume_abs_change_pct};
    DiagramPoint mean{setting.key};
    for (const auto value : known_or_not) mean.*value = 0.0;
    mean.members.fill(0.0);
    const double share = 1.0 / double(poses.size());
    for (const Diagram& pose : poses) {
        const auto same = [&](const DiagramPoint& point) { return point.key == setting.key; };
        const auto found = std::find_if(pose.points.begin(), pose.points.end(), same);
        if (found == pose.points.end()) return std::nullopt;
        for (const auto value : {&DiagramPoint::ms, &DiagramPoint::error_pct}) mean.*value += share * (*found).*value;
        for (const auto value : known_or_not) {
            std::optional<double>& sum = mean.*value;
            const std::optional<double>& more = (*found).*value;
            sum = sum && more ? std::optional(*sum + share * *more) : std::nullopt;
        }
        for (std::size_t m = 0; m < mean.members.size(); ++m) {
            const std::optional<double>& more = found->members[m];
            std::optional<double>& sum = mean.members[m];
            sum = sum && more ? std::optional(*sum + share * *more) : std::nullopt;
        }
    }
    return mean;
}

// A further reference takes part in a mean if it takes part in each pose.
DiagramMember mean_member(const std::vector<Diagram>& poses, std::size_t place)
{
    DiagramMember mean{true, 0.0};
    for (const Diagram& pose : poses) {
        const DiagramMember& one = pose.members[place];
        mean.takes_part = mean.takes_part && one.takes_part;
        mean.bound_pct =
            mean.bound_pct && one.bound_pct ? std::optional(*mean.bound_pct + *one.bound_pct / double(poses.size())) : std::nullopt;
    }
    return mean;
}

}  // namespace

Diagram mean_diagram(const std::string& key, const std::string& name, const std::vector<Diagram>& poses)
{
    Diagram mean;
    mean.comparison = poses.front().comparison;
    mean.key = key;
    mean.name = name;
    mean.groups = poses.front().groups;
    for (std::size_t m = 0; m < mean.members.size(); ++m) mean.members[m] = mean_member(poses, m);
    mean.poses = static_cast<int>(poses.size());
    for (const Diagram& pose : poses) mean.cases.push_back(pose.key);
    for (const Diagram& pose : poses) mean.masked_share_pct += pose.masked_share_pct / double(poses.size());
    const bool same = std::all_of(poses.begin(), poses.end(), [&](const Diagram& pose) { return pose.reference == poses[0].reference; });
    mean.reference = same ? poses[0].reference : "another one for each pose";
    mean.reference_ms = mean_of(poses, &Diagram::reference_ms);
    mean.reference_error_pct = mean_of(poses, &Diagram::reference_error_pct);
    for (const DiagramPoint& first : poses[0].points)
        if (auto point = mean_of(poses, first)) {
            point->below_reference_error = mean.reference_error_pct && point->error_pct <= *mean.reference_error_pct;
            mean.points.push_back(*point);
        }
    return mean;
}

}  // namespace experiments
