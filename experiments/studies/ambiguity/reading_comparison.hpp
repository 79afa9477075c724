// Readings beside their baselines, claim by claim: what a run of the study of ambiguities measures and leaves on record.
//   ReadingComparison comparison("limb", readings);
//   comparison.measure({"C03", "C12"}, [&](const auto& touching) { return figures_of_starts(of, touching); });
//   comparison.changes().write("ambiguity.csv");
// Only readings that can touch one of the claims are measured, and their baselines before them.
#pragma once

#include "experiments/studies/ambiguity/claim_changes.hpp"

#include <functional>

namespace experiments {

class ReadingComparison {
public:
    using Measure = std::function<std::vector<ReadingFigures>(const std::vector<Reading>&)>;  // one a reading

    ReadingComparison(const std::string& body, const std::vector<Reading>& readings) : body_(body), readings_(readings) {}

    void measure(const std::vector<std::string>& claims, const Measure& measure);

    const analysis::CsvTable& changes() const { return changes_.table(); }
    const std::string& breakdown() const { return breakdown_; }  // of readings, if any

private:
    const Reading& baseline_of(const Reading& reading) const;

    std::string body_, breakdown_;
    std::vector<Reading> readings_;
    ClaimChanges changes_;
};

}  // namespace experiments
