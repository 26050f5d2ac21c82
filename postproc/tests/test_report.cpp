#include "postproc/pages/report.hpp"

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "geometry/base/error.hpp"
#include "postproc/analysis/not_modelled.hpp"
#include "postproc/pages/report_figures.hpp"
#include "postproc/tests/synthetic_run.hpp"

namespace cutterflow::postproc {
namespace {

using testing::read_text;
using testing::SmallRun;

std::size_t occurrences(const std::string& text, const std::string& word) {
    std::size_t count = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + word.size())) ++count;
    return count;
}

bool contains(const std::string& text, const std::string& word) {
    return text.find(word) != std::string::npos;
}

/// Leaves the header and the first rows of ledger.csv.
void shorten_ledger(const SmallRun& run, int rows) {
    const std::filesystem::path file = run.directory / "postProcessing/rock/0/ledger.csv";
    const std::string text = read_text(file);
    std::size_t end = 0;
    for (int line = 0; line <= rows; ++line) end = text.find('\n', end) + 1;
    testing::write_text(file, text.substr(0, end));
}

/// The page without the scripts at its end.
std::string without_scripts(const std::string& page) {
    return page.substr(0, page.find("<script>"));
}

TEST(WriteReport, writes_both_files_and_leaves_nothing_else) {
    SmallRun run("report");
    run.write();
    const ReportSummary summary = write_report(run.directory);
    const auto document = nlohmann::json::parse(read_text(summary.results_file));
    EXPECT_NEAR(document.at("spillage").at("ratio").get<double>(), 11.0 / 14.0, 1e-9);
    EXPECT_NEAR(*summary.results.spillage->ratios.ratio, 11.0 / 14.0, 1e-9);
    EXPECT_TRUE(summary.note.empty()) << summary.note;
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(run.directory / "report")) {
        ++files;
        EXPECT_TRUE(entry.path() == summary.results_file || entry.path() == summary.page_file) << entry.path();
    }
    EXPECT_EQ(files, 2);
}

TEST(WriteReport, page_gives_the_answer_first_with_bounds_error_and_cost) {
    SmallRun run("report_answer");
    run.write();
    const std::string page = read_text(write_report(run.directory).page_file);
    const std::size_t body = page.find("<body>");
    std::size_t last = body;
    for (const char* part :
         {"78.6 %", "between 68.8 % and 81.2 %", "18.8 %", "12.5 %", "names no best speed", "no replicate",
          "rock comes at revolution 1; a flow forgets the frozen rotor from which it starts in some 6 of them: in this one",
          "4·10<sup>−14</sup>", "5·10<sup>−12</sup>", "6.7 min wall time", "Where the rock goes"}) {
        const std::size_t at = page.find(part, body);
        ASSERT_NE(at, std::string::npos) << part;
        EXPECT_GT(at, last) << part;
        last = at;
    }
    for (const NotModelled& item : not_modelled({true, false})) EXPECT_TRUE(contains(page, item.name)) << item.name;
    EXPECT_FALSE(contains(page, "is not finished"));
}

TEST(ScopeSentence, says_of_a_bank_that_it_stands_still_or_that_the_head_travels_along_it) {
    for (const bool with_rock : {false, true})
        for (const bool fed : {false, true}) {
            if (fed && !with_rock) continue;
            const std::string still = scope_sentence({with_rock, fed, true, false}), hauled = scope_sentence({with_rock, fed, true, true});
            EXPECT_TRUE(contains(still, "stands still")) << still;
            EXPECT_FALSE(contains(hauled, "stands still") || contains(hauled, "hauling")) << hauled;
            EXPECT_TRUE(contains(hauled, "names no best speed")) << hauled;
        }
    EXPECT_FALSE(contains(scope_sentence({true, false}), "stands still")) << "without a bank";
}

