// The finished runs of a study. The conclusion of a study reads their records and writes summaries into the folder of the study.
#pragma once

#include "analysis/records/tables.hpp"

#include <string>
#include <utility>
#include <vector>

namespace experiments {

struct FinishedRuns {
    std::string folder = {};                // of the study
    std::vector<std::string> folders = {};  // one per finished run, in the order of the plan
    std::vector<std::string> missing = {};  // names of the planned runs that did not finish

    bool none() const { return folders.empty(); }

    std::vector<std::string> files(const std::string& file) const;  // its path in every run that wrote it
    // The tables `file` of all runs that wrote it, one below the other. InputError if their columns differ.
    analysis::CsvTable gathered(const std::string& file) const;
    // The rows of `file` of all runs that wrote it. InputError as rows_of.
    template <typename Row>
    std::vector<Row> rows(const analysis::Columns<Row>& columns, const std::string& file) const
    {
        std::vector<Row> all;
        for (const std::string& path : files(file))
            for (Row& row : rows_of(columns, analysis::read_csv(path))) all.push_back(std::move(row));
        return all;
    }

    // Writes a record of the study. InputError if it cannot be written.
    void write(const std::string& file, const std::string& text) const;
    void write(const std::string& file, const analysis::CsvTable& table) const;
    template <typename Row>
    void write(const std::string& file, const analysis::Columns<Row>& columns, const std::vector<Row>& rows) const
    {
        write(file, table_of(columns, rows));
    }
};

}  // namespace experiments
