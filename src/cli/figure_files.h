// The data of the figures of `align reproduce`: a CSV file for each, and figures.json, which says to
// scripts/plot_figures.py how to draw them.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "study/facts.h"
#include "study/study.h"

namespace vibratory_alignment {

/// Writes the files into the folder, which is there. `studies` are those that the tables are of.
/// Columns: of a motion t,x,y,phi,vx,vy,omega,n1,n2; of curves the varied values, median, low and high (quartiles),
/// share (of trials that have a value), mark (share for which the figure's mark holds); of a region x, y and share.
/// False when `go_on`, asked often, said no: then files are missing. Throws OutputError, SceneError, std::runtime_error
/// when a file cannot be written or a motion fails.
bool write_figure_files(const std::filesystem::path& folder, const FactBook& book,
                        const std::map<std::string, Study>& studies, const Tables& tables,
                        const std::function<bool()>& go_on);

}  // namespace vibratory_alignment