// 10 kg/s are fed and 60 % of them delivered; the head holds 5 kg.
TEST(WriteReport, of_a_fed_head_gives_production_and_spillage_with_interval_and_hold_up_first) {
    SmallRun run("report_fed");
    run.length_ratio = 4.0;
    run.write();
    testing::make_fed(run, 5.0);
    const ReportSummary summary = write_report(run.directory);
    const auto results = nlohmann::json::parse(read_text(summary.results_file));
    EXPECT_TRUE(results.at("spillage").at("ratio").is_null() && results.at("spillage").at("ratio_max").is_null());
    EXPECT_TRUE(contains(results.at("spillage").at("ratio_reason"), "hold-up"));
    EXPECT_TRUE(results.at("spillage").at("at_equal_time").empty());
    const auto& production = results.at("production");
    EXPECT_NEAR(production.at("share").get<double>(), 0.6, 0.01);
    EXPECT_NEAR(production.at("spillage").get<double>(), 0.4, 0.01);
    EXPECT_GT(production.at("share_half_interval").get<double>(), 0.0);
    EXPECT_LT(production.at("share_half_interval").get<double>(), 0.05);
    EXPECT_NEAR(production.at("hold_up_kg").get<double>(), 5.0, 1e-6);
    EXPECT_NEAR(production.at("fed_kg_s").get<double>(), 10.0, 1e-6);
    EXPECT_FALSE(production.at("head_is_full").get<bool>());
    const std::string page = read_text(summary.page_file);
    std::size_t last = page.find("<body>");
    for (const char* part : {"Production: delivered / fed", " ± ", "Spillage: 1 − delivered / fed", " ± ", "Hold-up", "5 kg", "not full",
                             "steady production", "beside a bank that stands still", "Where the rock goes"}) {
        const std::size_t at = page.find(part, last);
        ASSERT_NE(at, std::string::npos) << part;
        last = at;
    }
    // 10 kg/s are 36 t/h, and 32 times as much at four times the size; of 2000 kg/m3 in the bank.
    EXPECT_TRUE(contains(page, "36 t/h")) << page.substr(page.find("steady production"), 2000);
    EXPECT_TRUE(contains(page, "18 m³/h"));
    EXPECT_TRUE(contains(page, "prototype, 4 times as long"));
    EXPECT_FALSE(contains(page, "spilled / (spilled + sucked up)")) << "a ratio without its hold-up";
    EXPECT_FALSE(contains(page, "one batch of rock"));
}

TEST(WriteReport, of_a_fed_head_that_still_fills_gives_bounds) {
    SmallRun run("report_filling");
    run.write();
    testing::make_fed(run, 5.0, 0.2);
    const ReportSummary summary = write_report(run.directory);
    const auto production = nlohmann::json::parse(read_text(summary.results_file)).at("production");
    EXPECT_TRUE(production.at("spillage").is_null());
    EXPECT_NEAR(production.at("spillage_min").get<double>(), 0.32, 0.01);
    EXPECT_NEAR(production.at("spillage_max").get<double>(), 0.52, 0.01);
    EXPECT_NEAR(production.at("hold_up_change_share").get<double>(), 0.2, 0.01);
    EXPECT_TRUE(contains(read_text(summary.page_file), "bounds: what the head holds still changes"));
}

TEST(WriteReport, of_a_fed_head_without_a_window_gives_masses_and_no_ratio) {
    SmallRun run("report_early");
    run.write();
    testing::make_fed(run, 1000.0);
    shorten_ledger(run, 200);
    const ReportSummary summary = write_report(run.directory);
    EXPECT_TRUE(nlohmann::json::parse(read_text(summary.results_file)).at("production").is_null());
    const std::string page = read_text(summary.page_file);
    for (const char* part : {"Production and spillage", "not known yet", "Delivered so far", "Spilled so far", "In the cutter"})
        EXPECT_TRUE(contains(page, part)) << part;
    EXPECT_FALSE(contains(page, "spilled / (spilled + sucked up)"));
}

/// Pieces of a page from one figure's beginning to the next.
std::vector<std::string> figures_of(const std::string& page) {
    std::vector<std::string> pieces;
    for (std::size_t at = page.find("<figure"); at != std::string::npos; at = page.find("<figure", at + 1))
        pieces.push_back(page.substr(at, page.find("</figure>", at) - at));
    return pieces;
}

/// Every figure that the run has numbers for stands in the page, in the list's order, with its caption, its picture and, in a live page,
/// its plot for the mouse.
void expect_all_figures(const std::string& page, const std::vector<PlacedFigure>& expected, bool live) {
    std::vector<std::string> plots = figures_of(page);
    plots.erase(std::remove_if(plots.begin(), plots.end(), [](const std::string& piece) { return contains(piece, "Cutter head from"); }),
                plots.end());
    ASSERT_EQ(plots.size(), expected.size());
    for (std::size_t i = 0; i < plots.size(); ++i) {
        const Figure& figure = expected[i].figure;
        SCOPED_TRACE(figure.plot.name);
        EXPECT_TRUE(contains(plots[i], figure.caption));
        EXPECT_TRUE(contains(plots[i], "id=\"" + figure.plot.name + "_gnuplot_canvas\""));
        EXPECT_EQ(contains(plots[i], "data-kind=\"plot\""), live);
    }
}

