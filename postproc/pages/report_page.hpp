#pragma once
/// \file The report's page: one HTML file that needs no network and can be read without scripts.
#include <map>
#include <string>

#include "postproc/analysis/results.hpp"
#include "postproc/pages/head_picture.hpp"
#include "postproc/pages/report_figures.hpp"

namespace cutterflow::postproc {

/// What the page shows besides numbers.
struct PageFigures {
    std::map<Place, std::string> plots;  ///< drawn
    HeadPicture head;
    std::string head_from_hub;
    std::string steel;  ///< the section of what rock does to the steel; may be empty
    std::string note;   ///< why plots are missing; empty when none are
};

void write_report_page(const Page& page, const Results& results, const RunData& run, const PageFigures& figures);

}  // namespace cutterflow::postproc
