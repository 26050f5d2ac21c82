/// The pages in a real browser: nothing on the console, every plot drawn, no text clipped, no request, no markup from names.
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "postproc/analysis/comparison.hpp"
#include "postproc/pages/comparison_figures.hpp"
#include "postproc/pages/comparison_page.hpp"
#include "postproc/pages/report.hpp"
#include "postproc/pages/report_figures.hpp"
#include "postproc/tests/chromium.hpp"
#include "postproc/tests/synthetic_run.hpp"

namespace cutterflow::postproc {
namespace {

namespace fs = std::filesystem;
using testing::Chromium;

constexpr const char* k_evil = "<script>alert(1)</script> <img src=x onerror=alert(2)> & \"rev\" <b>B</b>";

/// Names of pieces that are not drawn: no lines, bars or areas of plotly, no canvas.
constexpr const char* k_not_drawn = R"js(
[...document.querySelectorAll('.replaceable')].filter((piece) => {
  const marks = piece.querySelectorAll('.live .mlayer :is(path, image)').length, canvas = piece.querySelector('.live canvas');
  const drawn = piece.dataset.kind === 'plot' ? marks > 0 : canvas !== null;
  return !drawn || !piece.classList.contains('drawn') || getComputedStyle(piece.querySelector('.static')).display !== 'none';
}).map((piece) => piece.closest('figure').innerText.slice(0, 80)))js";

/// Fewest colours in a head's view.
constexpr const char* k_colours_of_heads = R"js(Math.min(...[...document.querySelectorAll('.live canvas')].map((view) =>
  new Set(new Uint32Array(view.getContext('2d').getImageData(0, 0, view.width, view.height).data.buffer)).size)))js";

/// Text that does not fit: wider than its element, outside the window, or (in a plot) outside its plot. Wide tables scroll.
constexpr const char* k_clipped_text = R"js((() => {
  const clipped = [], width = document.documentElement.clientWidth;
  if (document.documentElement.scrollWidth > width) clipped.push('the page is wider than the window');
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const element = node.parentElement, range = document.createRange();
    if (!node.textContent.trim() || ['SCRIPT', 'STYLE'].includes(element.tagName) || element.closest('.scroll')) continue;
    range.selectNodeContents(node);
    const box = range.getBoundingClientRect();
    if (box.width === 0 || getComputedStyle(element).visibility === 'hidden') continue;
    const plot = element.closest('.live, .static'), frame = plot ? plot.getBoundingClientRect() : {left: 0, right: width};
    const vertical = plot && (box.top < frame.top - 1 || box.bottom > frame.bottom + 1);
    const tooWide = element instanceof HTMLElement && element.clientWidth > 0 && element.scrollWidth > element.clientWidth;
    if (box.left < frame.left - 1 || box.right > frame.right + 1 || vertical || tooWide) clipped.push(node.textContent.slice(0, 60));
  }
  return clipped;
})())js";

void wait_until_drawn(Chromium& browser) {
    for (int attempt = 0; attempt < 200 && !browser.evaluate(k_not_drawn).empty(); ++attempt) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
}

/// \param plots  that the page must show, each with its caption
void expect_sound_page(Chromium& browser, const fs::path& page, const std::vector<Figure>& plots, std::size_t heads) {
    for (const int width : {1280, 800}) {
        SCOPED_TRACE(fmt::format("{} at {} px", page.string(), width));
        browser.open(page, width, 1000);
        wait_until_drawn(browser);
        EXPECT_EQ(browser.evaluate(k_not_drawn).dump(), "[]");
        EXPECT_EQ(browser.evaluate("document.querySelectorAll('.js-plotly-plot').length"), plots.size());
        for (const Figure& figure : plots) {
            const std::string caption = nlohmann::json(figure.caption).dump();
            EXPECT_EQ(
                browser.evaluate("[...document.querySelectorAll('figure')].filter((figure) => figure.querySelector('.js-plotly-plot') && "
                                 "figure.querySelector('figcaption').innerHTML === Object.assign(document.createElement('p'), "
                                 "{innerHTML: " +
                                 caption + "}).innerHTML).length"),
                1)
                << caption;
        }
        EXPECT_EQ(browser.evaluate("document.querySelectorAll('.live canvas').length"), heads);
        EXPECT_EQ(browser.evaluate(k_clipped_text).dump(), "[]");
        EXPECT_EQ(browser.evaluate("document.querySelectorAll('body img').length"), 0);
        EXPECT_EQ(nlohmann::json(browser.complaints()).dump(), "[]");
        if (heads > 0) {
            EXPECT_GT(browser.evaluate(k_colours_of_heads), 100);  // last: reading the picture back is slow, and Chromium says so
        }
    }
}