std::vector<PlacedFigure> figures_of_run(const std::filesystem::path& directory) {
    const RunData run = read_run(directory);
    return report_figures(compute_results(run), run);
}

TEST(ReportFigures, are_those_that_a_run_with_rock_has_numbers_for) {
    SmallRun run("figures_rock");
    run.write();
    testing::write_velocity_planes(run.directory, [](double r, double) { return Vec3(r, 2.0 * r, 0.1); });
    std::vector<std::string> names;
    for (const PlacedFigure& item : figures_of_run(run.directory)) names.push_back(item.figure.plot.name);
    EXPECT_EQ(names, (std::vector<std::string>{"outcome", "bins", "top_bin", "plane_axial", "plane_under_ring", "last_exit", "fates",
                                               "ratio", "torque", "balance", "cost"}));
}

// Rock 9, of eight times the others' mass, left at 281 degrees: on the bank's side of an over-cut.
TEST(ReportFigures, rose_and_results_have_the_mass_by_azimuth_of_the_last_exit) {
    SmallRun run("figures_rose");
    run.write();
    const std::vector<PlacedFigure> figures = figures_of_run(run.directory);
    const auto found =
        std::find_if(figures.begin(), figures.end(), [](const PlacedFigure& item) { return item.figure.plot.name == "last_exit"; });
    ASSERT_NE(found, figures.end());
    const std::vector<std::string>& sectors = found->figure.plot.series.back().point_names;
    ASSERT_EQ(sectors.size(), 12u);
    EXPECT_EQ(sectors[0], "0 to 30°: 0.0222 kg, 2 rocks");
    EXPECT_EQ(sectors[9], "270 to 300°: 0.0888 kg, 1 rock");
    EXPECT_TRUE(
        contains(found->figure.caption,
                 "72.7 % on the side of the bank, to which the head swings (about 270°), 0.0 % at the top, 9.1 % on the trailing side"))
        << found->figure.caption;
    const auto exits = nlohmann::json::parse(read_text(write_report(run.directory).results_file)).at("exits");
    EXPECT_NEAR(exits.at("sectors").at(9).at("mass_kg").get<double>(), 8.0 * testing::small_rock_mass(), 1e-6);
    EXPECT_EQ(exits.at("sectors").at(9).at("azimuth_from_deg").get<double>(), 270.0);
    EXPECT_NEAR(exits.at("quarters").at("bank_side").at("mass_kg").get<double>(), 8.0 * testing::small_rock_mass(), 1e-6);
    EXPECT_EQ(exits.at("bins").at(0).at("name"), "gap");
    EXPECT_EQ(exits.at("bins").at(0).at("count"), 2);
    EXPECT_NEAR(exits.at("window_end_s").get<double>(), 2.0, 1e-9);
}

// Of a bank of the user's own the height of the cut tells no top.
TEST(ReportFigures, rose_has_the_bank_that_follows_from_the_swing_and_none_of_a_file) {
    const auto rose_of = [](const std::string& name, const std::string& bank) {
        SmallRun run(name);
        run.write();
        const std::filesystem::path study = run.directory / "study.resolved.toml";
        testing::write_text(study, read_text(study) + "\n[bank]\nmodel = \"wall\"\ncut_height_m = 0.32\n" + bank);
        for (const PlacedFigure& item : figures_of_run(run.directory))
            if (item.figure.plot.name == "last_exit") return item.figure;
        throw std::runtime_error("no rose");
    };
    const Figure of_swing = rose_of("figures_rose_bank", ""), of_file = rose_of("figures_rose_file", "file = \"mine.stl\"\n");
    EXPECT_EQ(of_swing.plot.polygons.size(), 2u) << "sectors and soil";
    EXPECT_TRUE(contains(of_swing.caption, "Brown: where the bank stands")) << of_swing.caption;
    EXPECT_EQ(of_file.plot.polygons.size(), 1u);
    EXPECT_FALSE(contains(of_file.caption, "Brown")) << of_file.caption;
    EXPECT_TRUE(contains(of_file.caption, "The bank, of bank.file, is not drawn.")) << of_file.caption;
}

