// How much a reading changes: figures A and B of a scene, and whether C01 or C02 would be judged otherwise on it, by their own rules and
// bounds. A row a figure.
#pragma once

#include "analysis/records/csv_table.hpp"
#include "experiments/studies/ambiguity/read_motion.hpp"

namespace experiments {

class AmbiguityTable {
public:
    // a: moved by the reading's baseline; resting: by the scene's own reading, from which jiggling is measured; zone: #V
    void add(const Scene& scene, const Reading& reading, const ReadMotion& a, const ReadMotion& b, const ReadMotion& resting,
             const std::vector<bool>& zone);

    const analysis::CsvTable& table() const { return table_; }

private:
    analysis::CsvTable table_{{"scene", "place", "reading_a", "reading_b", "figure", "a", "b", "change", "verdict_changed"}};
};

// A line a reading and scene, for people.
std::string ambiguity_markdown(const std::vector<analysis::CsvTable>& tables);

}  // namespace experiments