std::vector<Figure> figures_of_run(const fs::path& directory) {
    const RunData run = read_run(directory);
    std::vector<Figure> figures;
    for (const PlacedFigure& item : report_figures(compute_results(run), run)) figures.push_back(item.figure);
    return figures;
}

class Pages : public ::testing::Test {
protected:
    void SetUp() override {
        if (!Chromium::is_installed())
            GTEST_SKIP() << "chromium is not installed (Debian: apt-get install chromium): the pages were not opened";
    }
};

TEST_F(Pages, a_report_is_drawn_and_fits) {
    const fs::path directory = testing::fresh_directory("page_realistic");
    testing::write_realistic_run(directory);
    Chromium browser;
    expect_sound_page(browser, write_report(directory).page_file, figures_of_run(directory), 1);
}

TEST_F(Pages, a_report_of_flow_alone_with_an_evil_name_is_drawn_and_fits) {
    testing::SmallRun run("page_evil");
    run.with_rock = false;
    run.study_name = k_evil;
    run.write();
    Chromium browser;
    const fs::path page = write_report(run.directory).page_file;
    expect_sound_page(browser, page, figures_of_run(run.directory), 1);
    EXPECT_EQ(browser.evaluate("document.querySelector('h1').textContent"), k_evil);
}

/// The small run fed from a cut face, beside its bank, as a model at 1:4. \return its directory
fs::path fed_head(const std::string& name, double speed_rpm, double swing_m_min) {
    testing::SmallRun run(name);
    run.length_ratio = 4.0;
    run.speed_rpm = speed_rpm;
    run.write();
    testing::make_fed(run, 5.0);
    testing::set_swing_speed(run.directory, swing_m_min);
    return run.directory;
}

/// Text of the page's tables.
std::string tables_of(Chromium& browser) {
    return browser.evaluate("[...document.querySelectorAll('table')].map((table) => table.innerText).join('\\n')").get<std::string>();
}

TEST_F(Pages, a_report_of_a_fed_head_beside_its_bank_is_drawn_and_fits) {
    const fs::path directory = fed_head("page_fed", 60.0, 6.0);
    Chromium browser;
    expect_sound_page(browser, write_report(directory).page_file, figures_of_run(directory), 1);
    const std::string tables = tables_of(browser);
    for (const char* part : {"steady production", "prototype, 4 times as long", "delivered, soil in situ", "left behind"})
        EXPECT_NE(tables.find(part), std::string::npos) << part;
    const std::string text = browser.evaluate("document.body.innerText").get<std::string>();
    for (const char* part : {"Brown: the soil that the head swings into", "What limits:", "Outside of usual practice"})
        EXPECT_NE(text.find(part), std::string::npos) << part;
    EXPECT_EQ(text.find("spilled / (spilled + sucked up)"), std::string::npos) << "a ratio without its hold-up";
}