TEST(ReportFigures, of_flow_alone_show_no_rock) {
    SmallRun run("figures_flow");
    run.with_rock = false;
    run.write();
    std::vector<std::string> names;
    for (const PlacedFigure& item : figures_of_run(run.directory)) names.push_back(item.figure.plot.name);
    EXPECT_EQ(names, (std::vector<std::string>{"bins", "torque", "balance", "cost"}));
}

TEST(WriteReport, page_stands_alone_and_holds_every_figure) {
    SmallRun run("report_alone");
    run.write();
    const std::string whole = read_text(write_report(run.directory).page_file), page = without_scripts(whole);
    expect_all_figures(page, figures_of_run(run.directory), true);
    EXPECT_TRUE(contains(whole, "Content-Security-Policy\" content=\"default-src 'none'"));
    EXPECT_EQ(occurrences(page, "data-kind=\"head\""), 1u);
    EXPECT_EQ(occurrences(page, "<svg"), occurrences(page, "</svg>"));
    EXPECT_EQ(occurrences(page, "data:image/png;base64,"), 2u);
    EXPECT_EQ(occurrences(page, "<script"), occurrences(page, "<script type=\"application/json\""));
    EXPECT_FALSE(contains(whole, "<script src"));
    EXPECT_FALSE(contains(page, "src="));
    EXPECT_FALSE(contains(page, "@import"));
    std::string outside = page;
    for (std::size_t at = outside.find("http:"); at != std::string::npos; at = outside.find("http:", at + 1)) {
        EXPECT_EQ(outside.compare(at, 18, "http://www.w3.org/"), 0) << outside.substr(at, 60);  // names of XML, not addresses to fetch
    }
    EXPECT_FALSE(contains(page, "https:"));
    // Ids are unique in the page.
    std::vector<std::string> ids;
    for (std::size_t at = page.find(" id="); at != std::string::npos; at = page.find(" id=", at + 1))
        ids.push_back(page.substr(at, page.find(page[at + 4], at + 5) - at));
    const std::size_t all = ids.size();
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    EXPECT_EQ(ids.size(), all);
}

TEST(TopBinPlot, puts_spilled_shares_against_outflow_and_shades_the_references_onset) {
    SmallRun run("report_top_bin");
    run.write();
    const std::vector<PlacedFigure> figures = figures_of_run(run.directory);
    const auto found =
        std::find_if(figures.begin(), figures.end(), [](const PlacedFigure& item) { return item.figure.plot.name == "top_bin"; });
    ASSERT_NE(found, figures.end());
    const Plot& plot = found->figure.plot;
    const Series& top = plot.series.back();
    EXPECT_EQ(top.point_names, std::vector<std::string>{"0–30 mm"});
    EXPECT_NEAR(top.x[0], -0.2, 1e-6);
    EXPECT_NEAR(top.y[0], 100.0 / 16.0, 1e-3);  // one rock of eight and a ninth with eight times their mass
    EXPECT_EQ(plot.series.front().x.size() + 1, read_run(run.directory).bins.size());
    ASSERT_EQ(plot.bands.size(), 1u);
    EXPECT_EQ(plot.bands[0].from, 0.05);
    EXPECT_EQ(plot.bands[0].to, 0.23);
    EXPECT_LT(*plot.x.from, -0.2);
    EXPECT_GT(*plot.x.to, 0.23);
    const std::string page = read_text(write_report(run.directory).page_file);
    EXPECT_TRUE(contains(page, "It is the reference’s band, not a result of this program."));
}

/// A ring's steel closes the bins that it reaches over.
TEST(TopBinPlot, marks_the_first_bin_through_which_rock_leaves) {
    SmallRun run("report_thick_ring");
    for (testing::Event& event : run.events)
        if (event.id == 3 && event.direction == "out") event.bin = "gap";
    run.write();
    for (const PlacedFigure& item : figures_of_run(run.directory)) {
        if (item.figure.plot.name != "top_bin") continue;
        const Series& top = item.figure.plot.series.back();
        EXPECT_EQ(top.point_names, std::vector<std::string>{"60–90 mm"});
        EXPECT_NEAR(top.x.at(0), 0.0, 1e-6);
        EXPECT_NEAR(top.y.at(0), 50.0, 1e-3);
        EXPECT_TRUE(contains(item.figure.caption, "60–90 mm"));
        return;
    }
    FAIL() << "no such figure";
}

