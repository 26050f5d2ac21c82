#include "postproc/pages/report.hpp"

#include <algorithm>

#include "geometry/base/file_content.hpp"
#include "geometry/base/run_files.hpp"
#include "postproc/draw/head_series.hpp"
#include "postproc/draw/page.hpp"
#include "postproc/pages/figures.hpp"
#include "postproc/pages/report_page.hpp"
#include "postproc/pages/velocity_figures.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;

bool has_outflow(const Results& results) {
    return std::any_of(results.outflow.begin(), results.outflow.end(),
                       [](const BinOutflow& bin) { return bin.radial_velocity.has_value(); });
}

std::vector<Plot> plots_of(const Results& results, const RunData& run) {
    const double revolution = run.operating_point.revolution_s();
    const bool with_rock = results.spillage.has_value();
    std::vector<Plot> plots;
    if (with_rock) {
        plots.push_back(outcome_plot(*results.spillage));
        plots.push_back(fates_plot(run.rock->fates, *results.spillage, revolution));
        plots.push_back(ratio_plot(run.rock->fates, *results.spillage, revolution));
        if (!results.spillage->first_exit_azimuths.empty()) plots.push_back(first_exit_plot(results.spillage->first_exit_azimuths));
    }
    if (with_rock || !results.outflow.empty()) plots.push_back(bins_plot(results));
    if (with_rock && has_outflow(results) && results.spillage->fates.placed.mass > 0.0) plots.push_back(top_bin_plot(results));
    for (const auto& plane : {axial_plane_plot(run), under_ring_plot(run)}) {
        if (plane) plots.push_back(*plane);
    }
    plots.push_back(torque_plot(run.loads, results.rotor, revolution, with_rock));
    plots.push_back(balance_plot(run.balance, revolution, with_rock));
    plots.push_back(cost_plot(results.cost));
    return plots;
}

PageFigures draw_figures(const Results& results, const RunData& run, Page& page) {
    PageFigures figures{{}, draw_head_from_side(run, page, "head_side"), draw_head_from_hub(run, page, "head_axial"), ""};
    if (!gnuplot_is_installed()) {
        figures.note =
            "Plots are missing: the program gnuplot was not found. Install it (Debian: apt-get install gnuplot-nox) and make the "
            "report again; the tables below hold the same numbers.";
        return figures;
    }
    for (const Plot& plot : plots_of(results, run)) figures.plots[plot.script.name] = page.draw(plot);
    return figures;
}

/// Writes results.json and the page.
ReportSummary write_files(const RunData& run, const fs::path& results_file, const fs::path& page_file, PageForm form) {
    ReportSummary summary{results_file, page_file, compute_results(run), ""};
    write_file(summary.results_file, results_json(summary.results, run).dump(2) + "\n");
    Page page(summary.page_file, form);
    const PageFigures figures = draw_figures(summary.results, run, page);
    summary.note = figures.note;
    write_report_page(page, summary.results, run, figures);
    return summary;
}

}  // namespace

ReportSummary write_report(const fs::path& run_directory) {
    const ReportSummary summary =
        write_files(read_run(run_directory), run_directory / names::results_json, run_directory / names::report_page, PageForm::live);
    write_head_series(run_directory);
    return summary;
}

ReportSummary publish_report(const fs::path& run_directory, const fs::path& folder) {
    const fs::path results = fs::path(names::results_json).filename(), page = fs::path(names::report_page).filename();
    const RunData run = read_run(run_directory);
    require_own_folder(folder, results);
    return write_files(run, folder / results, folder / page, PageForm::still);
}

}  // namespace cutterflow::postproc