TEST_F(Pages, a_comparison_of_fed_heads_is_drawn_with_its_map_and_fits) {
    std::vector<fs::path> runs;
    for (const double speed : {40.0, 60.0})
        for (const double swing : {4.0, 8.0}) runs.push_back(fed_head(fmt::format("page_fed_{:g}_{:g}", speed, swing), speed, swing));
    const fs::path folder = testing::fresh_directory("page_fed_comparison") / "page";
    const Comparison comparison = compare_runs(runs);
    Chromium browser;
    expect_sound_page(browser, write_comparison(comparison, folder), comparison_figures(comparison), 4);
    const std::string text = browser.evaluate("document.body.innerText").get<std::string>();
    for (const char* part : {"No best point within the error", "Prototype, 4 times as long"})
        EXPECT_NE(text.find(part), std::string::npos) << part;
}

TEST_F(Pages, a_comparison_with_evil_names_is_drawn_and_fits) {
    testing::SmallRun first("page_compared_1"), second("page_compared_2"), third("page_compared_3");
    first.study_name = k_evil;
    second.length_ratio = 2.0;
    third.length_ratio = 4.0;
    third.speed_rpm = 30.0;
    for (const auto* run : {&first, &second, &third}) run->write();
    const fs::path folder = testing::fresh_directory("page_comparison") / "page";
    Chromium browser;
    const Comparison comparison = compare_runs({first.directory, second.directory, third.directory});
    expect_sound_page(browser, write_comparison(comparison, folder), comparison_figures(comparison), 3);
    EXPECT_EQ(browser.evaluate("JSON.parse(document.getElementById('surfaces').textContent).length"), 2)
        << "the three heads are one cutter in front of one backplate with its pipe";
    // The plots' tool tips carry names: they must be there as text.
    EXPECT_GT(browser.evaluate("document.body.textContent.split('<img src=x').length"), 1);
}

TEST_F(Pages, a_published_comparison_shows_every_picture_and_runs_no_script) {
    testing::SmallRun first("page_still_1"), second("page_still_2");
    second.length_ratio = 2.0;
    for (const auto* run : {&first, &second}) run->write();
    const fs::path folder = testing::fresh_directory("page_still") / "page";
    Chromium browser;
    browser.open(write_comparison(compare_runs({first.directory, second.directory}), folder, PageForm::still), 1280, 1000);
    EXPECT_EQ(browser.evaluate("document.scripts.length"), 0);
    EXPECT_EQ(
        browser.evaluate("[...document.querySelectorAll('figure')].filter((figure) => !figure.querySelector('svg')?.clientHeight).length"),
        0);
    EXPECT_EQ(browser.evaluate(R"js(Promise.all([...document.querySelectorAll('svg image')].map((image) =>
      new Promise((done) => { const picture = new Image(); picture.onload = () => done(picture.naturalWidth); picture.onerror = () => done(0);
                              picture.src = image.href.baseVal; }))).then((widths) => Math.min(...widths)))js"),
              832);
    EXPECT_EQ(nlohmann::json(browser.complaints()).dump(), "[]");
}

TEST_F(Pages, print_and_readers_without_scripts_get_the_pictures) {
    testing::SmallRun run("page_print");
    run.write();
    const fs::path page = write_report(run.directory).page_file;
    Chromium browser;
    browser.open(page, 1280, 1000);
    wait_until_drawn(browser);
    const std::string hidden = "[...document.querySelectorAll('.static')].filter((picture) => picture.clientHeight === 0).length";
    const std::string live = "[...document.querySelectorAll('.live')].filter((plot) => plot.clientHeight > 0).length";
    EXPECT_EQ(browser.evaluate(hidden), browser.evaluate("document.querySelectorAll('.replaceable').length"));
    EXPECT_GT(browser.evaluate(hidden), 0);
    browser.show_as_print(true);
    EXPECT_EQ(browser.evaluate(hidden), 0);
    EXPECT_EQ(browser.evaluate(live), 0);
    browser.show_as_print(false);
    browser.allow_scripts(false);
    browser.open(page, 1280, 1000);
    EXPECT_EQ(browser.evaluate(hidden), 0);
    EXPECT_EQ(browser.evaluate(live), 0);
}

}  // namespace
}  // namespace cutterflow::postproc