TEST(PublishReport, writes_a_page_without_scripts_with_its_pictures_beside_it) {
    SmallRun run("report_still");
    run.write();
    const auto folder = testing::fresh_directory("published") / "page";
    const ReportSummary summary = publish_report(run.directory, folder);
    const std::string page = read_text(summary.page_file), live = read_text(write_report(run.directory).page_file);
    EXPECT_FALSE(contains(page, "<script"));
    EXPECT_TRUE(contains(page, "<code>cutterflow report RUN</code>"));
    EXPECT_FALSE(contains(live, "cutterflow report RUN"));
    expect_all_figures(page, figures_of_run(run.directory), false);
    for (const char* picture : {"head_side.png", "head_axial.png"}) {
        EXPECT_TRUE(contains(page, std::string("href=\"") + picture));
        EXPECT_EQ(read_text(folder / picture).substr(1, 3), "PNG");
    }
    auto published = nlohmann::json::parse(read_text(summary.results_file));
    EXPECT_EQ(published.at("published_run").get<std::string>().size(), 64u);
    published.erase("published_run");
    EXPECT_EQ(published, nlohmann::json::parse(read_text(run.directory / "report/results.json")));
    EXPECT_NO_THROW(publish_report(run.directory, folder));
    const auto taken = testing::fresh_directory("published_taken");
    testing::write_text(taken / "thesis.tex", "mine");
    EXPECT_THROW(publish_report(run.directory, taken), UserError);
}

void expect_kept(const std::filesystem::path& run, const std::filesystem::path& folder) {
    const std::string page = read_text(folder / "index.html"), results = read_text(folder / "results.json");
    EXPECT_THROW(publish_report(run, folder), UserError) << folder;
    EXPECT_EQ(read_text(folder / "index.html"), page);
    EXPECT_EQ(read_text(folder / "results.json"), results);
}

TEST(PublishReport, replaces_nothing_but_an_earlier_publication_of_the_same_run) {
    SmallRun run("report_owner"), other("report_other");
    other.length_ratio = 2.0;
    run.write();
    other.write();
    const auto folder = testing::fresh_directory("published_owner") / "page";
    publish_report(run.directory, folder);
    expect_kept(other.directory, folder);
    write_report(run.directory);
    write_report(other.directory);
    expect_kept(run.directory, run.directory / "report");
    expect_kept(run.directory, other.directory / "report");
    const auto site = testing::fresh_directory("published_site");
    testing::write_text(site / "index.html", "<h1>mine</h1>");
    for (const char* results : {"{\"mine\": 1}", "[1, 2]", "no JSON", ""}) {
        testing::write_text(site / "results.json", results);
        expect_kept(run.directory, site);
    }
}

TEST(WriteReport, says_of_a_folder_in_the_place_of_a_file_that_it_cannot_be_read) {
    for (const char* file : {"manifest.json", "mesh.json", "feed.json", "geometry/geometry.json", "geometry/cutter.stl",
                             "geometry/contour.csv", "postProcessing/cost/0/cost.json", "postProcessing/cost/0/cost.csv"}) {
        SmallRun run("report_of_folders");
        run.write();
        std::filesystem::remove(run.directory / file);
        std::filesystem::create_directories(run.directory / file);
        try {
            write_report(run.directory);
            ADD_FAILURE() << file << " was read";
        } catch (const UserError& error) {
            EXPECT_TRUE(contains(error.what(), std::filesystem::path(file).filename().string())) << error.what();
            EXPECT_TRUE(contains(error.what(), "read")) << error.what();
        }
    }
}

TEST(WriteReport, refuses_a_contour_that_was_cut_short) {
    for (const std::size_t lines : {std::size_t{1}, std::size_t{3}}) {
        SmallRun run("report_of_half_a_contour");
        run.write();
        const std::string whole = read_text(run.directory / "geometry/contour.csv");
        std::size_t end = 0;
        for (std::size_t i = 0; i < lines; ++i) end = whole.find('\n', end) + 1;
        for (const std::size_t length : {end, end + 4}) {
            testing::write_text(run.directory / "geometry/contour.csv", whole.substr(0, length));
            EXPECT_THROW(write_report(run.directory), UserError) << length;
        }
    }
}

