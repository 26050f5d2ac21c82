#pragma once
/// \file The report's page: one HTML file that needs no network and can be read without scripts.
#include <map>
#include <string>

#include "postproc/analysis/results.hpp"
#include "postproc/pages/head_picture.hpp"

namespace cutterflow::postproc {

/// What the page shows besides numbers. A plot that is absent is left out.
struct PageFigures {
    std::map<std::string, std::string> plots;  ///< as Page draws them, by the plot's name
    HeadPicture head;
    std::string head_from_hub;
    std::string note;  ///< why plots are missing; empty when none are
};

void write_report_page(const Page& page, const Results& results, const RunData& run, const PageFigures& figures);

}  // namespace cutterflow::postproc
