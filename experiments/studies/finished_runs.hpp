// The runs of a study that ended. A study's conclusion reads their records and writes those that sum them up into the study's folder.
#pragma once

#include "analysis/records/typed_table.hpp"

#include <string>
#include <utility>
#include <vector>

namespace experiments {

struct FinishedRuns {
    std::string folder = {};                // of the study
    std::vector<std::string> folders = {};  // one per run that ended, in the plan's order
    std::vector<std::string> missing = {};  // names of the planned runs that did not end

    bool none() const { return folders.empty(); }

    std::vector<std::string> files(const std::string& file) const;  // its path in every run that wrote it
    // The table `file` of every run that wrote it, one below the other. InputError where their columns differ.
    analysis::CsvTable gathered(const std::string& file) const;
    // The rows of `file` of every run that wrote it. InputError as rows_of.
    template <typename Row>
    std::vector<Row> rows(const analysis::Columns<Row>& columns, const std::string& file) const
    {
        std::vector<Row> all;
        for (const std::string& path : files(file))
            for (Row& row : rows_of(columns, analysis::read_csv(path))) all.push_back(std::move(row));
        return all;
    }

    // Writes a record of the study. InputError where it cannot be written.
    void write(const std::string& file, const std::string& text) const;
    void write(const std::string& file, const analysis::CsvTable& table) const;
    template <typename Row>
    void write(const std::string& file, const analysis::Columns<Row>& columns, const std::vector<Row>& rows) const
    {
        write(file, table_of(columns, rows));
    }
};

}  // namespace experiments
