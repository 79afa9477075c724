// Every value on record that a study concludes from others follows from these, to the last digit. Reference: what
// earlier versions concluded while they measured. They are compared as written, since a control without amplitude
// concludes that a ratio is no number.
#include "analysis/records/record_files.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/reproduce/reproduce.hpp"
#include "experiments/reproduce/studies.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

namespace {

namespace fs = std::filesystem;

TEST(KeptTables, OfConclusionsFollowFromTheMeasuredValues)
{
    const experiments::OpenedRecords opened(PBS_KEPT_RECORDS);
    std::map<std::string, int> concluded;  // by study
    for (const experiments::Study& study : experiments::studies()) {
        if (!study.conclusions) continue;
        for (const std::string& run :
             experiments::finished_runs((fs::path(opened.folder()) / study.name).string()).folders) {
            const fs::path file = fs::path(run) / "measurements.csv";
            if (!fs::exists(file)) continue;
            const auto recorded = analysis::measurements(file.string());
            for (const analysis::Measurement& now : study.conclusions(recorded)) {
                const analysis::Measurement* before = find_measurement(recorded, now.quantity, now.of);
                ASSERT_TRUE(before) << run << ": " << now.quantity << ", " << text_of(now.of);
                EXPECT_EQ(analysis::measurement_table({now}).text(), analysis::measurement_table({*before}).text())
                    << run << ": " << now.quantity << ", " << text_of(now.of);
                ++concluded[study.name];
            }
        }
    }
    for (const auto& [study, at_least] :
         {std::pair("convergence", 4), std::pair("jiggle", 50), std::pair("timing", 25)})
        EXPECT_GE(concluded[study], at_least) << study;
}

}  // namespace
