/// One description, two renderings: both show the same numbers, and no text leaves its string.
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "postproc/draw/gnuplot.hpp"
#include "postproc/draw/plotly.hpp"
#include "postproc/tests/synthetic_run.hpp"

namespace cutterflow::postproc {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double k_gap = std::numeric_limits<double>::quiet_NaN();

/// Numbers of gnuplot's data blocks, block by block, row by row; an empty row is an end of a line.
std::vector<std::vector<std::vector<double>>> blocks_of(const std::string& commands) {
    std::vector<std::vector<std::vector<double>>> blocks;
    std::istringstream lines(commands);
    bool inside = false;
    for (std::string line; std::getline(lines, line);) {
        if (line == "END_OF_DATA") {
            inside = false;
        } else if (line.find("<< END_OF_DATA") != std::string::npos) {
            inside = true;
            blocks.emplace_back();
        } else if (inside) {
            std::istringstream fields(line);
            blocks.back().emplace_back();
            for (std::string field; fields >> field;) blocks.back().back().push_back(std::stod(field));
        }
    }
    return blocks;
}

Series measured() {
    Series series{"with bars", "#d55e00", {1.0, 2.0, 4.0}, {10.0, 30.0, 20.0}};
    series.mark = Mark::diamond;
    series.x_low = {0.5, 1.5, 3.5};
    series.x_high = {1.25, 2.25, 4.25};
    series.y_low = {9.0, 28.0, 17.0};
    series.y_high = {14.0, 33.0, 24.0};
    series.point_names = {"a", "b", "c"};
    return series;
}

TEST(Plot, marks_are_told_apart_in_both_renderings) {
    const std::vector<Mark> marks{Mark::disc,          Mark::ring,         Mark::square,   Mark::open_square,
                                  Mark::diamond,       Mark::open_diamond, Mark::triangle, Mark::open_triangle,
                                  Mark::triangle_down, Mark::cross,        Mark::plus};
    std::set<std::string> of_gnuplot, of_plotly;
    for (const Mark mark : marks) {
        Plot plot;
        plot.name = "marks";
        plot.series = {{"one", "#d55e00", {1.0}, {2.0}}};
        plot.series[0].mark = mark;
        const std::string commands = gnuplot_commands(plot);
        const std::size_t at = commands.find(" pt ");
        of_gnuplot.insert(commands.substr(at, commands.find(" ps ", at) - at));
        of_plotly.insert(plotly_figure(plot).at("data").at(0).at("marker").at("symbol"));
    }
    EXPECT_EQ(of_gnuplot.size(), marks.size());
    EXPECT_EQ(of_plotly.size(), marks.size());
}

TEST(Plot, series_have_the_same_points_and_bars_in_both_renderings) {
    Plot plot;
    plot.name = "both";
    plot.series = {measured()};
    const auto rows = blocks_of(gnuplot_commands(plot)).at(0);
    const json trace = plotly_figure(plot).at("data").at(0);
    ASSERT_EQ(rows.size(), 3u);
    ASSERT_EQ(trace.at("x").size(), 3u);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double x = trace.at("x")[i], y = trace.at("y")[i];
        EXPECT_EQ(rows[i],
                  (std::vector<double>{
                      x, y, x - trace.at("error_x").at("arrayminus")[i].get<double>(), x + trace.at("error_x").at("array")[i].get<double>(),
                      y - trace.at("error_y").at("arrayminus")[i].get<double>(), y + trace.at("error_y").at("array")[i].get<double>()}));
        EXPECT_EQ(x, measured().x[i]);
        EXPECT_EQ(y, measured().y[i]);
    }
    EXPECT_EQ(trace.at("marker").at("symbol"), "diamond");
    EXPECT_THAT(gnuplot_commands(plot), HasSubstr("with xyerrorbars pt 13"));
}

TEST(Plot, lines_break_at_gaps_in_both_renderings) {
    Plot plot;
    plot.name = "gap";
    Series line{"line", "#000000", {0.0, 1.0, k_gap, 2.0}, {5.0, 6.0, k_gap, 7.0}};
    line.line_width = 1.0;
    plot.series = {line};
    const auto rows = blocks_of(gnuplot_commands(plot)).at(0);
    ASSERT_EQ(rows.size(), 4u);
    EXPECT_TRUE(rows[2].empty());
    EXPECT_TRUE(plotly_figure(plot).at("data")[0].at("x")[2].is_null());
}

TEST(Plot, axes_have_the_same_range_scale_and_ticks_in_both_renderings) {
    Plot plot;
    plot.name = "axes";
    plot.x.from = 0.0;
    plot.y.logarithmic = true;
    plot.y.from = 1e-6;
    plot.y.to = 1e2;
    plot.y.step = 100.0;
    plot.x.ticks = {{0.0, "none"}, {1.0, "one"}};
    const json layout = plotly_figure(plot).at("layout");
    EXPECT_EQ(layout.at("yaxis").at("type"), "log");
    EXPECT_EQ(layout.at("yaxis").at("range"), json({-6.0, 2.0}));
    EXPECT_EQ(layout.at("yaxis").at("dtick"), 2.0);
    EXPECT_EQ(layout.at("xaxis").at("range"), json({0.0, nullptr}));
    EXPECT_EQ(layout.at("xaxis").at("ticktext"), json({"none", "one"}));
    const std::string commands = gnuplot_commands(plot);
    for (const char* part :
         {"set logscale y", "set yrange [1e-06:100]", "set ytics nomirror 100", "set xrange [0:*]", "(\"none\" 0, \"one\" 1)"})
        EXPECT_THAT(commands, HasSubstr(part));
}

