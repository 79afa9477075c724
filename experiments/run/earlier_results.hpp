// The results that a folder had before a run. A run that fails leaves them as they were.
//   EarlierResults earlier("results/arm");   // puts them aside, and back at the end of the scope
//   earlier.replace();                       // where the run has finished
#pragma once

#include <filesystem>
#include <string>

namespace experiments {

// Whether a file is one of a run's in frames/ or skin/: LABEL_000123.vtu, LABEL_surface_000123.vtp, LABEL.pvd and
// LABEL.glb.
bool is_own_frame(const std::filesystem::path& file);

// While the run lasts, the earlier results of its folder lie in FOLDER/.earlier. The destructor removes what the run
// has written and puts them back, unless they were replaced or are kept aside. A folder without run.json has no
// results, and the rows that a killed run left there are removed; what lies in its .earlier is still the earlier
// results. The same holds for an interrupted trial beside earlier results.
class EarlierResults {
public:
    explicit EarlierResults(const std::filesystem::path& folder);
    ~EarlierResults();
    EarlierResults(const EarlierResults&) = delete;
    EarlierResults& operator=(const EarlierResults&) = delete;

    std::string path() const;  // where they lie; empty: there are none
    void replace();            // the run has finished
    void keep_aside();         // the run was interrupted, and its rows stay

private:
    void put_back();

    std::filesystem::path folder_;
    bool is_settled_ = false;
};

}  // namespace experiments
