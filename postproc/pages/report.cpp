#include "postproc/pages/report.hpp"

#include "geometry/base/file_content.hpp"
#include "geometry/base/run_files.hpp"
#include "postproc/draw/gnuplot.hpp"
#include "postproc/draw/head/head_series.hpp"
#include "postproc/draw/page.hpp"
#include "postproc/pages/own_document.hpp"
#include "postproc/pages/report_page.hpp"
#include "postproc/pages/steel/steel_section.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;

PageFigures draw_figures(const Results& results, const RunData& run, Page& page) {
    PageFigures figures{{},
                        draw_head_from_side(run, page, "head_side"),
                        draw_head_from_hub(run, page, "head_axial"),
                        steel_section(results, run, page),
                        ""};
    if (!gnuplot_is_installed()) {
        figures.note =
            "Plots are missing: the program gnuplot was not found. Install it (Debian: apt-get install gnuplot-nox) and make the "
            "report again; the tables below hold the same numbers.";
        return figures;
    }
    for (const auto& [place, figure] : report_figures(results, run)) figures.plots[place] += page.draw(figure);
    return figures;
}

constexpr const char* k_published_run = "published_run";  // key by which a published results.json is recognised

/// Tells runs of different studies, cutters and repeats apart.
std::string identity_of(const RunData& run) {
    return sha256(nlohmann::json{{"setting", run.setting}, {"release", run.release}, {"seed", run.seed}}.dump());
}

/// Writes results.json and the page.
/// \param additions  to results.json
ReportSummary write_files(const RunData& run, const fs::path& results_file, const fs::path& page_file, PageForm form,
                          const nlohmann::json& additions) {
    ReportSummary summary{results_file, page_file, compute_results(run), ""};
    nlohmann::json numbers = results_json(summary.results, run);
    numbers.update(additions);
    write_file(summary.results_file, numbers.dump(2) + "\n");
    Page page(summary.page_file, form);
    const PageFigures figures = draw_figures(summary.results, run, page);
    summary.note = figures.note;
    write_report_page(page, summary.results, run, figures);
    return summary;
}

}  // namespace

ReportSummary write_report(const fs::path& run_directory) {
    const RunData run = read_run(run_directory);
    const ReportSummary summary =
        write_files(run, run_directory / names::results_json, run_directory / names::report_page, PageForm::live, nlohmann::json::object());
    if (!run.flow) write_head_series(run_directory);
    return summary;
}

ReportSummary publish_report(const fs::path& run_directory, const fs::path& folder) {
    const fs::path results = fs::path(names::results_json).filename(), page = fs::path(names::report_page).filename();
    const RunData run = read_run(run_directory);
    const std::string identity = identity_of(run);
    require_own_document(folder, results,
                         [&](const nlohmann::json& earlier) { return earlier.value(k_published_run, nlohmann::json()) == identity; });
    return write_files(run, folder / results, folder / page, PageForm::still, {{k_published_run, identity}});
}

}  // namespace cutterflow::postproc