TEST(WriteReport, names_of_the_user_cannot_become_markup) {
    SmallRun run("report_escape");
    run.study_name = "<script>alert('x')</script> & \"rev B\"";
    run.write();
    auto feed = nlohmann::json::parse(read_text(run.directory / "feed.json"));
    feed["feeds"][0]["reasons"] = {"<img onerror=1>"};
    testing::write_text(run.directory / "feed.json", feed.dump());
    const std::string page = without_scripts(read_text(write_report(run.directory).page_file));
    EXPECT_FALSE(contains(page, "<script>alert"));
    EXPECT_FALSE(contains(page, "<img"));
    EXPECT_TRUE(contains(page, "Cutter &lt;rev B&gt;.STL"));
    EXPECT_FALSE(contains(page, "/data/"));  // the folder is nobody's business
    EXPECT_TRUE(contains(page, "&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt; &amp; &quot;rev B&quot;"));
}

TEST(WriteReport, an_unfinished_run_is_reported_and_says_so) {
    SmallRun run("report_unfinished");
    run.finished = false;
    run.end_time = 1.5;
    run.write();
    const std::string page = read_text(write_report(run.directory).page_file);
    EXPECT_TRUE(contains(page, "The run is not finished."));
    EXPECT_TRUE(contains(page, "t = 1.5 s"));
}

TEST(WriteReport, a_pure_flow_run_is_reported_by_its_outflow) {
    SmallRun run("report_flow");
    run.with_rock = false;
    run.write();
    const std::string page = read_text(write_report(run.directory).page_file);
    EXPECT_TRUE(contains(page, "no rock"));
    EXPECT_TRUE(contains(page, "Strongest mean radial velocity"));
    EXPECT_FALSE(contains(page, "sucked up / placed"));
    expect_all_figures(without_scripts(page), figures_of_run(run.directory), true);
}

TEST(WriteReport, prototype_columns_follow_froude) {
    SmallRun run("report_prototype");
    run.length_ratio = 4.0;
    run.write();
    const std::string page = read_text(write_report(run.directory).page_file);
    EXPECT_TRUE(contains(page, "Froude-scaled 4:1"));
    EXPECT_TRUE(contains(page, "<td>60</td><td>30</td>"));      // rpm
    EXPECT_TRUE(contains(page, "<td>0.12</td><td>3.84</td>"));  // m3/s
    EXPECT_TRUE(contains(page, "<td>-11</td><td>-2816</td>"));  // N m
}

/// Hides every program from the process while it lives.
class NoPrograms {
public:
    NoPrograms() : path_(std::getenv("PATH")) { setenv("PATH", "/nonexistent", 1); }
    ~NoPrograms() { setenv("PATH", path_.c_str(), 1); }

private:
    std::string path_;
};

TEST(WriteReport, without_gnuplot_the_page_has_its_tables_and_names_the_program) {
    SmallRun run("report_no_gnuplot");
    run.write();
    const NoPrograms guard;
    const ReportSummary summary = write_report(run.directory);
    EXPECT_TRUE(contains(summary.note, "gnuplot"));
    const std::string page = read_text(summary.page_file);
    EXPECT_TRUE(contains(page, "gnuplot-nox"));
    EXPECT_TRUE(contains(page, "78.6 %"));
    EXPECT_TRUE(contains(page, "60–90 mm"));
    EXPECT_FALSE(contains(page, "gnuplot_canvas"));
    EXPECT_TRUE(contains(page, "Cutter head from the side"));  // the pictures need no program
    EXPECT_TRUE(contains(page, "Cutter head from the hub"));
    EXPECT_TRUE(contains(page, "mesh motion and rotor interface ("));
}

TEST(WriteReport, fates_that_do_not_add_up_leave_an_older_report_alone) {
    SmallRun run("report_old");
    run.write();
    const ReportSummary summary = write_report(run.directory);
    const std::string before = read_text(summary.results_file);
    const auto file = run.directory / "postProcessing/rock/0/events.csv";
    std::string events = read_text(file);
    events.resize(events.rfind('\n', events.size() - 2) + 1);
    testing::write_text(file, events);
    EXPECT_THROW(write_report(run.directory), CheckFailure);
    EXPECT_EQ(read_text(summary.results_file), before);
}

TEST(WriteReport, realistic_run_gives_a_page) {
    const auto directory = testing::fresh_directory("realistic");
    testing::write_realistic_run(directory);
    const ReportSummary summary = write_report(directory);
    const Fates& fates = summary.results.spillage->fates;
    EXPECT_EQ(fates.placed.count, 361);
    EXPECT_EQ(fates.sucked_up.count + fates.spilled.count + fates.in_cutter.count + fates.never_entered.count, 361);
    EXPECT_LT(std::filesystem::file_size(summary.page_file), 4'000'000u);
}

}  // namespace
}  // namespace cutterflow::postproc