TEST(Plot, areas_bars_bands_and_fields_have_the_same_borders_in_both_renderings) {
    Plot plot;
    plot.name = "shapes";
    plot.y.tip = {".1f", " kg"};
    plot.areas = {{"area", "#123456", {0.0, 1.0}, {2.0, 3.0}, {5.0, 7.0}, true}};
    plot.bars = {{1.0, 4.0, 0.5, 0.2, "#654321", "three"}};
    plot.bands = {{0.25, 0.75, "#eeeeee", "band"}};
    plot.field = Field{{0.0, 1.0, 0.0, 1.0}, {0.0, 0.0, 1.0, 1.0}, {0.1, 0.2, k_gap, 0.4}, 0.3, "m/s", {".1f", " m/s"}};
    const auto blocks = blocks_of(gnuplot_commands(plot));
    const json figure = plotly_figure(plot), &data = figure.at("data");
    EXPECT_EQ(blocks.at(0).at(3), (std::vector<double>{1.0, 1.0, 0.4}));
    EXPECT_TRUE(std::isnan(blocks.at(0).at(2).at(2)));
    EXPECT_EQ(data[0].at("z")[3], 0.4);
    EXPECT_TRUE(data[0].at("z")[2].is_null());
    EXPECT_EQ(blocks.at(1).at(1), (std::vector<double>{1.0, 3.0, 7.0}));
    EXPECT_EQ(data[1].at("y"), json({2.0, 3.0}));
    EXPECT_EQ(data[2].at("y"), json({5.0, 7.0}));
    EXPECT_EQ(data[2].at("customdata")[1][1], 4.0);  // the tool tip of a stacked area is its height
    EXPECT_EQ(data[2].at("hovertemplate"), "%{customdata[1]:.1f} kg");
    EXPECT_THAT(gnuplot_commands(plot), HasSubstr("rectangle from 1,0.4 to 4,0.6"));
    EXPECT_EQ(data[3].at("base"), json({1.0}));
    EXPECT_EQ(data[3].at("x"), json({3.0}));
    EXPECT_THAT(gnuplot_commands(plot), HasSubstr("rectangle from 0.25,graph 0 to 0.75,graph 1"));
    EXPECT_EQ(figure.at("layout").at("shapes")[0].at("x1"), 0.75);
}

TEST(Plot, texts_can_be_neither_commands_nor_markup) {
    Plot plot;
    plot.name = "evil";
    plot.x.title = "a\"; system \"rm\\";
    plot.y.title = "two\nlines";
    Series series{"<img src=x onerror=alert(1)>", "#000000", {1.0}, {1.0}};
    series.mark = Mark::disc;
    series.point_names = {"<b>point</b>"};
    plot.series = {series};
    const std::string commands = gnuplot_commands(plot);
    EXPECT_THAT(commands, HasSubstr("\"a\\\"; system \\\"rm\\\\\""));
    EXPECT_THAT(commands, HasSubstr("\"two lines\""));
    const std::string figure = plotly_figure(plot).dump();
    EXPECT_THAT(figure, Not(HasSubstr("<img")));
    EXPECT_THAT(figure, Not(HasSubstr("<b>point")));
    const std::string svg = draw_svg(plot, testing::fresh_directory("evil_plot"));
    EXPECT_THAT(svg, Not(HasSubstr("<img")));
}

TEST(Plot, of_nothing_is_drawn_with_its_axes) {
    Plot plot;
    plot.name = "empty";
    plot.x.title = "nothing here";
    plot.x.from = plot.y.from = 0.0;
    plot.x.to = plot.y.to = 1.0;
    EXPECT_THAT(draw_svg(plot, testing::fresh_directory("empty_plot")), HasSubstr("nothing here"));
}

TEST(Plot, without_a_point_is_drawn_when_no_range_is_given) {
    Plot plot;
    plot.name = "no_range";
    plot.x.title = "nothing here";
    plot.x.from = 2.0;
    plot.y.logarithmic = true;
    EXPECT_THAT(draw_svg(plot, testing::fresh_directory("no_range_plot")), HasSubstr("nothing here"));
    Series unknown{"unknown", "#000000", {1.0, 2.0}, {k_gap, k_gap}};
    unknown.mark = Mark::disc;
    plot.series = {unknown};
    EXPECT_THAT(draw_svg(plot, testing::fresh_directory("no_range_marks")), HasSubstr("nothing here"));
    plot.series[0].line_width = 1.0;
    EXPECT_THAT(draw_svg(plot, testing::fresh_directory("no_range_line")), HasSubstr("nothing here"));
}

}  // namespace
}  // namespace cutterflow::postproc
